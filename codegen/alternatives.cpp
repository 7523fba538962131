#include "codegen/alternatives.h"

#include "codegen/simplify.h"

namespace tightrope::codegen {

using dsl::no_node;
using dsl::Node;
using dsl::NodeId;
using dsl::Op;

std::vector<bool> value_nodes(const dsl::Predicate& predicate) {
  std::vector<bool> used(static_cast<std::size_t>(predicate.graph.size()), false);
  for (const dsl::Stage& stage : predicate.stages) {
    for (const dsl::Output& output : stage.outputs) {
      for (const NodeId id : output.nodes) used[static_cast<std::size_t>(id)] = true;
    }
  }
  for (NodeId id = predicate.graph.size() - 1; id >= 0; --id) {
    if (!used[static_cast<std::size_t>(id)]) continue;
    const Node& n = predicate.graph[id];
    for (const NodeId operand : {n.op == Op::select ? no_node : n.a, n.b, n.c}) {
      if (operand != no_node) used[static_cast<std::size_t>(operand)] = true;
    }
  }
  return used;
}

dsl::Predicate first_alternatives(const dsl::Predicate& predicate) {
  dsl::Predicate result = predicate;
  result.graph = dsl::Graph{};
  std::vector<NodeId> image;
  const auto at = [&](NodeId id) { return id == no_node ? no_node : image[static_cast<std::size_t>(id)]; };
  for (NodeId id = 0; id < predicate.graph.size(); ++id) {
    const Node& n = predicate.graph[id];
    image.push_back(n.op == Op::select ? at(n.b)
                                       : result.graph.intern({n.op, at(n.a), at(n.b), at(n.c), n.index, n.value}));
  }
  for (dsl::Stage& stage : result.stages) {
    for (dsl::Output& output : stage.outputs) {
      for (NodeId& id : output.nodes) id = at(id);
    }
  }
  return simplify(result);
}

}  // namespace tightrope::codegen
