#pragma once
/// SafeCCD's tests before any root finding: directions that separate the features, and points that are never coplanar.

#include <array>
#include <cstddef>

#include "ccd/methods/safe_naming.h"
#include "ccd/tables.h"

namespace tightrope::generated {
template <class Bound, class Real>
struct vertex_face;
template <class Bound, class Real>
struct edge_edge;
}  // namespace tightrope::generated

namespace tightrope::ccd::safe {

/// Is one feature beyond the other in a coordinate, at t = 0 and at t = 1? Then at every time between, since
/// differences are linear in t. The signs of rounded differences are exact. Without branches: most answers cannot be
/// predicted.
template <std::size_t Split, class Real, class Signs>
TIGHTROPE_HOST_DEVICE bool separated_on_an_axis(const Real* points, Signs& signs) {
  const auto min = [](Real a, Real b) { return a < b ? a : b; };
  const auto max = [](Real a, Real b) { return a > b ? a : b; };
  bool separated = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::array<Real, 2> least, greatest;  // of the second feature's coordinates minus the first's, at both ends
    for (std::size_t end = 0; end < 2; ++end) {
      const Real* x = points + 12 * end + axis;
      if constexpr (Split == 1) {
        least[end] = min(min(x[3], x[6]), x[9]) - x[0];
        greatest[end] = max(max(x[3], x[6]), x[9]) - x[0];
      } else {
        least[end] = min(x[6], x[9]) - max(x[0], x[3]);
        greatest[end] = max(x[6], x[9]) - min(x[0], x[3]);
      }
    }
    separated |= signs(Bounded<Real>{min(least[0], least[1]), 0}) == Sign::positive;
    separated |= signs(Bounded<Real>{max(greatest[0], greatest[1]), 0}) == Sign::negative;
  }
  return separated;
}

template <class Real, class Signs>
TIGHTROPE_HOST_DEVICE bool separated_on_an_axis(Kind kind, const Real* points, Signs& signs) {
  return kind == Kind::vertex_face ? separated_on_an_axis<1>(points, signs) : separated_on_an_axis<2>(points, signs);
}

/// Have the coefficients of F one sign, by the points as they are named in the query?
template <class Bound, class Real, class Signs>
TIGHTROPE_HOST_DEVICE bool never_coplanar(Kind kind, const Real* points, Signs& signs) {
  const auto a = moving_point(points, 0), b = moving_point(points, 1);
  const auto c = moving_point(points, 2), d = moving_point(points, 3);
  const auto one_sign = [&](const Bounded<Real>(&k)[4]) {  // without branches
    int sum = 0;
    for (const Bounded<Real>& x : k) sum += static_cast<int>(signs(x));
    return sum == 4 || sum == -4;
  };
  if (kind == Kind::vertex_face) {
    using Face = generated::vertex_face<Bound, Real>;
    typename Face::State state;
    return one_sign(Face::coplanarity_in_range(a.t0, a.t1, b.t0, b.t1, c.t0, c.t1, d.t0, d.t1, state).k);
  }
  using Edges = generated::edge_edge<Bound, Real>;
  typename Edges::State state;
  return one_sign(
      Edges::coplanarity_in_range(a.t0, a.t1, b.t0, b.t1, c.t0, c.t1, d.t0, d.t1, c.t0, c.t1, a.t0, a.t1, state).k);
}

}  // namespace tightrope::ccd::safe
