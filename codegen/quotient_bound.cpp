#include "codegen/quotient_bound.h"

namespace tightrope::codegen {

using dsl::no_node;
using dsl::NodeId;
using dsl::Op;

namespace {

/// (1 + slack) times the operands' part, plus u (1 + slack) |L|, plus `etas` eta.
NodeId total(const QuotientContext& c, NodeId operands, NodeId value, bool rounding, double etas) {
  const double inflation = 1 + c.format.slack;
  NodeId bound = operands == no_node ? no_node : c.r.times_constant(operands, inflation);
  if (rounding) bound = c.r.plus(bound, c.r.times_constant(c.r.magnitude(value), c.unit * inflation));
  if (etas > 0 && c.weakening != Weakening::drop_underflow) bound = c.r.plus(bound, c.r.constant(etas * c.format.eta));
  return bound == no_node ? c.r.constant(0) : bound;  // nothing is left only in a weakened rule
}

}  // namespace

/// |La/Lb - a/b| <= (Ra + |La/Lb| Rb) / (|Lb| - Rb) where |Lb| > Rb, which the guard has tested; |La/Lb| is at most
/// (1 + u) |L| + eta/2, and L at most u |L| + eta/2 off it:
///   R = (Ra + (|L| + eta) Rb + 2 eta) / (|Lb| - Rb) (1 + slack) + u (1 + slack) |L| + 4 eta.
/// The eight roundings and the 1 + u are paid by the slack. The product in the numerator loses at most eta/2 to
/// underflow, the quotient and the two products in R as much again, which the two constants hold.
BoundedValue bounded_quotient(const QuotientContext& c, const BoundedValue& a, const BoundedValue& b, NodeId finite) {
  const auto dropped = [&](Weakening w) { return c.weakening == w; };
  const NodeId tested = b.bound == no_node ? finite : b.bound;
  const NodeId divisor =
      dropped(Weakening::drop_guards) ? b.value : c.graph.binary(Op::certain_nonzero, b.value, tested);
  const NodeId value = c.graph.binary(Op::div, a.value, divisor);
  NodeId operands = dropped(Weakening::drop_dividend_error) ? no_node : a.bound;
  if (b.bound != no_node && !dropped(Weakening::drop_divisor_error)) {
    NodeId size = c.r.magnitude(value);
    if (!dropped(Weakening::drop_underflow)) size = c.r.plus(size, c.r.constant(c.format.eta));
    operands = c.r.plus(operands, c.r.times(size, b.bound));
  }
  if (operands != no_node) {
    if (!dropped(Weakening::drop_underflow)) operands = c.r.plus(operands, c.r.constant(2 * c.format.eta));
    NodeId margin = c.r.magnitude(divisor);
    if (b.bound != no_node && !dropped(Weakening::drop_divisor_margin)) margin = c.graph.sub(margin, b.bound);
    operands = c.r.quotient(operands, margin);
  }
  return {value, total(c, operands, value, !dropped(Weakening::drop_division_rounding), 4)};
}

/// |sqrt(La) - sqrt(a)| <= Ra / (X + D / X), see TightBounds::general_root; the root itself is at most u L off, for no
/// root underflows where the least positive number has a normal root.
BoundedValue bounded_root(const QuotientContext& c, const BoundedValue& a, bool nonnegative) {
  const auto dropped = [&](Weakening w) { return c.weakening == w; };
  NodeId radicand = a.value;
  if (!nonnegative && !dropped(Weakening::drop_guards)) {
    radicand = c.graph.binary(Op::certain_nonnegative, a.value, a.bound == no_node ? c.r.constant(0) : a.bound);
  }
  const NodeId value = c.graph.unary(Op::sqrt, radicand);
  NodeId operand = no_node;
  if (a.bound != no_node && !dropped(Weakening::drop_radicand_error)) {
    operand = c.r.quotient(a.bound, c.r.root_divisor(radicand, value, a.bound, nonnegative));
  }
  // One eta for what that quotient may lose, two for a root and u L where they underflow.
  const double etas = (operand == no_node ? 0 : 1) + root_underflow(c.format);
  return {value, total(c, operand, value, !dropped(Weakening::drop_root_rounding), etas)};
}

}  // namespace tightrope::codegen
