#include "codegen/interval_bound.h"

#include <initializer_list>
#include <utility>

#include "codegen/alternatives.h"
#include "codegen/bound_expression.h"
#include "codegen/precision.h"

namespace tightrope::codegen {

namespace {

using dsl::Graph;
using dsl::Node;
using dsl::NodeId;
using dsl::Op;

/// Both ends; one node for an exact value.
struct Interval {
  NodeId lo = dsl::no_node;
  NodeId hi = dsl::no_node;
  bool exact() const { return lo == hi; }
};

class IntervalBounds {
 public:
  IntervalBounds(const dsl::Predicate& predicate, const FloatFormat& format, Weakening weakening,
                 dsl::Diagnostics& diagnostics, Graph& graph)
      : predicate_(predicate),
        weakening_(weakening),
        diagnostics_(diagnostics),
        reporters_(outputs_of_nodes(predicate)),
        graph_(graph),
        r_(graph, format) {
    const double u = format.unit_roundoff * (weakened(Weakening::halve_unit_roundoff) ? 0.5 : 1);
    unit_ = graph_.constant(round_up(u * (1 + 4 * u), format));
    eta_ = graph_.constant(format.eta);
    zero_ = graph_.constant(0);
  }

  void run(BoundedPredicate& result);

 private:
  NodeId reach(NodeId x);
  NodeId down(NodeId x) { return graph_.sub(x, reach(x)); }
  NodeId up(NodeId x) { return graph_.add(x, reach(x)); }
  Interval outward(NodeId lo, NodeId hi, Weakening dropped);
  Interval outward_hull(std::initializer_list<NodeId> candidates, Weakening dropped);
  NodeId extreme(Op op, std::initializer_list<NodeId> candidates);

  Interval input(NodeId id, const Node& n);
  Interval sum(const Node& n);
  Interval product(const Node& n);
  Interval square(const Interval& a);
  Interval fused(const Node& n);
  Interval selection(const Node& n);
  Interval quotient(const Node& n);
  Interval square_root(const Interval& a);
  Interval absolute(const Interval& a);
  Interval scaled(const Interval& a, int exponent);
  Interval rule(NodeId id, const Node& n);
  BoundedNode output(NodeId id);

  const Interval& at(NodeId id) const { return intervals_[static_cast<std::size_t>(id)]; }
  bool weakened(Weakening w) const { return weakening_ == w; }

