#include "ccd/geometry.h"

namespace tightrope::ccd {
namespace {

/// Takes coordinates that all four points share at one end of the step to 0: a translation of that end.
template <class Real>
void remove_common_coordinates(std::array<Real, numbers_per_query>& points) {
  for (const std::size_t end : {0U, 12U}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Real* x = &points[end + axis];
      if (x[0] == x[3] && x[0] == x[6] && x[0] == x[9]) x[0] = x[3] = x[6] = x[9] = 0;
    }
  }
}

}  // namespace

template <class Real>
NormalizedQuery<Real> normalize(const Real* points) {
  NormalizedQuery<Real> query{{}, NormalizedQuery<Real>::Kind::scaled};
  std::array<Real, numbers_per_query>& x = query.points;
  std::copy_n(points, x.size(), x.begin());
  if (!has_finite_coordinates(points)) {
    query.kind = NormalizedQuery<Real>::Kind::not_finite;
    return query;
  }
  remove_common_coordinates(x);
  Real largest = 0;
  for (const Real coordinate : x) largest = std::max(largest, std::fabs(coordinate));
  // First, so that no difference overflows. The spread is above 2^945 (2^74) then, so that what underflows here is far
  // below eta after the scaling that follows.
  if (largest > power_of_two<Real>(sizeof(Real) == 8 ? 1000 : 100)) {
    for (Real& coordinate : x) coordinate *= power_of_two<Real>(-30);
  }
  const Real size = spread(x.data());
  if (size == 0) {
    query.kind = NormalizedQuery<Real>::Kind::coincident;
    return query;
  }
  const Real factor = scale_to_one(size);
  for (Real& coordinate : x) coordinate *= factor;
  return query;
}

template NormalizedQuery<double> normalize(const double*);
template NormalizedQuery<float> normalize(const float*);

}  // namespace tightrope::ccd
