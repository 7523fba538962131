#pragma once
/// Bounds against true errors, by exact arithmetic on random inputs.

#include <array>
#include <vector>

#include "codegen/compile.h"

namespace tightrope::codegen {

/// How the inputs of a measurement are drawn.
enum class Sampling {
  spread,  ///< every number uniform in [-1, 1], with a declared range uniform in that
  close,   ///< neighbours: points within 2^-10 of a common one (of the range), as the primitives of a mesh are
};
inline constexpr std::array<Sampling, 2> samplings = {Sampling::spread, Sampling::close};
const char* name(Sampling sampling);

/// Of one output, all elements together. Samples whose value or bound is not finite are left out and counted.
struct OutputMeasure {
  int samples = 0;
  int not_finite = 0;
  int without_error = 0;    ///< value exact; they have no ratio
  double definite = 0;      ///< fraction of signs that are definite
  double median_ratio = 0;  ///< bound / true error, over samples with an error
  double p99_ratio = 0;
  double least_ratio = 0;  ///< at least 1, or the bound is broken
  double greatest_ratio = 0;
  double least_margin = 0;  ///< min of bound - |error| over all samples, exact but for one rounding; never below 0
  bool sound = true;        ///< no sample with |error| > bound, decided exactly
  double median_bound = 0;  ///< of all samples that are finite
  double median_error = 0;
  double greatest_error = 0;
  double published_median = 0;    ///< bound / bound of the published TightBound rules on the same operations
  double published_greatest = 0;  ///< the same, where the published bound exceeds 2^-900 (2^-100 in single precision)
};

struct StageMeasure {
  std::vector<OutputMeasure> outputs;
};

/// Measures the bounds of `bounded` (one of `predicate` in this precision), whose exact values are those of
/// `predicate.graph`. All inputs are multiplied by `scale`, a power of two, at most 1. Seeded: the same numbers in
/// every run, whatever the mode.
std::vector<StageMeasure> measure(const dsl::Predicate& predicate, const BoundedPredicate& bounded, Precision precision,
                                  Sampling sampling, int samples, double scale = 1);

}  // namespace tightrope::codegen
