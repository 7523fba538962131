#pragma once
/// Exact squared distances of vertices, segments and triangles, in rational arithmetic.

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <vector>

#include "ccd/impact/scaled_points.h"

namespace tightrope::ccd::test {

using RationalVector = std::array<mpq_class, 3>;

inline RationalVector operator-(const RationalVector& a, const RationalVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline mpq_class dot(const RationalVector& a, const RationalVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline RationalVector cross(const RationalVector& a, const RationalVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline RationalVector along(const RationalVector& a, const RationalVector& e, const mpq_class& s) {
  return {a[0] + s * e[0], a[1] + s * e[1], a[2] + s * e[2]};
}

/// A query's points at a time, exactly.
inline std::vector<RationalVector> positions(Pair pair, const double* points, const mpq_class& t) {
  const std::size_t count = number_of_points(pair);
  std::vector<RationalVector> result(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const mpq_class from = points[3 * i + axis], to = points[3 * (count + i) + axis];
      result[i][axis] = from + t * (to - from);
    }
  }
  return result;
}

inline mpq_class to_segment(const RationalVector& p, const RationalVector& a, const RationalVector& b) {
  const RationalVector e = b - a, x = p - a;
  const mpq_class square = dot(e, e);
  const mpq_class s =
      square == 0 ? mpq_class(0) : std::clamp(mpq_class(dot(x, e) / square), mpq_class(0), mpq_class(1));
  const RationalVector d = p - along(a, e, s);
  return dot(d, d);
}

inline mpq_class to_triangle(const RationalVector& p, const RationalVector& a, const RationalVector& b,
                             const RationalVector& c) {
  const RationalVector n = cross(b - a, c - a);
  const mpq_class square = dot(n, n), height = dot(n, p - a);
  if (square != 0 && dot(n, cross(b - a, p - a)) >= 0 && dot(n, cross(c - b, p - b)) >= 0 &&
      dot(n, cross(a - c, p - c)) >= 0) {
    return height * height / square;
  }
  return std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
}

inline mpq_class between_segments(const RationalVector& a, const RationalVector& b, const RationalVector& c,
                                  const RationalVector& d) {
  const RationalVector u = b - a, v = d - c, n = cross(u, v), side = c - a;
  const mpq_class square = dot(n, n);
  if (square != 0) {
    const mpq_class s = dot(n, cross(side, v)) / square, r = dot(n, cross(side, u)) / square;
    if (s >= 0 && s <= 1 && r >= 0 && r <= 1) {
      const mpq_class height = dot(n, side);
      return height * height / square;
    }
  }
  return std::min({to_segment(a, c, d), to_segment(b, c, d), to_segment(c, a, b), to_segment(d, a, b)});
}

/// The square of the distance of the pair's features at t.
inline mpq_class square_distance(Pair pair, const double* points, const mpq_class& t) {
  const auto x = positions(pair, points, t);
  switch (pair) {
    case Pair::vertex_vertex:
      return dot(x[1] - x[0], x[1] - x[0]);
    case Pair::vertex_edge:
      return to_segment(x[0], x[1], x[2]);
    case Pair::vertex_face:
      return to_triangle(x[0], x[1], x[2], x[3]);
    case Pair::edge_edge:
      return between_segments(x[0], x[1], x[2], x[3]);
  }
  return 0;
}

}  // namespace tightrope::ccd::test
