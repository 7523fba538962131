#pragma once
/// The least model that a scene needs: measured on a sample of it, and chosen.

#include <optional>
#include <vector>

#include "fit/figures.h"
#include "fit/look.h"
#include "tightrope/ccd.h"

namespace tightrope::ccd {

struct FitRequest {
  double max_false_positives = 0;  ///< of the queries without contact; 0: none, by proof
  bool times = false;              ///< the time of impact is needed, not only whether
};

struct LookMeasurement {
  Look look{};
  double nanoseconds = 0;  ///< a query, the full model behind the look included
  double open = 0;         ///< share of the queries that the look leaves open
};

/// A method behind the chosen look.
struct MethodMeasurement {
  Method method{};
  double nanoseconds = 0;      ///< a query that the look leaves open
  double false_positives = 0;  ///< of all queries without contact
};

struct Choice {
  Kind kind{};
  Look look{};
  std::optional<int> exponent{};             ///< of the range, where the look has one
  Method method = Method::tightrope;         ///< of what the look leaves open
  double full_nanoseconds = 0;               ///< a query by the full model
  double nanoseconds = 0;                    ///< a query by the fit, as expected
  double false_positives = 0;                ///< of the queries without contact
  std::vector<LookMeasurement> looks{};      ///< all that were tried
  std::vector<MethodMeasurement> methods{};  ///< all that were tried
};

/// `sample` must not be empty.
Choice choose(const SceneSample& sample, const FitRequest& request);

}  // namespace tightrope::ccd
