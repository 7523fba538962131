#pragma once
/// `normalize a, b`: the inputs of a group are multiplied by one power of two s, taken at run time from the largest of
/// their magnitudes, so that all are at most 1 and nothing overflows, nor underflows for being small alike.
///
/// Lemma. Outputs are homogeneous in the group (checked by dsl), so f(s x) = s^d f(x) has the sign of f(x). With the
/// exact inputs s x, |s x| <= 1, the bounds are those of a declared range 1, but for one thing: fl(s x) differs from s
/// x by at most eta / 2, where it is subnormal. Each mode charges every normalized input with an error of eta (safe: 2,
/// for a difference of two) as it does underflow elsewhere, by a constant at compile time.
///
/// So bounds are derived for the predicate with ranges, and only then is s x put in the place of every input x.

#include "codegen/bounds.h"

namespace tightrope::codegen {

bool has_normalized_inputs(const dsl::Predicate& predicate);

/// The predicate of the normalized inputs: these have the range 1.
dsl::Predicate with_normalized_ranges(const dsl::Predicate& predicate);

/// Puts the products with the powers of two in the place of normalized inputs.
void normalize_inputs(const dsl::Predicate& predicate, BoundedPredicate& bounded);

}  // namespace tightrope::codegen
