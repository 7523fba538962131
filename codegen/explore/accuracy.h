#pragma once
/// How good the bounds of a scheme are.

#include <limits>

#include "codegen/explore/candidate.h"
#include "codegen/explore/samples.h"

namespace tightrope::codegen::explore {

struct Accuracy {
  bool sound = true;  ///< every |value - exact| <= bound and every definite sign right, decided exactly
  /// Median of bound / bound of the reference, over all elements and rows; of a filter with what it leaves open, of the
  /// latter, which decides what can be decided.
  double size = 0;
  double median_ratio = 0;  ///< bound / true error, where there is an error
  double p99_ratio = 0;
  double undecided = 0;  ///< fraction of the signs near zero that are uncertain
  double wrong = 0;      ///< and of those that are wrong: 0 but for schemes without a bound
};

/// Value and bound of every place, as the scheme's code computes them.
struct Computed {
  double value = 0;
  double bound = 0;
};
std::vector<Computed> compute(const Candidate& candidate, const Row& row, std::size_t last_stage);

/// What the reference, whose bounds are 1, computes on every row.
std::vector<std::vector<Computed>> compute_all(const Candidate& reference, const std::vector<Row>& rows,
                                               std::size_t last_stage);

/// `samples` and `reference` are of the candidate's predicate.
Accuracy measure_accuracy(const Candidate& candidate, const std::vector<std::vector<Computed>>& reference,
                          const Samples& samples, std::size_t last_stage);

}  // namespace tightrope::codegen::explore
