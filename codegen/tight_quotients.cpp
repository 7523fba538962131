#include <algorithm>
#include <cmath>

#include "codegen/tight_rules.h"

namespace tightrope::codegen {

using dsl::no_node;
using dsl::Node;
using dsl::NodeId;
using dsl::Op;

// ------------------------------------------------------------------ division by a run-time value

/// The divisor, or NaN where the exact one may be 0 (or is an infinity: a quotient of 0 would forget it). A divisor
/// with a relative error below 1 is 0 exactly where its exact value is.
NodeId TightBounds::guarded_divisor(NodeId b) {
  if (weakened(Weakening::drop_guards)) return value(b);
  NodeId bound = no_node;
  if (purely_relative(b)) {
    bound = r_.zero_if_finite(value(b));
  } else {
    make_run_time(b);
    bound = output_bound(b);
  }
  return graph_.binary(Op::certain_nonzero, value(b), bound);
}

/// L = fl(La / Lb), q = La / Lb: |q - L| <= u |L| + eta/2, and |q| <= (1 + u) |L| + eta/2.
///
/// Both errors relative, x = pa u+, y = pb u+ (y < 1/28, for 2 pb + 4 roundings are paid by a slack of at most 1/8):
///   |q - a/b| = |q| |1 - (1 +- x) / (1 +- y)| <= |q| (x + y) / (1 - y),
/// so that |L - a/b| <= (pa + pb + 1) u+ |L| (1 + u)/(1 - y) + eta, and (1 + u)/(1 - y) <= (1 - u)^-(2 pb + 4).
///
/// Only b's: |La/Lb - a/b| <= (Ra/|Lb| + |q| y) / (1 - y), so r = ra / |Lb| + (pb + 1) |L|, with the same factor.
Error TightBounds::quotient(NodeId id, const Node& n) {
  if (!purely_relative(n.b)) return general_quotient(id, n);
  const double relative_b = relative(n.b).value_or(0);
  Error e;
  double p = weakened(Weakening::drop_divisor_error) ? 0 : relative_b;
  if (weakened(Weakening::drop_dividend_error)) {
  } else if (purely_relative(n.a)) {
    p = add_up(p, relative(n.a).value_or(0));
  } else {
    make_run_time(n.a);
    add_term(e, {r_.quotient(materialise(error(n.a)), r_.magnitude(graph_[value(id)].b)), false, 1});
  }
  add_rounding(e, id, add_up(p, weakened(Weakening::drop_division_rounding) ? 0 : 1));
  e.slack_used = error(n.a).slack_used + error(n.b).slack_used + 2 * relative_b + 4;
  add_underflow(e, use_ranges_ ? 2 : 4);
  return e;
}

/// |La/Lb - a/b| = |(La - a) + q (b - Lb)| / |b| <= (Ra + |q| Rb) / (|Lb| - Rb), so
///   r = (ra + (|L| + eta) rb) / (|Lb| - Rb) + |L|.
/// Rb is the computed bound, a true one on its own, and the guard has found |Lb| > Rb; rounding |Lb| - Rb and replacing
/// |q| cost one factor 1 + u each.
///
/// Underflow: the product in the numerator may lose eta/2, which a small divisor amplifies, so the numerator has a
/// constant: that of ra, or else eta. (La = eta, Lb = 4, Rb = 4 (1 - 2^-50) has L = 0 and a true quotient up to
/// 2^48 eta: the eta beside |L| is for that.) What the quotient loses is at most u eta of R, part of the 4 eta.
Error TightBounds::general_quotient(NodeId id, const Node& n) {
  const bool has_constant = error(n.a).underflow > 0;
  const bool without_underflow = weakened(Weakening::drop_underflow);
  make_run_time(n.a);
  make_run_time(n.b);
  const NodeId divisor = r_.magnitude(graph_[value(id)].b);
  NodeId numerator = weakened(Weakening::drop_dividend_error) ? no_node : materialise(error(n.a));
  if (!weakened(Weakening::drop_divisor_error)) {
    NodeId quotient = r_.magnitude(value(id));
    if (!without_underflow) quotient = r_.plus(quotient, r_.constant(format_.eta));
    numerator = r_.plus(numerator, r_.times(quotient, materialise(error(n.b))));
  }
  if (!has_constant && !without_underflow) numerator = r_.plus(numerator, r_.constant(format_.eta));
  Error e;
  if (numerator != no_node) {
    const bool margin = !weakened(Weakening::drop_divisor_margin);
    add_term(e, {r_.quotient(numerator, margin ? graph_.sub(divisor, output_bound(n.b)) : divisor), false, 1});
  }
  if (!weakened(Weakening::drop_division_rounding)) add_rounding(e, id, 1);
  e.slack_used = error(n.a).slack_used + error(n.b).slack_used + 3;
  add_underflow(e, use_ranges_ ? 2 : 4);
  return e;
}

// ------------------------------------------------------------------ square root

/// The radicand, or NaN where the exact one may be negative.
NodeId TightBounds::guarded_radicand(NodeId a) {
  if (nonnegative(a) || weakened(Weakening::drop_guards)) return value(a);
  NodeId bound = no_node;
  if (purely_relative(a)) {
    bound = r_.constant(0);  // the sign of the computed value is that of the exact one
  } else {
    make_run_time(a);
    bound = output_bound(a);
  }
  return graph_.binary(Op::certain_nonnegative, value(a), bound);
}

/// L = fl(sqrt(La)), at most u L off the root: no root underflows (root_underflow is 0).
///
/// A relative error, x = pa u+ < 1/28, and a constant V for underflow: with y between La (1 - x) and La (1 + x),
///   |sqrt(La) - sqrt(a)| <= |sqrt(La) - sqrt(y)| + |sqrt(y) - sqrt(a)|
///                        <= sqrt(La) x / (2 - x) + V / max(sqrt(y), sqrt(V)),
/// so r = (pa/2 + 1) L + (V/u) / max(L, s), s a power of two <= sqrt(V); the factors are below (1 - u)^-(2 pa + 5).
/// A loss of that quotient to underflow (u eta) is below u^2 L, and counted in them too.
Error TightBounds::root(NodeId id, const Node& n) {
  const std::optional<double> relative_a = relative_but_for_underflow(n.a);
  if (!relative_a) return general_root(id, n);
  Error e;
  const double own = weakened(Weakening::drop_root_rounding) ? 0 : 1;
  const double underflow = error(n.a).underflow;
  if (weakened(Weakening::drop_radicand_error)) {
    add_rounding(e, id, own);
    return e;
  }
  add_rounding(e, id, add_up(*relative_a / 2, own));
  if (underflow > 0) {
    const double v = mul_up(underflow, format_.eta);
    const NodeId s = r_.constant(std::exp2(std::floor(std::log2(v) / 2)));
    const NodeId size = r_.maximum(r_.magnitude(value(id)), s);
    add_term(e, {r_.quotient(r_.constant(mul_up(v, 1 / format_.unit_roundoff)), size), false, 1});
  }
  e.slack_used = error(n.a).slack_used + 2 * *relative_a + 5;
  add_underflow(e, root_underflow(format_));
  return e;
}

/// |sqrt(La) - sqrt(a)| = |La - a| / (sqrt(La) + sqrt(a)) with sqrt(a) >= sqrt(La - Ra) >= (La - Ra) / sqrt(La) where
/// La >= Ra, which a guard has tested; else at most sqrt(Ra). So r = ra / (X + D / X) with D = max(La - Ra, 0) and
/// X = max(L, sqrt(Ra)), the second only where no guard was needed. A power of two not above any root keeps X off 0.
/// Rounding X (1), D (1), the inner quotient (2), the sum (1) cost a factor 1 + u each; the inner quotient cannot
/// underflow by more than 2^-500 of X, and the outer one's loss of u eta is below u^2 L.
Error TightBounds::general_root(NodeId id, const Node& n) {
  make_run_time(n.a);
  Error e;
  if (!weakened(Weakening::drop_radicand_error)) {
    const NodeId a = graph_[value(id)].a;
    const NodeId bound = output_bound(n.a);
    const NodeId divisor = r_.root_divisor(a, value(id), bound, nonnegative(n.a));
    add_term(e, {r_.quotient(materialise(error(n.a)), divisor), false, 1});
  }
  if (!weakened(Weakening::drop_root_rounding)) add_rounding(e, id, 1);
  e.slack_used = error(n.a).slack_used + 7;
  add_underflow(e, root_underflow(format_));
  return e;
}

}  // namespace tightrope::codegen
