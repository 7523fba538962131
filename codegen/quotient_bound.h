#pragma once
/// Quotients and roots with run-time bounds R (not r of tight_bound.h) from operands with such bounds: what SafeBound
/// makes leaves of, since no pair (B, k) of a quotient follows from maxima.

#include "codegen/bound_expression.h"
#include "codegen/precision.h"

namespace tightrope::codegen {

/// A computed value, and a node whose computed value bounds its error, that node's own roundings included.
struct BoundedValue {
  dsl::NodeId value = dsl::no_node;
  dsl::NodeId bound = dsl::no_node;  ///< no_node: exact
};

struct QuotientContext {
  dsl::Graph& graph;
  BoundExpressions& r;
  const FloatFormat& format;
  double unit;  ///< u
  Weakening weakening;
};

/// a / b, NaN where b may be 0. `finite`: 0, or NaN where b is not finite; it stands in for the bound of an exact b.
BoundedValue bounded_quotient(const QuotientContext& context, const BoundedValue& a, const BoundedValue& b,
                              dsl::NodeId finite);

/// sqrt(a), NaN where a may be negative. `nonnegative`: it cannot be, whatever the inputs.
BoundedValue bounded_root(const QuotientContext& context, const BoundedValue& a, bool nonnegative);

}  // namespace tightrope::codegen
