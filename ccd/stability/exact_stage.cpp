#include "stability/exact_stage.h"

#include <algorithm>
#include <array>

#include "methods/bsc_exact.h"
#include "query.h"

namespace tightrope::ccd::stability {

bool has_exact_stage(Method method) { return method == Method::bsc_exact; }

/// bsc-exact: what `tight` denies is done, then comes the filter.
bool reaches_exact_stage(Method method, Kind kind, std::span<const double, 24> points) {
  if (method != Method::bsc_exact || !collides(kind, points.data(), Method::tight)) return false;
  return !exact::filtered_contact(kind, points.data());
}

/// In single precision it decides the same question in double.
bool reaches_exact_stage(Method method, Kind kind, std::span<const float, 24> points) {
  std::array<double, 24> wide{};
  std::copy(points.begin(), points.end(), wide.begin());
  return reaches_exact_stage(method, kind, wide);
}

}  // namespace tightrope::ccd::stability
