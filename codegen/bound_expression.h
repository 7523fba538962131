#pragma once
/// Builds the expressions that bounds are made of: non-negative, of + * and max, and with their own roundings counted.

#include <unordered_map>

#include "codegen/bounds.h"

namespace tightrope::codegen {

/// Appends nodes to a graph. `roundings` of a node is D of MATH 4.3: a computed value is at least (1 - u)^D times the
/// real value of the expression over the values it is built on.
class BoundExpressions {
 public:
  BoundExpressions(dsl::Graph& graph, const FloatFormat& format) : graph_(graph), format_(format) {}

  /// The value whose magnitude is |id|: negations and absolute values taken off, so that |x| of both is one node.
  dsl::NodeId base(dsl::NodeId id) const;
  dsl::NodeId magnitude(dsl::NodeId id);           ///< |id|
  dsl::NodeId constant(double value);              ///< rounded up to the precision
  dsl::NodeId least();                             ///< eta
  dsl::NodeId plus(dsl::NodeId x, dsl::NodeId y);  ///< no_node stands for 0
  dsl::NodeId times(dsl::NodeId x, dsl::NodeId y);
  dsl::NodeId times_constant(dsl::NodeId x, double c);  ///< c > 0; exact if it is a power of two
  dsl::NodeId maximum(dsl::NodeId x, dsl::NodeId y);    ///< NaN if either is
  dsl::NodeId larger(dsl::NodeId x, dsl::NodeId y);     ///< maximum that may pass over a NaN in y (Op::max_magnitude)
  dsl::NodeId selected(dsl::NodeId condition, dsl::NodeId x, dsl::NodeId y);  ///< Op::select of two bounds
  dsl::NodeId quotient(dsl::NodeId x, dsl::NodeId y);
  /// X + D / X of TightBounds::general_root: a radicand's error bound `bound` over this is the root's. `unguarded`: the
  /// radicand is non-negative in itself, and may be less than its bound.
  dsl::NodeId root_divisor(dsl::NodeId radicand, dsl::NodeId root, dsl::NodeId bound, bool unguarded);
  dsl::NodeId power(dsl::NodeId x, int exponent);  ///< exponent >= 1
  dsl::NodeId zero_if_finite(dsl::NodeId id) {
    return graph_.sub(id, id);
  }  ///< x - x: 0, or NaN for an infinity or a NaN
  double roundings(dsl::NodeId id) const;
  void settle(dsl::NodeId id) { roundings_[id] = 0; }  ///< what is built on it starts to count anew

 private:
  dsl::NodeId noted(dsl::NodeId id, double roundings);

  dsl::Graph& graph_;
  const FloatFormat& format_;
  std::unordered_map<dsl::NodeId, double> roundings_;
};

/// In units of eta: what the root of a number may lose to underflow, and u times the root; 0 where the least positive
/// number has a normal root, as in every format but the smallest.
double root_underflow(const FloatFormat& format);

/// For every node an output that it contributes to: whose place a diagnostic about the node gets.
std::vector<const dsl::Output*> outputs_of_nodes(const dsl::Predicate& predicate);

/// Whether every input has a declared range.
bool all_inputs_have_ranges(const dsl::Predicate& predicate);

/// "`/` has no error bound in mode `tight` yet ..."
void report_unbounded(const dsl::Node& node, const dsl::Output& output, BoundMode mode, dsl::Diagnostics& diagnostics);

}  // namespace tightrope::codegen
