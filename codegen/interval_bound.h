#pragma once
/// Mode `interval`: every value as [lo, hi], for comparison with the running error bounds of the other modes.
///
/// Interval arithmetic with outward rounding [Moore 1966; Rump, Zimmermann, Boldo, Melquiond 2009], in
/// round-to-nearest arithmetic:
///
/// Lemma I. Let c >= u (1 + 4u) be a number of the format, u <= 1/8, x finite and e = fl(fl(c |x|) + eta). Then
/// fl(x - e) <= r <= fl(x + e) for all reals r that round to x.
/// Proof (lower half). If |x| < 2^min_exponent or x = 0, r >= x - eta/2, e >= eta because rounding is monotone, and
/// x - eta is a number, so fl(x - e) <= x - eta. Else let g be the distance to the next number below x; r >= x - g/2,
/// g/2 <= u 2^E <= u |x|, E the exponent of x. If e > g/2, then x - e is nearer to the next number below x than to x
/// (or still lower), so fl(x - e) is at most that number, which is below r. And e > u |x|: if c |x| is not subnormal,
/// e >= c |x| (1 - u)^2 >= u |x| (1 + 4u) (1 - 2u + u^2) > u |x|; else fl(c |x|) >= c |x| - eta/2, and the sum with eta
/// is exact, above u |x|.
///
///     sum        [lo_a + lo_b, hi_a + hi_b], difference likewise
///     product    least and greatest of the products of the ends; two where an operand is exact, one where both are
///     quotient   of the ends; NaN unless the divisor's interval is on one side of 0
///     sqrt       of the ends; NaN unless lo >= 0
///     fma        least and greatest of the ends' fused products with lo_c, and with hi_c
///     max, min, negation, |.|, 2^k upwards: of the ends, exact
///
/// each rounded outwards. A bounded input is [value - bound, value + bound]. An end that is NaN makes one end of
/// everything that follows NaN, since every operation uses both ends.
///
/// An output has the value m = lo/2 + hi/2 (any number would do) and the bound max(hi - m, m - lo) rounded upwards; so
/// values differ from those of the other modes in their last bits. What is exact keeps value and bound 0.

#include "codegen/bounds.h"

namespace tightrope::codegen {

/// As add_tight_bounds.
void add_interval_bounds(const dsl::Predicate& predicate, const FloatFormat& format, dsl::Diagnostics& diagnostics,
                         Weakening weakening, BoundedPredicate& result);

}  // namespace tightrope::codegen
