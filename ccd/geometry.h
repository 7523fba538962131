#pragma once
/// What a query's points look like to the methods: moving points, exact normalisation, and the choice among equal
/// expressions of the one with the smallest vectors (MATH 1.3, 4.4).

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "ccd/rescale.h"
#include "tightrope/method.h"

namespace tightrope::ccd {

inline constexpr int points_per_query = 8;
inline constexpr int numbers_per_query = 3 * points_per_query;

/// A point that moves linearly from t0 to t1 (3 coordinates each) over the step.
template <class Real>
struct MovingPoint {
  const Real* t0;
  const Real* t1;
};

/// Point `index` of a query in the order of `Kind`.
template <class Real>
TIGHTROPE_HOST_DEVICE MovingPoint<Real> moving_point(const Real* points, int index) {
  return {points + 3 * index, points + 3 * (index + points_per_query / 2)};
}

/// A query's coordinates in double precision, which holds those of single precision exactly.
TIGHTROPE_HOST_DEVICE inline std::span<const double, numbers_per_query> in_double_precision(const double* points) {
  return std::span<const double, numbers_per_query>(points, numbers_per_query);
}
TIGHTROPE_HOST_DEVICE inline std::array<double, numbers_per_query> in_double_precision(const float* points) {
  std::array<double, numbers_per_query> result;
  copy_numbers(points, result.size(), result.data());
  return result;
}

/// The pairs of points of different features.
TIGHTROPE_HOST_DEVICE inline std::span<const std::array<int, 2>> pairs_of_features(Kind kind) {
  using Points = std::array<int, 2>;
  static constexpr std::array<Points, 3> vertex_face{{{0, 1}, {0, 2}, {0, 3}}};
  static constexpr std::array<Points, 4> edge_edge{{{0, 2}, {0, 3}, {1, 2}, {1, 3}}};
  return kind == Kind::vertex_face ? std::span<const Points>(vertex_face) : std::span<const Points>(edge_edge);
}

/// Largest difference of two points' coordinates at the ends of the step: an estimate that chooses, never decides.
template <class Real>
TIGHTROPE_HOST_DEVICE Real distance_estimate(MovingPoint<Real> x, MovingPoint<Real> y) {
  Real largest = 0;
  for (int i = 0; i < 3; ++i) {
    largest = max_magnitude(largest, magnitude(x.t0[i] - y.t0[i]));
    largest = max_magnitude(largest, magnitude(x.t1[i] - y.t1[i]));
  }
  return largest;
}

/// No coordinate exceeds 2^53 (2^32) in magnitude (false for NaN): then the predicates apply as they are, provided that
/// the points are not so close together that everything drowns in the floor of underflow.
template <class Real>
TIGHTROPE_HOST_DEVICE bool has_moderate_coordinates(const Real* points) {
  constexpr Real limit = power_of_two<Real>(sizeof(Real) == 8 ? 53 : 32);
  bool moderate = true;
  for (int i = 0; i < numbers_per_query; ++i) moderate &= magnitude(points[i]) <= limit;
  return moderate;
}

template <class Real>
TIGHTROPE_HOST_DEVICE bool has_finite_coordinates(const Real* points) {
  bool finite = true;
  for (int i = 0; i < numbers_per_query; ++i) finite &= magnitude(points[i]) <= std::numeric_limits<Real>::max();
  return finite;
}

/// Largest difference between two of the four points in one coordinate at one end of the step.
template <class Real>
TIGHTROPE_HOST_DEVICE Real spread(const Real* points) {
  Real largest = 0;
  for (int end = 0; end < 2; ++end) {
    for (int axis = 0; axis < 3; ++axis) {
      const Real* x = points + 12 * end + axis;
      const Real low = std::min(std::min(x[0], x[3]), std::min(x[6], x[9]));
      const Real high = std::max(std::max(x[0], x[3]), std::max(x[6], x[9]));
      largest = std::max(largest, high - low);
    }
  }
  return largest;
}

/// Below this spread products of three differences could come near the floor of underflow: normalise first.
template <class Real>
inline constexpr Real least_spread = power_of_two<Real>(sizeof(Real) == 8 ? -100 : -20);

/// A query scaled by a power of two so that its spread lies in [1/2, 1).
template <class Real>
struct NormalizedQuery {
  std::array<Real, numbers_per_query> points;
  enum class Kind { scaled, not_finite, coincident } kind;  ///< coincident: the four points are one all the time
};

/// Takes coordinates that all four points share at one end of the step to 0: a translation of that end.
template <class Real>
TIGHTROPE_HOST_DEVICE void remove_common_coordinates(std::array<Real, numbers_per_query>& points) {
  for (std::size_t end = 0; end < numbers_per_query; end += 12) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Real* x = &points[end + axis];
      if (x[0] == x[3] && x[0] == x[6] && x[0] == x[9]) x[0] = x[3] = x[6] = x[9] = 0;
    }
  }
}

/// Exact but for coordinates that fall below the normal numbers: those change by less than eta (the smallest number,
/// 2^-1074 or 2^-149), and a polynomial in differences of coordinates, none above 1, by less than 2^8 eta (see
/// `widen`). Where all four points share a coordinate at one end of the step it becomes 0, an exact translation; a
/// coordinate that differs somewhere is at most 2^54 (2^25) times the spread. So none exceeds that afterwards.
template <class Real>
TIGHTROPE_RARE NormalizedQuery<Real> normalize(const Real* points) {
  NormalizedQuery<Real> query{{}, NormalizedQuery<Real>::Kind::scaled};
  std::array<Real, numbers_per_query>& x = query.points;
  copy_numbers(points, x.size(), x.data());
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

/// Adds what `normalize` may have lost to the bounds of polynomials in differences of its coordinates: where the bound
/// is above 2^-1000 (2^-120) its relative growth of 2^-20 (2^-10) covers it, where it is below the absolute one.
template <class Real>
TIGHTROPE_HOST_DEVICE void widen(std::span<Bounded<Real>> numbers) {
  for (Bounded<Real>& x : numbers) x.bound = tightrope::product(x.bound, inflation<Real>) + underflow_floor<Real>;
}

}  // namespace tightrope::ccd
