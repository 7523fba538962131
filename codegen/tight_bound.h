#pragma once
/// TightBound: running error bounds of every value, as further nodes of the same graph [Wang et al. 2015, Theorem 1].
///
/// The published rules (with u in place of the papers' epsilon, MATH 4.1) are, for computed L with bound R:
///
///     sum        R = Ra + Rb + u |L|
///     product    R = |La| Rb + Ra (|Lb| + Rb) + u |L|         (+ underflow)
///     fma        R = |La| Rb + Ra (|Lb| + Rb) + Rc + u |L|    (+ underflow)
///     quotient   R = Ra / |c| + u |L|                         (+ underflow), c an exact constant
///     quotient, root by run-time values: tight_quotients.cpp
///     max, min   R = max(Ra, Rb);   negation, |.|, 2^k: exact
///
/// Four things are done here at compile time instead of at run time:
///
/// * Lemma A (one factor for all). Every term of R carries exactly one leading u, so R = u+ r, and r is what is
/// computed:
///   sum r = ra + rb + |L|, product r = |La| rb + ra (|Lb| + u+ rb) + |L|. u+ = u (1 + slack) is applied once, at an
///   output.
/// * Lemma B (relative errors are numbers). If |La - a| <= pa u+ |La| and |Lb - b| <= pb u+ |Lb| with constants pa, pb
/// (a
///   difference of inputs has 1, an exact input 0), then |La| |Lb| <= (|L| + eta/2) / (1 - u) gives
///   |L - ab| <= (pa + pb + 1) u+ |L| (1 + (min(pa, pb) + 3) u+) + eta: no run-time term but |L| itself. If only La is
///   so, r = |La| rb + (pa + 1) |L|, up to a factor 1 + (pa + 3) u+.
/// * Lemma C (underflow). With a declared range of every input, |L| + R <= M is known for every node at compile time,
/// and
///   the underflow of a product (at most eta), amplified by later factors (at most M), adds up to one constant, the
///   floor, of which every output gets its share. Without ranges each product, quotient and scaling downwards carries 4
///   eta.
///
/// * Lemma D (sums of non-negative numbers). Where La, Lb >= 0 whatever the inputs, relative errors pa, pb make the
///   relative error max(pa, pb) + 1 of their sum: a sum of squares has no run-time term but itself.
///
/// Slack (MATH 4.3). r is built from non-negative numbers by + * and max, so a computed r is at least (1 - u)^D times
/// the real one, D = dependent roundings; lemmas A and B use up m factors (1 + u). Both are paid by u+ = u (1 + slack):
/// every monomial of R has at least one u+, and (1 + slack) (1 - u)^(D + m) >= 1 if slack >= 2 (D + m) u. D and m are
/// counted here, and the slack is raised where the default does not do.

#include "codegen/bounds.h"

namespace tightrope::codegen {

/// Appends the bounds of all outputs of `predicate` to `result.graph`, which starts as a copy of the predicate's graph,
/// and enters the outputs into `result.stages`.
void add_tight_bounds(const dsl::Predicate& predicate, const FloatFormat& format, dsl::Diagnostics& diagnostics,
                      Weakening weakening, BoundedPredicate& result);

}  // namespace tightrope::codegen
