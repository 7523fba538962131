#include "codegen/simplify.h"

#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace tightrope::codegen {

namespace {

using dsl::Graph;
using dsl::no_node;
using dsl::Node;
using dsl::NodeId;
using dsl::Op;

/// k with |c| = 2^k, if |c| is a power of two.
std::optional<int> log2_if_power(double c) {
  int exponent = 0;
  if (c == 0 || std::abs(std::frexp(c, &exponent)) != 0.5) return std::nullopt;
  return exponent - 1;
}

/// Rebuilds nodes one by one on top of `out`. Each rule is an identity of IEEE arithmetic up to the sign of a zero:
/// x + (-y) = x - y, (-x) y = -(x y), y - x = -(x - y), 2^k x + 2^k y = 2^k (x + y) for k > 0.
class Rewriter {
 public:
  explicit Rewriter(Graph& out) : out_(out) {}

  NodeId add(NodeId x, NodeId y) {
    if (is_constant(x, 0)) return y;
    if (is_constant(y, 0)) return x;
    if (const auto folded = fold_sum(x, y, false)) return *folded;
    if (is(x, Op::neg) && is(y, Op::neg)) return neg(add(operand(x), operand(y)));
    if (is(y, Op::neg)) return sub(x, operand(y));
    if (is(x, Op::neg)) return sub(y, operand(x));
    if (const auto k = common_scaling(x, y)) return scale(add(operand(x), operand(y)), *k);
    return out_.add(x, y);
  }

  NodeId sub(NodeId x, NodeId y) {
    if (is_constant(y, 0)) return x;
    if (is_constant(x, 0)) return neg(y);
    if (const auto folded = fold_sum(x, y, true)) return *folded;
    if (is(x, Op::neg) && is(y, Op::neg)) return sub(operand(y), operand(x));
    if (is(y, Op::neg)) return add(x, operand(y));
    if (is(x, Op::neg)) return neg(add(operand(x), y));
    if (const auto k = common_scaling(x, y)) return scale(sub(operand(x), operand(y)), *k);
    // One node for a difference and its negative: the one that was made first.
    if (const auto made = differences_.find({y, x}); made != differences_.end()) return neg(made->second);
    return differences_.emplace(std::pair{x, y}, out_.sub(x, y)).first->second;
  }

  NodeId mul(NodeId x, NodeId y) {
    if (is(x, Op::constant)) std::swap(x, y);
    if (is(y, Op::constant)) {
      const double c = out_[y].value;
      if (is(x, Op::constant)) {
        const double product = out_[x].value * c;
        if (std::abs(product) > 0x1p-900 && std::isfinite(product) && std::fma(out_[x].value, c, -product) == 0) {
          return out_.constant(product);
        }
      }
      if (const auto k = log2_if_power(c)) return c < 0 ? neg(scale(x, *k)) : scale(x, *k);
      if (c < 0) return neg(mul(x, out_.constant(-c)));
    }
    if (is(x, Op::neg) && is(y, Op::neg)) return mul(operand(x), operand(y));
    if (is(x, Op::neg)) return neg(mul(operand(x), y));
    if (is(y, Op::neg)) return neg(mul(x, operand(y)));
    return out_.mul(x, y);
  }

  NodeId div(NodeId x, NodeId y) {
    if (is(y, Op::constant)) {
      const double c = out_[y].value;
      if (const auto k = log2_if_power(c)) return c < 0 ? neg(scale(x, -*k)) : scale(x, -*k);
      if (c < 0) return neg(div(x, out_.constant(-c)));
    }
    if (is(x, Op::neg) && is(y, Op::neg)) return div(operand(x), operand(y));
    if (is(x, Op::neg)) return neg(div(operand(x), y));
    if (is(y, Op::neg)) return neg(div(x, operand(y)));
    return out_.binary(Op::div, x, y);
  }

  NodeId neg(NodeId x) {
    if (is(x, Op::neg)) return operand(x);
    if (is(x, Op::constant)) return out_.constant(-out_[x].value);
    return out_.neg(x);
  }

  NodeId scale(NodeId x, int k) {
    if (k == 0) return x;
    if (is(x, Op::neg)) return neg(scale(operand(x), k));
    if (is(x, Op::constant)) {
      const double scaled = std::ldexp(out_[x].value, k);
      if (std::isfinite(scaled) && std::ldexp(scaled, -k) == out_[x].value) return out_.constant(scaled);
    }
    // Two scalings upwards merge; others do not (an underflow in between would disappear, or be rounded once, not
    // twice).
    if (k > 0 && is(x, Op::mul_pow2) && out_[x].index > 0) return out_.mul_pow2(operand(x), out_[x].index + k);
    return out_.mul_pow2(x, k);
  }

  NodeId abs(NodeId x) {
    if (is(x, Op::abs)) return x;
    if (is(x, Op::neg)) return abs(operand(x));
    if (is(x, Op::constant)) return out_.constant(std::abs(out_[x].value));
    return out_.abs(x);
  }

