#pragma once
/// Sums in halves. A term of a sum of n then suffers about log2 n roundings in place of n - 1, and the sum's operations
/// wait for each other log2 n times: a smaller bound, and more work at once for the processor.

#include "dsl/program.h"

namespace tightrope::codegen::explore {

/// The predicate, simplified, with every sum of n terms computed as the sum of its first n/2 (rounded up) and its last
/// n/2 (rounded down) terms, and so on. Exact: addition is associative and commutative in the reals (sums.h says what
/// counts as one sum).
dsl::Predicate balance_sums(const dsl::Predicate& predicate);

}  // namespace tightrope::codegen::explore
