#include "codegen/nonnegative.h"

namespace tightrope::codegen {

using dsl::Node;
using dsl::NodeId;
using dsl::Op;

std::vector<bool> nonnegative_nodes(const dsl::Graph& graph) {
  std::vector<bool> result;
  result.reserve(static_cast<std::size_t>(graph.size()));
  const auto at = [&](NodeId id) { return result[static_cast<std::size_t>(id)]; };
  for (NodeId id = 0; id < graph.size(); ++id) {
    const Node& n = graph[id];
    const auto both = [&] { return at(n.a) && at(n.b); };
    bool known = false;
    switch (n.op) {
      case Op::constant:
        known = n.value >= 0;
        break;
      case Op::abs:
      case Op::sqrt:
        known = true;
        break;
      case Op::mul:
        known = n.a == n.b || both();
        break;
      case Op::fma:
        known = (n.a == n.b || both()) && at(n.c);
        break;
      case Op::add:
      case Op::div:
      case Op::min:
        known = both();
        break;
      case Op::select:
        known = at(n.b) && at(n.c);
        break;
      case Op::max:
      case Op::max_magnitude:
        known = at(n.a) || at(n.b);
        break;
      case Op::mul_pow2:
      case Op::certain_nonzero:
      case Op::certain_nonnegative:
      case Op::normalizer:
        known = at(n.a);
        break;
      case Op::input:
      case Op::sub:
      case Op::neg:
        break;
    }
    result.push_back(known);
  }
  return result;
}

}  // namespace tightrope::codegen
