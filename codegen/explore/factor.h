#pragma once
/// Common factors taken out of sums: a b + a c = a (b + c), one product and its rounding fewer.

#include "dsl/program.h"

namespace tightrope::codegen::explore {

/// The predicate, simplified, with the factor that most products of a sum share taken out of it, then the next, until
/// no two products share one; of equally frequent factors the one computed first. Products that something else uses,
/// too, stay. Sums are left to right. Exact by the distributive law (sums.h says what counts as one sum).
dsl::Predicate factor_sums(const dsl::Predicate& predicate);

}  // namespace tightrope::codegen::explore
