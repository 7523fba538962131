#pragma once
/// Graphs in one spelling, so that two ways of writing the same arithmetic are the same node.

#include <vector>

#include "codegen/bounds.h"
#include "dsl/graph.h"

namespace tightrope::codegen {

/// The analysed graph of a predicate, to which nodes read from elsewhere can be compared: equal numbers are equal
/// arithmetic, operation by operation (up to the sign of a NaN and of a zero that min and max choose).
///
/// Besides what dsl::Graph identifies (the order of commutative operands), two spellings are the same here:
///   * a product with a constant 2^k is a scaling by 2^k: the same multiplication;
///   * a scaling of a scaling is one scaling where that never changes a bit (below);
///   * the negative of a constant other than 0 is a constant.
///
/// Lemma. fl(fl(x 2^j) 2^k) = fl(x 2^(j+k)) for all x in a format with p significand bits, gradual underflow and
/// rounding to nearest, ties to even, if j, k > 0 or if j < 0 and k <= -p. Proof. For j, k > 0 nothing is inexact but
/// overflow, which the second step keeps. For j < 0 the first step is exact, and the claim trivial, unless |x 2^j| lies
/// below the smallest normal number N. Then its rounding is at most N, and N 2^k <= N 2^-p = eta / 2, so the second
/// step gives 0 (a tie goes to the even 0); and |x 2^(j+k)| < eta / 2 gives 0, too, of the same sign. QED.
class CanonicalGraph {
 public:
  /// `significand_bits`: p of the format.
  CanonicalGraph(const dsl::Graph& analysed, int significand_bits);

  /// The canonical node of a node of the analysed graph.
  dsl::NodeId of(dsl::NodeId analysed) const { return canonical_[static_cast<std::size_t>(analysed)]; }
  /// Whether a canonical node stands for one of the analysed graph.
  bool analysed(dsl::NodeId node) const {
    return static_cast<std::size_t>(node) < analysed_.size() && analysed_[static_cast<std::size_t>(node)];
  }

  /// The canonical node of an operation on canonical nodes.
  dsl::NodeId intern(dsl::Node node);
  dsl::NodeId constant(double value) { return graph_.constant(value); }

  /// "sub(mul(input 3, input 7), ...)", for messages.
  std::string describe(dsl::NodeId node, int depth = 3) const;

 private:
  dsl::NodeId scaled(dsl::NodeId operand, std::int32_t exponent);

  int significand_bits_;
  dsl::Graph graph_;
  std::vector<dsl::NodeId> canonical_;
  std::vector<bool> analysed_;
};

}  // namespace tightrope::codegen
