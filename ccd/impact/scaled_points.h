#pragma once
/// Exact normalisation of a query of two to four points, as ccd/geometry.h does it for four.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "ccd/rescale.h"
#include "tightrope/plain.h"

namespace tightrope::ccd {

/// Points at one end of the step.
constexpr std::size_t number_of_points(Pair pair) {
  switch (pair) {
    case Pair::vertex_vertex:
      return 2;
    case Pair::vertex_edge:
      return 3;
    case Pair::vertex_face:
    case Pair::edge_edge:
      return 4;
  }
  return 4;
}

/// Points of the first feature; the others are the second's.
constexpr std::size_t points_of_first(Pair pair) { return pair == Pair::edge_edge ? 2 : 1; }

/// `Dimension` coordinates a point, `Count` points at t = 0, then at t = 1.
template <std::size_t Count, std::size_t Dimension = 3>
struct ScaledPoints {
  std::array<double, 2 * Count * Dimension> x;
  double factor = 1;  ///< the power of two that the coordinates were multiplied with
  enum class Status {
    scaled,
    not_finite,
    coincident
  } status = Status::scaled;  ///< coincident: all points one all the time
};

/// The points scaled by a power of two such that no two differ by 1 or more in a coordinate at one end of the step, and
/// some by 1/2 or more. Exact but for coordinates that fall below the normal numbers: those change by less than
/// 2^-1074. A coordinate that all points share at one end becomes 0, an exact translation of that end; any other is at
/// most 2^54 (neighbouring doubles differ by 2^-53 of their size at least).
template <std::size_t Count, std::size_t Dimension = 3>
ScaledPoints<Count, Dimension> scaled_to_one(const double* points) {
  ScaledPoints<Count, Dimension> result;
  using Status = typename ScaledPoints<Count, Dimension>::Status;
  auto& x = result.x;
  std::copy_n(points, x.size(), x.begin());
  if (!std::all_of(x.begin(), x.end(), [](double coordinate) { return std::isfinite(coordinate); })) {
    result.status = Status::not_finite;
    return result;
  }
  const auto coordinates = [&x](std::size_t axis_and_end, std::size_t point) -> double& {
    return x[(axis_and_end / Dimension * Count + point) * Dimension + axis_and_end % Dimension];
  };
  double largest = 0;
  for (std::size_t i = 0; i < 2 * Dimension; ++i) {
    bool shared = true;
    for (std::size_t j = 1; j < Count; ++j) shared &= coordinates(i, j) == coordinates(i, 0);
    for (std::size_t j = 0; j < Count; ++j) {
      if (shared) coordinates(i, j) = 0;
      largest = std::max(largest, std::fabs(coordinates(i, j)));
    }
  }
  // First, so that no difference overflows. Two points differ by 2^947 or more in the largest coordinate then.
  const double before = largest > 0x1p1000 ? 0x1p-30 : 1;
  double spread = 0;
  for (std::size_t i = 0; i < 2 * Dimension; ++i) {
    double low = coordinates(i, 0), high = low;
    for (std::size_t j = 1; j < Count; ++j) {
      low = std::min(low, coordinates(i, j));
      high = std::max(high, coordinates(i, j));
    }
    spread = std::max(spread, high * before - low * before);
  }
  if (spread == 0) {
    result.status = Status::coincident;
    return result;
  }
  const double after = scale_to_one(spread);
  for (double& coordinate : x) coordinate = coordinate * before * after;
  result.factor = before * after;
  return result;
}

/// No coordinate exceeds 2^53 in magnitude (false for NaN), and some difference of two points reaches 2^-100: then the
/// predicates apply to the points as they are.
template <std::size_t Count, std::size_t Dimension = 3>
bool is_moderate(const double* points) {
  bool moderate = true, apart = false;
  for (std::size_t i = 0; i < 2 * Count * Dimension; ++i) moderate &= magnitude(points[i]) <= 0x1p53;
  for (std::size_t i = 0; i < 2 * Dimension; ++i) {
    const double* const first = points + (i / Dimension) * Count * Dimension + i % Dimension;
    for (std::size_t j = 1; j < Count; ++j) apart |= magnitude(first[j * Dimension] - first[0]) >= 0x1p-100;
  }
  return moderate && apart;
}

}  // namespace tightrope::ccd
