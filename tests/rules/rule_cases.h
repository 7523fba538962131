#pragma once
/// The bound rules that are checked, as predicates of one operation, and small compositions of them.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "codegen/bounds.h"

namespace tightrope::rules {

struct Operand {
  bool bounded = false;         ///< comes with an error
  std::optional<double> range;  ///< declared: |value| and bound do not exceed it
};

struct RuleCase {
  std::string name;
  std::vector<Operand> operands;
  std::function<dsl::NodeId(dsl::Graph&, std::span<const dsl::NodeId>)> build;
  /// Operands where the exact result turns at zero, |a| and a a: there 0 is an extreme point of an interval around it.
  bool turns_at_zero = false;
  /// An infinite operand may leave no trace, as in min(1, infinity) = 1.
  bool forgets_infinities = false;
  /// A NaN, too: the value that is not selected.
  bool forgets_nans = false;
  /// m of lemmas in codegen (B in tight_bound.h, roots): even the ideal rule holds only up to m factors 1 + u.
  int lemma_factors = 0;
};

/// Every case, one-operation rules first. Extremes are attained where the exact operands are at the end points of
/// their intervals: each case is affine in each of its operands, or monotone in each of them where it is defined
/// (quotient, root, minimum, maximum), or affine after squares and magnitudes (turns_at_zero).
const std::vector<RuleCase>& rule_cases();

/// The case as a predicate with one output, ready for add_bounds(); input slot i is operand i.
dsl::Predicate predicate_of(const RuleCase& rule);

}  // namespace tightrope::rules
