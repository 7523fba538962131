#include "stability/exact_stage.h"

#include <algorithm>
#include <array>

#include "impact/query.h"
#include "methods/bsc_exact.h"

namespace tightrope::ccd::stability {
namespace {

/// What `tight` denies is done, then comes the filter.
bool bsc_exact_reaches_it(Kind kind, const double* points) {
  return collides(kind, points, Method::tight) && !exact::filtered_contact(kind, points);
}

/// In single precision it decides the same question in double.
bool bsc_exact_reaches_it(Kind kind, const float* points) {
  std::array<double, 24> wide{};
  std::copy_n(points, wide.size(), wide.begin());
  return bsc_exact_reaches_it(kind, wide.data());
}

template <class T>
bool reaches_it(Method method, Kind kind, const T* points) {
  if (method == Method::tightrope) return deciding_stage(kind, points, Question::whether) == Stage::exact;
  return method == Method::bsc_exact && bsc_exact_reaches_it(kind, points);
}

}  // namespace

bool has_exact_stage(Method method) { return method == Method::bsc_exact || method == Method::tightrope; }

bool reaches_exact_stage(Method method, Kind kind, std::span<const double, 24> points) {
  return reaches_it(method, kind, points.data());
}

bool reaches_exact_stage(Method method, Kind kind, std::span<const float, 24> points) {
  return reaches_it(method, kind, points.data());
}

}  // namespace tightrope::ccd::stability