  NodeId select(NodeId condition, NodeId x, NodeId y) {
    if (x == y) return x;
    if (is(x, Op::neg) && is(y, Op::neg)) return neg(out_.select(condition, operand(x), operand(y)));
    return out_.select(condition, x, y);
  }

  NodeId extremum(Op op, NodeId x, NodeId y) { return x == y ? x : out_.binary(op, x, y); }

 private:
  bool is(NodeId x, Op op) const { return out_[x].op == op; }
  bool is_constant(NodeId x, double c) const { return is(x, Op::constant) && out_[x].value == c; }
  NodeId operand(NodeId x) const { return out_[x].a; }

  /// The sum of two constants, if it is exact.
  std::optional<NodeId> fold_sum(NodeId x, NodeId y, bool subtract) {
    if (!is(x, Op::constant) || !is(y, Op::constant)) return std::nullopt;
    const double a = out_[x].value;
    const double b = subtract ? -out_[y].value : out_[y].value;
    const double s = a + b;
    const double a_part = s - b;
    if ((a - a_part) + (b - (s - a_part)) != 0 || !std::isfinite(s)) return std::nullopt;
    return out_.constant(s);
  }

  /// k > 0 if both are scalings by 2^k of something.
  std::optional<int> common_scaling(NodeId x, NodeId y) const {
    if (!is(x, Op::mul_pow2) || !is(y, Op::mul_pow2)) return std::nullopt;
    const int k = out_[x].index;
    if (k <= 0 || out_[y].index != k) return std::nullopt;
    return k;
  }

  Graph& out_;
  std::map<std::pair<NodeId, NodeId>, NodeId> differences_;
};

std::vector<bool> reachable(const dsl::Predicate& predicate) {
  std::vector<bool> used(static_cast<std::size_t>(predicate.graph.size()), false);
  for (const auto& stage : predicate.stages) {
    for (const auto& output : stage.outputs) {
      for (const NodeId id : output.nodes) used[static_cast<std::size_t>(id)] = true;
    }
  }
  for (NodeId id = predicate.graph.size() - 1; id >= 0; --id) {
    if (!used[static_cast<std::size_t>(id)]) continue;
    const Node& n = predicate.graph[id];
    for (const NodeId operand : {n.a, n.b, n.c}) {
      if (operand != no_node) used[static_cast<std::size_t>(operand)] = true;
    }
  }
  return used;
}

/// One rebuild from the outputs: rewritten by the rules, or only copied to leave unreachable nodes behind.
dsl::Predicate rebuilt(const dsl::Predicate& predicate, bool rewriting) {
  dsl::Predicate result = predicate;
  result.graph = Graph{};
  Rewriter rewrite(result.graph);
  const std::vector<bool> used = reachable(predicate);
  std::vector<NodeId> image(used.size(), no_node);
  const auto at = [&](NodeId id) { return id == no_node ? no_node : image[static_cast<std::size_t>(id)]; };
  for (NodeId id = 0; id < predicate.graph.size(); ++id) {
    if (!used[static_cast<std::size_t>(id)]) continue;
    const Node& n = predicate.graph[id];
    NodeId& to = image[static_cast<std::size_t>(id)];
    if (!rewriting) {
      to = result.graph.intern({n.op, at(n.a), at(n.b), at(n.c), n.index, n.value});
      continue;
    }
    switch (n.op) {
      case Op::input:
        to = result.graph.input(n.index);
        break;
      case Op::constant:
        to = result.graph.constant(n.value);
        break;
      case Op::add:
        to = rewrite.add(at(n.a), at(n.b));
        break;
      case Op::sub:
        to = rewrite.sub(at(n.a), at(n.b));
        break;
      case Op::neg:
        to = rewrite.neg(at(n.a));
        break;
      case Op::mul:
        to = rewrite.mul(at(n.a), at(n.b));
        break;
      case Op::mul_pow2:
        to = rewrite.scale(at(n.a), n.index);
        break;
      case Op::div:
        to = rewrite.div(at(n.a), at(n.b));
        break;
      case Op::sqrt:
        to = result.graph.unary(Op::sqrt, at(n.a));
        break;
      case Op::abs:
        to = rewrite.abs(at(n.a));
        break;
      case Op::min:
      case Op::max:
      case Op::max_magnitude:
        to = rewrite.extremum(n.op, at(n.a), at(n.b));
        break;
      case Op::certain_nonzero:
      case Op::certain_nonnegative:
        to = result.graph.binary(n.op, at(n.a), at(n.b));
        break;
      case Op::normalizer:
        to = result.graph.unary(n.op, at(n.a));
        break;
      case Op::select:
        to = rewrite.select(at(n.a), at(n.b), at(n.c));
        break;
      case Op::fma:
        to = result.graph.fma(at(n.a), at(n.b), at(n.c));
        break;
    }
  }
  for (auto& stage : result.stages) {
    for (auto& output : stage.outputs) {
      for (NodeId& id : output.nodes) id = at(id);
    }
  }
  return result;
}

}  // namespace

dsl::Predicate simplify(const dsl::Predicate& predicate) { return rebuilt(rebuilt(predicate, true), false); }

}  // namespace tightrope::codegen
