#pragma once
/// B of SafeBound over maxima that are raised to a threshold (safe_bound.h), factored so that few operations are left.

#include "codegen/bound_expression.h"
#include "codegen/input_groups.h"
#include "codegen/magnitude_polynomial.h"

namespace tightrope::codegen {

/// factor * B, each group's maximum g replaced by max(g, threshold). What all monomials have in common is factored out:
/// d_x d_y d_z (d_x^2 + d_y^2 + d_z^2) takes 7 products, not 14. Constants come last, and B is not 0.
dsl::NodeId evaluate_raised(const MagnitudePolynomial& B, double factor, double threshold, InputGroups& groups,
                            BoundExpressions& r);

}  // namespace tightrope::codegen
