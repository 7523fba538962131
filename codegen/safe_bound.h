#pragma once
/// SafeBound: a pair (B, k) for every value, known at compile time but for run-time maxima of groups of inputs [Wang
/// 2014].
///
/// For a value f computed as f^:  |f| <= B  and  |f^ - f| <= B (F - 1) + A  with  F = (1 + u)^k  (MATH 4.5).
///
///     exact input   k = 0, B = the maximum of its group;   constant  k = 0, B = |c|
///     x +- y of two inputs   k = 1, B = the maximum of the computed differences of its group (times 1 + 2u)
///     sum           B = Ba + Bb, k = max(ka, kb) + 1
///     product       B = Ba Bb,   k = ka + kb + 1
///     quotient      B = Ba / |c|, k = ka + 1 (c an exact constant)
///     fma           B = Ba Bb + Bc, k = max(ka + kb, kc) + 1
///     max, min      B = max(Ba, Bb), k = max(ka, kb);   negation, |.|, 2^k: exact
///     selection     of differences or inputs (`either`): k = 1, B = the maximum of what was selected, a group of its
///                   own; of other values: as max
///
/// Proof by induction; product: |f^ g^ - f g| <= |f^| |g^ - g| + |g| |f^ - f| <= Bf Bg (Ff (Fg - 1) + Ff - 1), and a
/// rounding turns F - 1 into F (1 + u) - 1.
///
/// *Bounded inputs* come as (value, bound). Of their group, B = max(|value| + bound) and rho = max(bound) / B: each
/// such input brings a factor 1 + rho into F as a rounding brings 1 + u, so a value of degree d in the group has F = (1
/// + u)^k (1 + rho)^d. F - 1 <= F ln F <= F (k u + d rho) for all rho >= 0, which is what is evaluated.
///
/// *Quotients and roots* by run-time values have no (B, k) from maxima: a quotient may be as large as its divisor is
/// small. Each is a leaf, as a bounded input of its own is: its value, and the run-time bound that follows from the
/// bounds of its operands (quotient_bound.h).
///
/// *Underflow* (A). With m = max(1, all maxima), B <= S m^d and A <= C eta m^p: a product adds (Sf Cg + Sg Cf + 1) to
/// C. Where all inputs have a declared range, A is a compile-time constant, as in lemma C of tight_bound.h.
///
/// The evaluation of B has its own underflow, which goes into A as well.
///
/// *Raised maxima* replace A where all inputs are exact and none has a range: B~ is B with every maximum g raised to
/// max(g, t), t = 2^-(E / degree of B), so that no product of maxima is below 2^-E and nothing underflows in B~.
/// Lemma: A <= N theta B~ F, where theta = eta / (c 2^-E), c the least sum of coefficients of the B of a product,
/// quotient or scaling downwards on the way (so eta <= theta B~ for each of them), and N counts:
///
///     product  N = Na + Nb + 2;   quotient, scaling  N = Na + 1;   sum, max, min  N = max(Na, Nb);   leaf  N = 0
///
/// Proof by induction: a sum's rounding turns F into F (1 + u); a product's A is at most F B~ (Na theta + Nb theta + Na
/// Nb theta^2) + eta, and Na Nb theta^2 <= theta as long as N^2 theta <= 1. So |f^ - f| <= B~ (F (1 + N theta) - 1),
/// and N theta is of no account: one comparison a maximum instead of a power of the largest, a product and a sum.
///
/// *Groups*: computed differences per coordinate axis; every vector that `either` selects per axis; exact vectors used
/// directly per axis; every scalar parameter and every bounded parameter on its own. The roundings of the maxima (1 +
/// 2u for a difference), of B and of the product are counted and paid by a factor 1 + 2^-20 (2^-10 in single
/// precision); too many of them are a diagnostic.

#include "codegen/bounds.h"

namespace tightrope::codegen {

/// As add_tight_bounds.
void add_safe_bounds(const dsl::Predicate& predicate, const FloatFormat& format, dsl::Diagnostics& diagnostics,
                     Weakening weakening, BoundedPredicate& result);

}  // namespace tightrope::codegen
