#pragma once
/// Fused multiply-adds where the hardware has them: changes the floating-point meaning, one rounding fewer a sum.

#include "dsl/program.h"

namespace tightrope::codegen {

/// The predicate, simplified, with every sum or difference that has a product as an operand, used nowhere else, turned
/// into one fma. Of two products the one made last is fused, so that a sum of n products takes one product and n - 1
/// fused ones. Exact scalings are no products.
dsl::Predicate contract_products(const dsl::Predicate& predicate);

}  // namespace tightrope::codegen
