#include "codegen/static_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "codegen/alternatives.h"
#include "codegen/bound_expression.h"
#include "codegen/error_sum.h"
#include "codegen/precision.h"

namespace tightrope::codegen {

namespace {

using dsl::Graph;
using dsl::no_node;
using dsl::Node;
using dsl::NodeId;
using dsl::Op;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// What is known of a node's computed value; its exact range is RangeAnalysis's.
struct Computed {
  Range range;
  double error = 0;     ///< e
  double rounding = 0;  ///< rho, what of it arises here
};

/// What a rule says before the result is rounded.
struct Unrounded {
  Range range;       ///< of r, from computed operands
  double error = 0;  ///< |r - v|
};

class StaticBounds {
 public:
  StaticBounds(const dsl::Predicate& predicate, const FloatFormat& format, Weakening weakening,
               dsl::Diagnostics& diagnostics, StaticLemmas lemmas)
      : predicate_(predicate),
        format_(format),
        weakening_(weakening),
        diagnostics_(diagnostics),
        lemmas_(lemmas == StaticLemmas::all),
        graph_(predicate.graph),
        ranges_(graph_, exact_limits(), lemmas_),
        reporters_(outputs_of_nodes(predicate)) {}

  void run(BoundedPredicate& result);

 private:
  std::vector<double> exact_limits() const;
  const dsl::Parameter& parameter_of(const Node& n) const;
  Computed input(const Node& n) const;
  Unrounded product(const Node& n) const;
  Unrounded quotient(NodeId id, const Node& n);
  Unrounded square_root(NodeId id, const Node& n);
  Unrounded rule(NodeId id, const Node& n);
  double rounding(const Node& n, double largest) const;
  Computed computed(NodeId id, const Node& n);
  void complain(NodeId id, const std::string& message, const std::string& hint);

  const Range& exact(NodeId id) const { return ranges_.of(id); }
  const Computed& at(NodeId id) const { return computed_[static_cast<std::size_t>(id)]; }
  bool weakened(Weakening w) const { return weakening_ == w; }