  const dsl::Predicate& predicate_;
  Weakening weakening_;
  dsl::Diagnostics& diagnostics_;
  std::vector<const dsl::Output*> reporters_;
  Graph& graph_;
  BoundExpressions r_;
  std::vector<Interval> intervals_;
  NodeId unit_ = dsl::no_node;
  NodeId eta_ = dsl::no_node;
  NodeId zero_ = dsl::no_node;
};

/// e of lemma I.
NodeId IntervalBounds::reach(NodeId x) {
  const NodeId relative = graph_.mul(r_.magnitude(x), unit_);
  return weakened(Weakening::drop_underflow) ? relative : graph_.add(relative, eta_);
}

Interval IntervalBounds::outward(NodeId lo, NodeId hi, Weakening dropped) {
  return weakened(dropped) ? Interval{lo, hi} : Interval{down(lo), up(hi)};
}

NodeId IntervalBounds::extreme(Op op, std::initializer_list<NodeId> candidates) {
  NodeId result = dsl::no_node;
  for (const NodeId x : candidates) {
    result = result == dsl::no_node || result == x ? x : graph_.binary(op, result, x);
  }
  return result;
}

Interval IntervalBounds::outward_hull(std::initializer_list<NodeId> candidates, Weakening dropped) {
  return outward(extreme(Op::min, candidates), extreme(Op::max, candidates), dropped);
}

// ------------------------------------------------------------------ the rules

Interval IntervalBounds::input(NodeId id, const Node& n) {
  const dsl::Slot& slot = predicate_.slots[static_cast<std::size_t>(n.index)];
  const dsl::Parameter& parameter = predicate_.parameters[static_cast<std::size_t>(slot.parameter)];
  if (parameter.normalized >= 0 && !weakened(Weakening::drop_underflow)) {  // eta reaches where s x was rounded
    return {graph_.sub(id, eta_), graph_.add(id, eta_)};
  }
  const bool bounded = parameter.bounded;
  if (!bounded || weakened(Weakening::drop_input_bound)) return {id, id};
  const NodeId bound = graph_.input(n.index + static_cast<std::int32_t>(predicate_.slots.size()));
  return {down(graph_.sub(id, bound)), up(graph_.add(id, bound))};
}

Interval IntervalBounds::sum(const Node& n) {
  const Interval a = at(n.a);
  const Interval b = at(n.b);
  const bool of_inputs = predicate_.graph[n.a].op == Op::input && predicate_.graph[n.b].op == Op::input;
  const Weakening dropped = of_inputs ? Weakening::drop_rounding_of_differences : Weakening::drop_rounding_of_sums;
  if (n.op == Op::add) return outward(graph_.add(a.lo, b.lo), graph_.add(a.hi, b.hi), dropped);
  return outward(graph_.sub(a.lo, b.hi), graph_.sub(a.hi, b.lo), dropped);
}

Interval IntervalBounds::product(const Node& n) {
  Interval a = at(n.a);
  Interval b = at(n.b);
  constexpr Weakening dropped = Weakening::drop_rounding_of_products;
  if (n.a == n.b && !a.exact()) return square(a);
  if (b.exact()) std::swap(a, b);
  if (a.exact() && graph_[a.lo].op == Op::constant) {
    const bool negative = graph_[a.lo].value < 0;
    return outward(graph_.mul(a.lo, negative ? b.hi : b.lo), graph_.mul(a.lo, negative ? b.lo : b.hi), dropped);
  }
  if (a.exact()) return outward_hull({graph_.mul(a.lo, b.lo), graph_.mul(a.lo, b.hi)}, dropped);
  return outward_hull({graph_.mul(a.lo, b.lo), graph_.mul(a.lo, b.hi), graph_.mul(a.hi, b.lo), graph_.mul(a.hi, b.hi)},
                      dropped);
}

/// Of the smallest and the largest magnitude; never below 0.
Interval IntervalBounds::square(const Interval& a) {
  const Interval size = absolute(a);
  const Interval result =
      outward(graph_.mul(size.lo, size.lo), graph_.mul(size.hi, size.hi), Weakening::drop_rounding_of_products);
  return {graph_.binary(Op::max, result.lo, zero_), result.hi};
}

Interval IntervalBounds::fused(const Node& n) {
  const Interval a = at(n.a);
  const Interval b = at(n.b);
  const Interval c = at(n.c);
  const auto candidate = [&](NodeId x, NodeId y, NodeId z) { return graph_.fma(x, y, z); };
  const auto hull = [&](Op op, NodeId z) {
    return extreme(
        op, {candidate(a.lo, b.lo, z), candidate(a.lo, b.hi, z), candidate(a.hi, b.lo, z), candidate(a.hi, b.hi, z)});
  };
  return outward(hull(Op::min, c.lo), hull(Op::max, c.hi), Weakening::drop_rounding_of_products);
}

/// The interval of the value that is taken; the condition is computed as it stands.
Interval IntervalBounds::selection(const Node& n) {
  const Interval first = at(n.b);
  const Interval second = at(n.c);
  if (weakened(Weakening::drop_second_alternative)) return first;
  const NodeId lo = graph_.select(n.a, first.lo, second.lo);
  return {lo, first.exact() && second.exact() ? lo : graph_.select(n.a, first.hi, second.hi)};
}

/// max(lo, -hi) is positive where the divisor's interval is on one side of 0; g - g is 0 there and NaN elsewhere.
Interval IntervalBounds::quotient(const Node& n) {
  const Interval a = at(n.a);
  Interval b = at(n.b);
  constexpr Weakening dropped = Weakening::drop_division_rounding;
  if (graph_[n.b].op == Op::constant) {
    const bool negative = graph_[n.b].value < 0;
    const auto end = [&](NodeId x) { return graph_.binary(Op::div, x, n.b); };
    return outward(end(negative ? a.hi : a.lo), end(negative ? a.lo : a.hi), dropped);
  }
  const bool exact_divisor = b.exact();
  const NodeId distance = exact_divisor ? r_.magnitude(b.lo) : graph_.binary(Op::max, b.lo, graph_.neg(b.hi));
  const NodeId guard = graph_.binary(Op::certain_nonnegative, distance, eta_);
  const NodeId zero_or_nan = graph_.sub(guard, guard);
  const auto quotient = [&](NodeId x, NodeId y) { return graph_.binary(Op::div, x, graph_.add(y, zero_or_nan)); };
  if (exact_divisor) return outward_hull({quotient(a.lo, b.lo), quotient(a.hi, b.lo)}, dropped);
  return outward_hull({quotient(a.lo, b.lo), quotient(a.lo, b.hi), quotient(a.hi, b.lo), quotient(a.hi, b.hi)},
                      dropped);
}

Interval IntervalBounds::square_root(const Interval& a) {
  const NodeId lo = graph_.unary(Op::sqrt, graph_.binary(Op::certain_nonnegative, a.lo, zero_));
  const NodeId hi = a.exact() ? lo : graph_.unary(Op::sqrt, a.hi);
  return outward(lo, hi, Weakening::drop_rounding_of_products);
}

Interval IntervalBounds::absolute(const Interval& a) {
  if (a.exact()) {
    const NodeId size = graph_.abs(a.lo);
    return {size, size};
  }
  const NodeId negative = graph_.neg(a.lo);
  return {extreme(Op::max, {a.lo, graph_.neg(a.hi), zero_}), graph_.binary(Op::max, negative, a.hi)};
}

/// Upwards exact, but an overflow must show: x - x is 0 for a finite x, else NaN. Downwards it loses half of eta at
/// most.
Interval IntervalBounds::scaled(const Interval& a, int exponent) {
  const NodeId lo = graph_.mul_pow2(a.lo, exponent);
  const NodeId hi = graph_.mul_pow2(a.hi, exponent);
  if (exponent > 0) return {graph_.add(lo, r_.zero_if_finite(lo)), graph_.add(hi, r_.zero_if_finite(hi))};
  if (exponent == 0 || weakened(Weakening::drop_underflow)) return {lo, hi};
  return {graph_.sub(lo, eta_), graph_.add(hi, eta_)};
}

Interval IntervalBounds::rule(NodeId id, const Node& n) {
  switch (n.op) {
    case Op::input:
      return input(id, n);
    case Op::constant:
      return {id, id};
    case Op::add:
    case Op::sub:
      return sum(n);
    case Op::neg: {
      const Interval a = at(n.a);
      const NodeId lo = graph_.neg(a.hi);
      return {lo, a.exact() ? lo : graph_.neg(a.lo)};
    }
    case Op::mul:
      return product(n);
    case Op::mul_pow2:
      return scaled(at(n.a), n.index);
    case Op::div:
      return quotient(n);
    case Op::sqrt:
      return square_root(at(n.a));
    case Op::abs:
      return absolute(at(n.a));
    case Op::min:
    case Op::max:
      return {graph_.binary(n.op, at(n.a).lo, at(n.b).lo), graph_.binary(n.op, at(n.a).hi, at(n.b).hi)};
    case Op::fma:
      return fused(n);
    case Op::select:
      return selection(n);
    case Op::certain_nonzero:
    case Op::certain_nonnegative:
    case Op::normalizer:
    case Op::max_magnitude:
      break;  // no operations of predicates
  }
  report_unbounded(n, *reporters_[static_cast<std::size_t>(id)], BoundMode::interval, diagnostics_);
  return {id, id};
}

// ------------------------------------------------------------------ outputs

/// x - x is 0 for a finite x, else NaN: an infinite input gives no sign.
BoundedNode IntervalBounds::output(NodeId id) {
  const Interval interval = at(id);
  if (interval.exact()) return {interval.lo, r_.zero_if_finite(interval.lo)};
  const NodeId middle = graph_.add(graph_.mul_pow2(interval.lo, -1), graph_.mul_pow2(interval.hi, -1));
  const NodeId above = up(graph_.sub(interval.hi, middle));
  const NodeId below = up(graph_.sub(middle, interval.lo));
  return {middle, graph_.binary(Op::max, above, below)};
}

void IntervalBounds::run(BoundedPredicate& result) {
  const std::vector<bool> has_bound = value_nodes(predicate_);
  for (NodeId id = 0; id < predicate_.graph.size(); ++id) {
    const Node n = predicate_.graph[id];
    intervals_.push_back(has_bound[static_cast<std::size_t>(id)] ? rule(id, n) : Interval{});
  }
  for (const auto& stage : predicate_.stages) {
    BoundedStage& bounded = result.stages.emplace_back();
    for (const auto& output : stage.outputs) {
      OutputBound& entry = bounded.outputs.emplace_back();
      for (const NodeId id : output.nodes) entry.elements.push_back(this->output(id));
    }
  }
}

}  // namespace

void add_interval_bounds(const dsl::Predicate& predicate, const FloatFormat& format, dsl::Diagnostics& diagnostics,
                         Weakening weakening, BoundedPredicate& result) {
  result.graph = predicate.graph;
  IntervalBounds(predicate, format, weakening, diagnostics, result.graph).run(result);
}

}  // namespace tightrope::codegen
