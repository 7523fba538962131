#pragma once
/// Names of a query's points under which the generated polynomials have the smallest rounding errors (MATH 1.3).

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>

#include "ccd/geometry.h"

namespace tightrope::ccd::safe {

/// Positions in the order of `Kind` of two points of different features.
struct PointPair {
  std::size_t first;
  std::size_t second;
};

TIGHTROPE_HOST_DEVICE inline std::span<const PointPair> pairs_across(Kind kind) {
  static constexpr std::array<PointPair, 3> vertex_face{{{0, 1}, {0, 2}, {0, 3}}};
  static constexpr std::array<PointPair, 4> edge_edge{{{0, 2}, {0, 3}, {1, 2}, {1, 3}}};
  if (kind == Kind::vertex_face) return vertex_face;
  return edge_edge;
}

/// Vertex-face: the vertex, then the triangle's vertices from the nearest to the farthest. Edge-edge: a, b and c, d
/// such that a and c are the nearest of the four pairs across; near_b: the one of c and d nearer to b, near_d: the one
/// of a and b nearer to d.
template <class Real>
struct Naming {
  using Point = MovingPoint<Real>;

  TIGHTROPE_HOST_DEVICE Naming(Kind kind, const Real* points) {
    for (std::size_t i = 0; i < 4; ++i) {
      index[i] = i;
      x[i] = moving_point(points, static_cast<int>(i));
    }
    kind == Kind::vertex_face ? name_face() : name_edges();
  }

  std::array<Point, 4> x;
  std::array<std::size_t, 4> index;  ///< positions of x in the query
  Point near_b{};
  Point near_d{};

 private:
  TIGHTROPE_HOST_DEVICE void swap(std::size_t i, std::size_t j) {
    std::swap(x[i], x[j]);
    std::swap(index[i], index[j]);
  }

  TIGHTROPE_HOST_DEVICE void name_face() {
    std::array<Real, 4> distance{0, distance_estimate(x[0], x[1]), distance_estimate(x[0], x[2]),
                                 distance_estimate(x[0], x[3])};
    for (const auto& [i, j] : {std::pair{1U, 2U}, {2U, 3U}, {1U, 2U}}) {
      if (distance[j] < distance[i]) {
        std::swap(distance[i], distance[j]);
        swap(i, j);
      }
    }
  }

  TIGHTROPE_HOST_DEVICE void name_edges() {
    Real ac = distance_estimate(x[0], x[2]), ad = distance_estimate(x[0], x[3]);
    Real bc = distance_estimate(x[1], x[2]), bd = distance_estimate(x[1], x[3]);
    if (std::min(bc, bd) < std::min(ac, ad)) {
      swap(0, 1);
      std::swap(ac, bc);
      std::swap(ad, bd);
    }
    if (ad < ac) {
      swap(2, 3);
      std::swap(ac, ad);
      std::swap(bc, bd);
    }
    near_b = bd < bc ? x[3] : x[2];
    near_d = bd < ad ? x[1] : x[0];
  }
};

}  // namespace tightrope::ccd::safe
