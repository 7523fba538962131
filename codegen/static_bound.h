#pragma once
/// Mode `static`: a bound that is a number, from the declared ranges of all inputs alone (MATH 4.8).
///
/// Of every node v with computed value v^ are known: the range of v (range_analysis.h), the range of v^, and e with
/// |v^ - v| <= e. The rules, for v = a op b, where r = a^ op b^ is what is rounded to v^:
///
///     rounding   |v^ - r| <= rho, half an ulp of the largest binade that |r| can reach: for |r| <= 2^k this is
///                2^(k-1-p) with p significand bits (2^k itself is a number), but never less than eta / 2, half the
///                distance of subnormal numbers; a sum in that distance is exact. Underflow needs no other term.
///     sum        |r - v| <= ea + eb
///     product    |r - v| <= min(|a| eb + ea |b^|, |a^| eb + ea |b|), as a b - a^ b^ = a (b - b^) + (a - a^) b^
///     fma        the same plus ec
///     quotient   |r - v| <= min((ea + |a/b| eb) / |b^|, (ea + |a^/b^| eb) / |b|), as
///                a/b - a^/b^ = ((a - a^) - (a/b) (b - b^)) / b^; the range of neither b nor b^ may hold 0
///     sqrt       |r - v| <= min(sqrt(ea), ea / (sqrt(a) + sqrt(a^))); neither range may hold a negative number
///     max, min   max(ea, eb);   negation, |.|, 2^k: exact, but for underflow
///
/// Rounding is monotone, so v^ lies in the rounded range of r, which is the intersection of the rule's interval
/// arithmetic on computed operands and of the range of v widened by |r - v|. A bounded input has |v^| <= range,
/// e = range, |v| <= 2 range.
///
/// A sharper bound of outputs that are polynomials (sums, products, scalings, quotients by constants):
///
/// Lemma S. Let delta_i, |delta_i| <= rho_i, be the rounding errors (and errors of bounded inputs), out(tau) the value
/// of the output if tau delta_i is added where delta_i arises, and A_i(tau) the derivative of out(tau) by what is added
/// there. Then |out^ - out| = |integral over tau of sum delta_i A_i(tau)| <= max over the box of sum rho_i |A_i(0)| +
/// sum rho_i D_i, where D_i bounds |A_i(tau) - A_i(0)| for all tau in [0, 1].
///
/// The A_i are graphs over the same inputs (reverse differentiation); D_i follows from the errors of their operands
/// (|a b - a(tau) b(tau)| <= |a| pb + |b| pa + pa pb) and is of second order. If the A_i are multi-affine functions of
/// few inputs, the maximum is found at a vertex (lemma V); else each |A_i| is bounded on its own. The smaller of both
/// bounds is taken.
///
/// All arithmetic here is rounded outwards (range.h, mul_up, add_up).

#include "codegen/bounds.h"

namespace tightrope::codegen {

/// Which bounds of outputs are taken: the smaller one, or the one that the rules give without lemmas S and V (as other
/// programs can follow it).
enum class StaticLemmas { all, none };

/// As add_tight_bounds. Errors: an input without a range, a divisor or radicand that the ranges do not keep away from
/// 0 or from negative numbers, a value that may overflow.
void add_static_bounds(const dsl::Predicate& predicate, const FloatFormat& format, dsl::Diagnostics& diagnostics,
                       Weakening weakening, BoundedPredicate& result, StaticLemmas lemmas = StaticLemmas::all);

}  // namespace tightrope::codegen
