#pragma once
/// The bound of lemma S (static_bound.h): the rounding errors of a polynomial output, each times its derivative.

#include "codegen/bounds.h"
#include "codegen/range_analysis.h"

namespace tightrope::codegen {

class ErrorSum {
 public:
  /// `roundings[id]` bounds the error that arises at node id itself; |slot i| <= limits[i] bounds the exact inputs.
  /// `ranges` analyses `graph`, which may be extended here.
  ErrorSum(dsl::Graph& graph, RangeAnalysis& ranges, std::vector<double> roundings, Weakening weakening);

  /// A bound of |computed - exact| of node id; infinite if that is no polynomial.
  double bound(dsl::NodeId id);

 private:
  bool polynomial(dsl::NodeId id) const;
  std::vector<WeightedNode> weighted_derivatives(dsl::NodeId id);
  void propagate(const dsl::Node& n, dsl::NodeId derivative);
  void add_derivative(dsl::NodeId id, dsl::NodeId contribution);
  dsl::NodeId times(dsl::NodeId x, dsl::NodeId y);
  void extend_perturbations();
  double perturbation(const dsl::Node& n) const;
  double at(dsl::NodeId id) const { return perturbations_[static_cast<std::size_t>(id)]; }
  double size(dsl::NodeId id) const { return magnitude(ranges_.of(id)); }
  bool weakened(Weakening w) const { return weakening_ == w; }

  dsl::Graph& graph_;
  RangeAnalysis& ranges_;
  std::vector<double> roundings_;
  Weakening weakening_;
  std::vector<double> perturbations_;     ///< |v(tau) - v(0)| by node
  std::vector<dsl::NodeId> derivatives_;  ///< of the output under way, by node
};

}  // namespace tightrope::codegen
