#include "ccd/geometry.h"

namespace tightrope::ccd {
namespace {

/// Takes coordinates that all four points share at one end of the step to 0: a translation of that end.
void remove_common_coordinates(std::span<double, numbers_per_query> points) {
  for (const std::size_t end : {0U, 12U}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double* x = &points[end + axis];
      if (x[0] == x[3] && x[0] == x[6] && x[0] == x[9]) x[0] = x[3] = x[6] = x[9] = 0;
    }
  }
}

}  // namespace

NormalizedQuery normalize(const double* points) {
  NormalizedQuery query{{}, NormalizedQuery::Kind::scaled};
  std::array<double, numbers_per_query>& x = query.points;
  std::copy_n(points, x.size(), x.begin());
  if (!std::all_of(x.begin(), x.end(), [](double coordinate) { return std::isfinite(coordinate); })) {
    query.kind = NormalizedQuery::Kind::not_finite;
    return query;
  }
  remove_common_coordinates(x);
  double largest = 0;
  for (const double coordinate : x) largest = std::max(largest, std::fabs(coordinate));
  if (largest > 0x1p1000) {  // the spread is above 2^945 then; first, so that no difference overflows
    for (double& coordinate : x) coordinate *= 0x1p-30;
  }
  const double size = spread(x.data());
  if (size == 0) {
    query.kind = NormalizedQuery::Kind::coincident;
    return query;
  }
  const double factor = scale_to_one(size);
  for (double& coordinate : x) coordinate *= factor;
  return query;
}

}  // namespace tightrope::ccd
