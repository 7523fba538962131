#include "codegen/tight_rules.h"

#include <algorithm>
#include <cmath>

namespace tightrope::codegen {

using dsl::no_node;
using dsl::Node;
using dsl::NodeId;
using dsl::Op;

namespace {

/// Whether a node is a rounded sum or difference of two inputs: what loses nothing but one rounding.
bool is_difference_of_inputs(const dsl::Graph& graph, const Node& n) {
  return (n.op == Op::sub || n.op == Op::add) && graph[n.a].op == Op::input && graph[n.b].op == Op::input;
}

}  // namespace

/// A bounded input's bound R comes in without slack: (1 + 2^-20) R pays for what is computed with it (MATH 4.3).
Error TightBounds::leaf(const Node& n) {
  const dsl::Slot& slot = predicate_.slots[static_cast<std::size_t>(n.index)];
  const dsl::Parameter& parameter = predicate_.parameters[static_cast<std::size_t>(slot.parameter)];
  if (parameter.normalized >= 0 && !weakened(Weakening::drop_underflow)) {  // what s x may have lost (normalize.h)
    Error lost;
    lost.underflow = 1;
    if (!use_ranges_) lost.terms.push_back({r_.constant(format_.eta / format_.unit_roundoff), false, 1});
    return lost;
  }
  if (!parameter.bounded) return {};
  if (weakened(Weakening::drop_input_bound)) return {};
  const NodeId bound = graph_.input(n.index + static_cast<std::int32_t>(predicate_.slots.size()));
  Error e;
  const NodeId r = r_.times_constant(bound, (1 + slack_) / format_.unit_roundoff);
  e.terms.push_back({r, false, 1});
  return e;
}

Error TightBounds::sum(NodeId id, const Node& n) {
  if (n.op == Op::add && nonnegative(n.a) && nonnegative(n.b)) {
    const auto relative_a = relative_but_for_underflow(n.a);
    const auto relative_b = relative_but_for_underflow(n.b);
    if (relative_a && relative_b) return sum_of_nonnegative(id, *relative_a, *relative_b, error(n.a), error(n.b));
  }
  Error e = error(n.a);
  const bool keep_second = !weakened(Weakening::drop_operand_error_of_sums);
  if (keep_second) {
    for (const Term& t : error(n.b).terms) add_term(e, t);
    e.slack_used = std::max(e.slack_used, error(n.b).slack_used);
    add_underflow(e, error(n.b).underflow);
  }
  const auto dropped = is_difference_of_inputs(predicate_.graph, n) ? Weakening::drop_rounding_of_differences
                                                                    : Weakening::drop_rounding_of_sums;
  if (!weakened(dropped)) add_rounding(e, id, 1);
  return e;
}

/// Lemma D. |La - a| <= pa u+ La + Ua, |Lb - b| <= pb u+ Lb + Ub and La, Lb >= 0 give
///   |L - (a + b)| <= max(pa, pb) u+ (La + Lb) + Ua + Ub + u L,   La + Lb <= L (1 + u).
Error TightBounds::sum_of_nonnegative(NodeId id, double relative_a, double relative_b, const Error& a,
                                      const Error& b) const {
  Error e;
  if (weakened(Weakening::drop_operand_error_of_sums)) relative_b = 0;
  const double own = weakened(Weakening::drop_rounding_of_sums) ? 0 : 1;
  add_rounding(e, id, add_up(std::max(relative_a, relative_b), own));
  e.underflow = add_up(a.underflow, b.underflow);
  e.slack_used = std::max(a.slack_used, b.slack_used) + 1;
  return e;
}

Error TightBounds::scaled(const Error& error, double factor) {
  Error e = error;
  for (Term& t : e.terms) t.coefficient = mul_up(t.coefficient, factor);
  e.underflow = mul_up(e.underflow, factor);
  return e;
}

Error TightBounds::product(NodeId id, const Node& n) {
  if (use_ranges_ && !std::isfinite(limit(n.a))) make_run_time(n.b);
  if (use_ranges_ && !std::isfinite(limit(n.b))) make_run_time(n.a);
  Error e;
  const std::optional<double> relative_a = relative(n.a);
  const std::optional<double> relative_b = relative(n.b);
  if (relative_a && relative_b) {
    e = relative_product(id, *relative_a, *relative_b);
  } else if (relative_a) {
    e = half_relative_product(id, n.a, *relative_a, n.b, true);
  } else if (relative_b) {
    e = half_relative_product(id, n.b, *relative_b, n.a, false);
  } else {
    add_general_product(e, n);
    if (!weakened(Weakening::drop_rounding_of_products)) add_rounding(e, id, 1);
  }
  e.slack_used += error(n.a).slack_used + error(n.b).slack_used;
  if (use_ranges_) e.underflow = 0;
  add_product_underflow(e, n);
  return e;
}

/// Lemma C: |La Lb - ab| grows by |La| Ub + |Lb| Ua + Ua Ub with |La| + Ra <= Ma, and by the product's own underflow:
/// eta / 2, as much again from lemma B. 4 eta without ranges (MATH 4.4) pays for underflow inside r as well.
void TightBounds::add_product_underflow(Error& e, const Node& n) {
  if (!use_ranges_) return add_underflow(e, 4);
  const double ua = error(n.a).underflow;
  const double ub = error(n.b).underflow;
  add_underflow(e, mul_up(limit(n.a), ub));
  add_underflow(e, mul_up(limit(n.b), ua));
  add_underflow(e, mul_up(mul_up(ua, ub), format_.eta));
  add_underflow(e, 2);
}

/// Lemma B, first half.
Error TightBounds::relative_product(NodeId id, double relative_a, double relative_b) {
  if (weakened(Weakening::drop_first_factor_error)) relative_a = 0;
  if (weakened(Weakening::drop_second_factor_error)) relative_b = 0;
  Error e;
  const double own = weakened(Weakening::drop_rounding_of_products) ? 0 : 1;
  add_rounding(e, id, add_up(add_up(relative_a, relative_b), own));
  e.slack_used = std::min(relative_a, relative_b) + 4;
  return e;
}

/// Lemma B, second half; `first` tells which operand the relative one (a) is. A constant's |La| is a coefficient.
Error TightBounds::half_relative_product(NodeId id, NodeId a, double relative_a, NodeId b, bool first) {
  const auto dropped_a = first ? Weakening::drop_first_factor_error : Weakening::drop_second_factor_error;
  const auto dropped_b = first ? Weakening::drop_second_factor_error : Weakening::drop_first_factor_error;
  Error e;
  if (!weakened(dropped_b)) {
    if (node(a).op == Op::constant) {
      e = scaled(error(b), std::abs(node(a).value));
      e.slack_used = 0;
    } else {
      add_term(e, {r_.times(r_.magnitude(value(a)), materialise(error(b))), false, 1});
    }
  }
  if (weakened(dropped_a)) relative_a = 0;
  const double own = weakened(Weakening::drop_rounding_of_products) ? 0 : 1;
  add_rounding(e, id, add_up(relative_a, own));
  e.slack_used += relative_a + 4;
  return e;
}

/// |La| rb + ra (|Lb| + u+ rb)
void TightBounds::add_general_product(Error& e, const Node& n) {
  const NodeId ra = materialise(error(n.a));
  const NodeId rb = materialise(error(n.b));
  NodeId widened = r_.magnitude(value(n.b));  // |Lb| + u+ rb
  if (!weakened(Weakening::drop_product_of_errors)) widened = r_.plus(widened, r_.times_constant(rb, unit_));
  if (!weakened(Weakening::drop_second_factor_error)) {
    add_term(e, {r_.times(r_.magnitude(value(n.a)), rb), false, 1});
  }
  if (!weakened(Weakening::drop_first_factor_error)) add_term(e, {r_.times(ra, widened), false, 1});
}

/// a b + c, rounded once: the error of a b before any rounding, that of c, and u |L|. The product itself is not
/// computed, so that lemma B has |La| |Lb| where a product has |L|.
Error TightBounds::fused(NodeId id, const Node& n) {
  if (use_ranges_ && !std::isfinite(limit(n.a))) make_run_time(n.b);
  if (use_ranges_ && !std::isfinite(limit(n.b))) make_run_time(n.a);
  Error e;
  if (!weakened(Weakening::drop_operand_error_of_sums)) e = error(n.c);
  const std::optional<double> relative_a = relative(n.a);
  const std::optional<double> relative_b = relative(n.b);
  // (1 + x)(1 + y) - 1 <= (x + y)(1 + min(x, y)), and with a general error on one side, x the relative one's: 1 + x.
  const double pa = weakened(Weakening::drop_first_factor_error) ? 0 : relative_a.value_or(0);
  const double pb = weakened(Weakening::drop_second_factor_error) ? 0 : relative_b.value_or(0);
  if (!relative_a && !relative_b) {
    add_general_product(e, n);
  } else {
    const double p = add_up(pa, pb);
    if (p > 0) add_term(e, {r_.times(r_.magnitude(value(n.a)), r_.magnitude(value(n.b))), false, p});
    if (!relative_b && !weakened(Weakening::drop_second_factor_error)) {
      add_term(e, {r_.times(r_.magnitude(value(n.a)), materialise(error(n.b))), false, 1});
    }
    if (!relative_a && !weakened(Weakening::drop_first_factor_error)) {
      add_term(e, {r_.times(r_.magnitude(value(n.b)), materialise(error(n.a))), false, 1});
    }
  }
  if (!weakened(Weakening::drop_fma_rounding)) add_rounding(e, id, 1);
  const double smaller = relative_a && relative_b ? std::min(pa, pb) : std::max(pa, pb);
  e.slack_used += error(n.a).slack_used + error(n.b).slack_used + smaller + 3;
  add_product_underflow(e, n);
  return e;
}

/// Division by an exact constant c. A relative error stays one: |La / c| <= (|L| + eta/2) / (1 - u).
Error TightBounds::constant_quotient(NodeId id, const Node& n) {
  const double inverse = div_up(1, std::abs(node(n.b).value));
  Error e;
  if (const auto rho = relative(n.a)) {
    e.slack_used = error(n.a).slack_used + 3;
    add_rounding(e, id, *rho);
    e.underflow = use_ranges_ ? mul_up(error(n.a).underflow, inverse) : 0;
  } else {
    e = scaled(error(n.a), inverse);
  }
  if (!weakened(Weakening::drop_division_rounding)) add_rounding(e, id, 1);
  add_underflow(e, use_ranges_ ? 2 : 4);
  return e;
}

Error TightBounds::extremum(const Node& n) {
  const Error& ea = error(n.a);
  const Error& eb = error(n.b);
  NodeId guard = no_node;
  for (const NodeId operand : {n.a, n.b}) {
    if (hides_overflow(operand)) guard = r_.plus(guard, r_.zero_if_finite(value(operand)));
  }
  if (ea.exact() && eb.exact() && guard == no_node) return {};
  Error e;
  const NodeId ra = materialise(ea);
  const NodeId rb = materialise(eb);
  if (ra != no_node || rb != no_node) {
    e.terms.push_back({ra == no_node ? rb : rb == no_node ? ra : r_.maximum(ra, rb), false, 1});
  }
  e.underflow = use_ranges_ ? std::max(ea.underflow, eb.underflow) : 0;
  e.slack_used = std::max(ea.slack_used, eb.slack_used);
  if (guard != no_node) e.terms.push_back({guard, false, 1});
  return e;
}

/// The bound of the value that is taken. Errors relative to either value are so to the one taken.
Error TightBounds::selection(NodeId id, const Node& n) {
  const Error& first = error(n.b);
  const Error& second = error(n.c);
  Error e;
  e.underflow = use_ranges_ ? std::max(first.underflow, second.underflow) : 0;
  e.slack_used = std::max(first.slack_used, second.slack_used);
  if (weakened(Weakening::drop_second_alternative)) {
    e.terms = {{materialise(first), false, 1}};
    if (e.terms[0].node == no_node) e.terms.clear();
    return e;
  }
  const auto relative_first = relative(n.b);
  const auto relative_second = relative(n.c);
  if (relative_first && relative_second) {
    add_rounding(e, id, std::max(*relative_first, *relative_second));
    return e;
  }
  const auto bound = [&](const Error& of_one) {
    const NodeId r = materialise(of_one);
    return r == no_node ? graph_.constant(0) : r;
  };
  const NodeId r = bound(first);
  add_term(e, {r_.selected(value(n.a), r, bound(second)), false, 1});
  return e;
}

Error TightBounds::scaling(NodeId id, const Node& n) {
  Error e = scaled(error(n.a), std::max(std::ldexp(1.0, n.index), 0x1p-1074));
  // The term of a relative error becomes the scaled value's own, so that it stays relative: |2^k a| = 2^k |a|.
  if (const auto rho = relative(n.a); rho && *rho > 0 && n.index > 0) e.terms = {{value(id), true, *rho}};
  if (n.index < 0) add_underflow(e, use_ranges_ ? 1 : 4);
  return e;
}

Error TightBounds::rule(NodeId id, const Node& n, const dsl::Output* reporter) {
  switch (n.op) {
    case Op::input:
      return leaf(n);
    case Op::constant:
      return {};
    case Op::add:
    case Op::sub:
      return sum(id, n);
    case Op::neg:
    case Op::abs:
      return error(n.a);
    case Op::mul:
      return product(id, n);
    case Op::fma:
      return fused(id, n);
    case Op::mul_pow2:
      return scaling(id, n);
    case Op::min:
    case Op::max:
      return extremum(n);
    case Op::select:
      return selection(id, n);
    case Op::div:
      return node(n.b).op == Op::constant ? constant_quotient(id, n) : quotient(id, n);
    case Op::sqrt:
      return root(id, n);
    case Op::certain_nonzero:
    case Op::certain_nonnegative:
    case Op::normalizer:
    case Op::max_magnitude:
      break;
  }
  report_unbounded(n, *reporter, BoundMode::tight, diagnostics_);
  return {};
}

}  // namespace tightrope::codegen
