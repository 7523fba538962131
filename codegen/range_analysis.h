#pragma once
/// The exact values that the nodes of a graph can take while its inputs stay in their ranges.

#include <bitset>
#include <optional>
#include <span>
#include <vector>

#include "codegen/range.h"
#include "dsl/graph.h"

namespace tightrope::codegen {

/// A number with a bound of the error of its own evaluation, 0 as long as all operations are exact.
struct NearNumber {
  double value = 0;
  double error = 0;
};

/// Which inputs a node depends on, and which of them it may contain to a power above the first (formally: nothing is
/// cancelled).
class Support {
 public:
  static constexpr int most_inputs = 256;
  using Inputs = std::bitset<most_inputs>;

  static Support of_input(int slot);
  Support joined(const Support& other) const;      ///< of a sum
  Support multiplied(const Support& other) const;  ///< of a product
  bool multi_affine() const { return repeated_.none(); }
  bool meets(const Support& other) const { return (inputs_ & other.inputs_).any(); }
  int size() const { return static_cast<int>(inputs_.count()); }
  const Inputs& inputs() const { return inputs_; }

 private:
  Inputs inputs_;
  Inputs repeated_;
};

/// One weighted node of a sum of magnitudes.
struct WeightedNode {
  dsl::NodeId node = dsl::no_node;
  double weight = 0;
};

/// Interval arithmetic knows of no dependence between operands: it gives b_x c_y - b_y c_x over a box twice its true
/// range if b and c share a corner. But what these graphs hold is *multi-affine* in the inputs, and
///
/// Lemma V. A function that is affine in each input attains its greatest and its least value over a box at a vertex of
/// the box; and so does every sum of weighted magnitudes of such functions its greatest. Proof: along one input with
/// the others fixed the function is convex (an affine one, its magnitude, a non-negative sum of those), so the greatest
/// value is found at an end; take the inputs one after the other. For the least value, negate.
///
/// Where a node is a sum or product of operands that share inputs, depends on few of them and is multi-affine, all
/// vertices are tried. Their arithmetic is exact or comes with a bound of its error (NearNumber).
class RangeAnalysis {
 public:
  /// |input slot i| <= limits[i]. The graph may grow; `extend` takes in what is new. Without `vertices`, interval
  /// arithmetic only.
  RangeAnalysis(const dsl::Graph& graph, std::vector<double> limits, bool vertices = true);
  void extend();

  const Range& of(dsl::NodeId id) const { return ranges_[static_cast<std::size_t>(id)]; }
  /// No less than the greatest value of sum weight |node|; empty if not all of the nodes are multi-affine or they
  /// depend on too many inputs together.
  std::optional<double> largest_sum(std::span<const WeightedNode> terms);

 private:
  Range interval(const dsl::Node& n) const;
  Support support(const dsl::Node& n) const;
  bool operands_meet(const dsl::Node& n) const;
  /// The inputs as vertices see them, and the nodes to compute for `roots`; false if there are too many.
  bool prepare(const Support& support, std::span<const WeightedNode> roots);
  void evaluate_vertex(unsigned vertex);
  std::optional<Range> vertex_range(dsl::NodeId id);
  const NearNumber& at_vertex(dsl::NodeId id) const { return values_[static_cast<std::size_t>(id)]; }
  const Support& support(dsl::NodeId id) const { return supports_[static_cast<std::size_t>(id)]; }

  const dsl::Graph& graph_;
  std::vector<double> limits_;
  std::vector<Range> ranges_;
  std::vector<Support> supports_;
  // Of the vertices under way.
  std::vector<int> vertex_inputs_;  ///< bit of the vertex number by slot, -1: not among the support
  std::vector<dsl::NodeId> cone_;
  std::vector<NearNumber> values_;
  double budget_;
};

}  // namespace tightrope::codegen
