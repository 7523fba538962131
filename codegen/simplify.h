#pragma once
/// Simplification that keeps the floating-point meaning: every value stays the same number (a zero may change its
/// sign), except that an intermediate overflow may disappear. What it gains: differences and their negatives become one
/// node, multiplications by powers of two become exact scalings, negations move to where they cost nothing.

#include "dsl/program.h"

namespace tightrope::codegen {

/// The predicate with its graph rebuilt from the outputs: simplified, and without unreachable nodes.
dsl::Predicate simplify(const dsl::Predicate& predicate);

}  // namespace tightrope::codegen
