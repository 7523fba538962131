#pragma once
/// Contact of four fixed points by linear programming, for tests of the oracle: no cross products, no cases.

#include <gmpxx.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "tightrope/ccd.h"

namespace tightrope::ccd::test {

using Points = std::array<double, 24>;  // a query, as collides() takes it

/// For messages; the library that names kinds is not linked here.
inline const char* text(Kind kind) { return kind == Kind::vertex_face ? "vertex-face" : "edge-edge"; }

namespace detail {

/// Whether the columns chosen by `mask` of `columns` are linearly independent and combine to `target` with weights >=
/// 0.
template <std::size_t Rows, std::size_t Columns>
bool basic_solution(const std::array<std::array<mpq_class, Rows>, Columns>& columns,
                    const std::array<mpq_class, Rows>& target, unsigned mask) {
  std::vector<std::array<mpq_class, Rows>> rest;  // the chosen columns, then the target: eliminated in turn
  for (std::size_t j = 0; j < Columns; ++j) {
    if ((mask >> j & 1U) != 0) rest.push_back(columns[j]);
  }
  const std::size_t chosen = rest.size();
  rest.push_back(target);
  std::array<bool, Rows> used = {};
  std::vector<std::size_t> pivots;
  for (std::size_t j = 0; j < chosen; ++j) {
    std::size_t pivot = 0;
    while (pivot < Rows && (used[pivot] || sgn(rest[j][pivot]) == 0)) ++pivot;
    if (pivot == Rows) return false;  // dependent
    used[pivot] = true;
    pivots.push_back(pivot);
    for (std::size_t row = 0; row < Rows; ++row) {  // Gauss-Jordan: clear column j in every other row
      if (row == pivot || sgn(rest[j][row]) == 0) continue;
      const mpq_class factor = rest[j][row] / rest[j][pivot];
      for (std::size_t k = j; k <= chosen; ++k) rest[k][row] -= factor * rest[k][pivot];
    }
  }
  for (std::size_t row = 0; row < Rows; ++row) {
    if (!used[row] && sgn(rest[chosen][row]) != 0) return false;  // the target is not in the span
  }
  for (std::size_t j = 0; j < chosen; ++j) {
    if (sgn(rest[chosen][pivots[j]]) * sgn(rest[j][pivots[j]]) < 0) return false;
  }
  return true;
}

}  // namespace detail

/// Whether a nonnegative combination exists: if so, a basic one does (fundamental theorem of linear programming).
/// Vertex-face: d = w0 a + w1 b + w2 c, w0 + w1 + w2 = 1. Edge-edge: w0 a + w1 b = w2 c + w3 d, w0 + w1 = w2 + w3 = 1.
inline bool static_contact(Kind kind, const std::array<std::array<mpq_class, 3>, 4>& p) {
  using Column = std::array<mpq_class, 5>;
  std::array<Column, 4> columns;
  Column target;
  const bool face = kind == Kind::vertex_face;
  const std::size_t count = face ? 3 : 4;
  for (std::size_t j = 0; j < count; ++j) {
    const std::size_t point = face ? j + 1 : j;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      columns[j][axis] = p[point][axis];
      if (!face && j >= 2) columns[j][axis] = -columns[j][axis];
    }
    columns[j][face || j < 2 ? 3 : 4] = 1;
  }
  if (face) {
    for (std::size_t axis = 0; axis < 3; ++axis) target[axis] = p[0][axis];
  } else {
    target[4] = 1;
  }
  target[3] = 1;
  for (unsigned mask = 1; mask < 1U << count; ++mask) {
    if (detail::basic_solution(columns, target, mask)) return true;
  }
  return false;
}

/// The four points of a query at time t.
inline std::array<std::array<mpq_class, 3>, 4> at_time(std::span<const double, 24> points, const mpq_class& t) {
  std::array<std::array<mpq_class, 3>, 4> p;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const mpq_class from(points[3 * i + axis]), to(points[3 * (i + 4) + axis]);
      p[i][axis] = from + t * (to - from);
    }
  }
  return p;
}

inline bool touching_at(Kind kind, std::span<const double, 24> points, const mpq_class& t) {
  return static_contact(kind, at_time(points, t));
}

}  // namespace tightrope::ccd::test