  const dsl::Predicate& predicate_;
  const FloatFormat& format_;
  Weakening weakening_;
  dsl::Diagnostics& diagnostics_;
  bool lemmas_;
  Graph graph_;  ///< the predicate's, and the derivatives of its outputs
  RangeAnalysis ranges_;
  std::vector<const dsl::Output*> reporters_;
  std::vector<Computed> computed_;
  bool complained_ = false;
};

const dsl::Parameter& StaticBounds::parameter_of(const Node& n) const {
  const dsl::Slot& slot = predicate_.slots[static_cast<std::size_t>(n.index)];
  return predicate_.parameters[static_cast<std::size_t>(slot.parameter)];
}

std::vector<double> StaticBounds::exact_limits() const {
  std::vector<double> result;
  for (const dsl::Slot& slot : predicate_.slots) {
    const dsl::Parameter& p = predicate_.parameters[static_cast<std::size_t>(slot.parameter)];
    result.push_back(p.range.value_or(infinity) * (p.bounded ? 2 : 1));
  }
  return result;
}

/// One error a predicate: what follows from it would only repeat it.
void StaticBounds::complain(NodeId id, const std::string& message, const std::string& hint) {
  if (complained_) return;
  complained_ = true;
  diagnostics_.error(reporters_[static_cast<std::size_t>(id)]->span, message, hint);
}

// ------------------------------------------------------------------ the rules

Computed StaticBounds::input(const Node& n) const {
  const dsl::Parameter& p = parameter_of(n);
  double error = p.bounded && !weakened(Weakening::drop_input_bound) ? *p.range : 0;
  if (p.normalized >= 0 && !weakened(Weakening::drop_underflow)) error = format_.eta;  // of s x, see normalize.h
  return {symmetric(*p.range), error, error};
}

/// Of the two ways to split a b - a^ b^ the better.
Unrounded StaticBounds::product(const Node& n) const {
  const Computed& a = at(n.a);
  const Computed& b = at(n.b);
  const double ea = weakened(Weakening::drop_first_factor_error) ? 0 : a.error;
  const double eb = weakened(Weakening::drop_second_factor_error) ? 0 : b.error;
  const bool crossed = !weakened(Weakening::drop_product_of_errors);
  const auto split = [&](const Range& first, const Range& second) {
    return add_up(mul_up(magnitude(first), eb), mul_up(ea, magnitude(second)));
  };
  const double error =
      crossed ? std::min(split(exact(n.a), b.range), split(a.range, exact(n.b))) : split(a.range, b.range);
  return {n.a == n.b ? square(a.range) : a.range * b.range, error};
}

Unrounded StaticBounds::quotient(NodeId id, const Node& n) {
  const Computed& a = at(n.a);
  const Computed& b = at(n.b);
  if (contains_zero(exact(n.b)) || contains_zero(b.range)) {
    complain(id, "the declared ranges do not keep a divisor away from 0",
             "a bound in mode `static` needs that; try --bound tight, which tests it at run time");
    return {symmetric(infinity), infinity};
  }
  const auto split = [&](const Range& ratio, const Range& divisor) {
    return div_up(add_up(a.error, mul_up(magnitude(ratio), b.error)), mignitude(divisor));
  };
  const Range ratio = codegen::quotient(a.range, b.range);
  return {ratio, std::min(split(exact(id), b.range), split(ratio, exact(n.b)))};
}

Unrounded StaticBounds::square_root(NodeId id, const Node& n) {
  const Computed& a = at(n.a);
  if (exact(n.a).lo < 0 || a.range.lo < 0) {
    complain(id, "the declared ranges do not keep the radicand of a square root from being negative",
             "a bound in mode `static` needs that; try --bound tight, which tests it at run time");
    return {symmetric(infinity), infinity};
  }
  const double roots = sum_down(root_down(exact(n.a).lo), root_down(a.range.lo));
  const double relative = roots > 0 ? div_up(a.error, roots) : infinity;
  return {root(a.range), std::min(root_up(a.error), relative)};
}

Unrounded StaticBounds::rule(NodeId id, const Node& n) {
  switch (n.op) {
    case Op::constant:
      return {{n.value, n.value}, 0};
    case Op::add:
    case Op::sub: {
      const double eb = weakened(Weakening::drop_operand_error_of_sums) ? 0 : at(n.b).error;
      const Range range = n.op == Op::add ? at(n.a).range + at(n.b).range : at(n.a).range - at(n.b).range;
      return {range, add_up(at(n.a).error, eb)};
    }
    case Op::neg:
      return {-at(n.a).range, at(n.a).error};
    case Op::mul:
      return product(n);
    case Op::mul_pow2:
      return {scaled(at(n.a).range, n.index), scaled_up(at(n.a).error, n.index)};
    case Op::div:
      return quotient(id, n);
    case Op::sqrt:
      return square_root(id, n);
    case Op::abs:
      return {absolute(at(n.a).range), at(n.a).error};
    case Op::min:
      return {minimum(at(n.a).range, at(n.b).range), std::max(at(n.a).error, at(n.b).error)};
    case Op::max:
      return {maximum(at(n.a).range, at(n.b).range), std::max(at(n.a).error, at(n.b).error)};
    case Op::select: {
      const double second = weakened(Weakening::drop_second_alternative) ? 0 : at(n.c).error;
      return {hull(at(n.b).range, at(n.c).range), std::max(at(n.b).error, second)};
    }
    case Op::fma: {
      const Unrounded ab = product(n);
      return {ab.range + at(n.c).range, add_up(ab.error, at(n.c).error)};
    }
    case Op::input:
    case Op::certain_nonzero:
    case Op::certain_nonnegative:
    case Op::normalizer:
    case Op::max_magnitude:
      break;  // no operations of predicates
  }
  report_unbounded(n, *reporters_[static_cast<std::size_t>(id)], BoundMode::fixed, diagnostics_);
  complained_ = true;
  return {symmetric(infinity), infinity};
}

bool is_difference_of_inputs(const Graph& graph, const Node& n) {
  return (n.op == Op::add || n.op == Op::sub) && graph[n.a].op == Op::input && graph[n.b].op == Op::input;
}

/// rho of the header for |r| <= largest.
double StaticBounds::rounding(const Node& n, double largest) const {
  const bool sum = n.op == Op::add || n.op == Op::sub;
  const bool scaling = n.op == Op::mul_pow2;
  const bool rounded = sum || scaling || n.op == Op::mul || n.op == Op::div || n.op == Op::sqrt || n.op == Op::fma;
  if (!rounded || largest == 0) return 0;
  if (sum && weakened(is_difference_of_inputs(graph_, n) ? Weakening::drop_rounding_of_differences
                                                         : Weakening::drop_rounding_of_sums)) {
    return 0;
  }
  if (n.op == Op::mul && weakened(Weakening::drop_rounding_of_products)) return 0;
  if (n.op == Op::div && weakened(Weakening::drop_division_rounding)) return 0;
  if (!std::isfinite(largest)) return infinity;
  int exponent = 0;  // |r| <= 2^exponent
  if (std::frexp(largest, &exponent) == 0.5) --exponent;
  const bool subnormal = exponent - 1 < format_.min_exponent;
  if (sum && exponent - 1 <= format_.min_exponent) return 0;
  if (scaling && n.index > 0) return 0;
  if ((subnormal || scaling) && weakened(Weakening::drop_underflow)) return 0;
  // A scaling downwards rounds only what becomes subnormal.
  const int binade = subnormal || scaling ? format_.min_exponent : exponent - 1;
  const double half_ulp = scaled_up(1, binade - format_.significand_bits);
  return weakened(Weakening::halve_unit_roundoff) ? half_ulp / 2 : half_ulp;
}

Computed StaticBounds::computed(NodeId id, const Node& n) {
  if (n.op == Op::input) return input(n);
  const Unrounded r = rule(id, n);
  const Range range = intersection(r.range, widened(exact(id), r.error));
  const double rho = rounding(n, magnitude(range));
  const Range rounded = {-round_up(-range.lo, format_), round_up(range.hi, format_)};
  if (!std::isfinite(magnitude(rounded))) {
    complain(id, "within the declared ranges a value may overflow", "mode `static` needs smaller ranges");
  }
  return {rounded, add_up(r.error, rho), rho};
}

void StaticBounds::run(BoundedPredicate& result) {
  const std::vector<bool> has_bound = value_nodes(predicate_);
  for (NodeId id = 0; id < predicate_.graph.size(); ++id) {
    computed_.push_back(has_bound[static_cast<std::size_t>(id)] ? computed(id, predicate_.graph[id]) : Computed{});
  }
  if (complained_) return;
  std::vector<double> roundings;
  for (const Computed& c : computed_) roundings.push_back(c.rounding);
  ErrorSum sums(graph_, ranges_, std::move(roundings), weakening_);
  result.graph = predicate_.graph;
  for (const auto& stage : predicate_.stages) {
    BoundedStage& bounded = result.stages.emplace_back();
    for (const auto& output : stage.outputs) {
      OutputBound& entry = bounded.outputs.emplace_back();
      for (const NodeId id : output.nodes) {
        const double bound = round_up(lemmas_ ? std::min(at(id).error, sums.bound(id)) : at(id).error, format_);
        entry.elements.push_back({id, result.graph.constant(bound)});
        entry.constant = std::max(entry.constant, bound);
      }
      entry.assumption = "inputs within their declared ranges";
    }
  }
}

}  // namespace

void add_static_bounds(const dsl::Predicate& predicate, const FloatFormat& format, dsl::Diagnostics& diagnostics,
                       Weakening weakening, BoundedPredicate& result, StaticLemmas lemmas) {
  for (const dsl::Parameter& p : predicate.parameters) {
    if (p.range) continue;
    diagnostics.error(
        predicate.stages.front().outputs.front().span,
        "mode `static` needs a range of every input; `" + p.name + "` of predicate `" + predicate.name + "` has none",
        "declare one: range |" + p.name + "| <= 1");
    return;
  }
  StaticBounds(predicate, format, weakening, diagnostics, lemmas).run(result);
}

}  // namespace tightrope::codegen
