#pragma once
/// The polynomials of the contact criterion (MATH 1.4) as exact numbers, with doubles beside them for filters.

#include <array>
#include <cstddef>

#include "tightrope/exact.h"
#include "tightrope/plain.h"
#include "tightrope/sign.h"

namespace tightrope::ccd::exact {

/// Bernstein coefficients, up to a positive factor.
using Line = std::array<Dyadic, 2>;
template <std::size_t N>
struct Polynomial {
  std::array<Dyadic, N> exact;
  std::array<Bounded<double>, N> near;  ///< `exact` times one power of two, within the bounds
};
using Quadratic = Polynomial<3>;
using Cubic = Polynomial<4>;

template <std::size_t N>
bool is_zero(const std::array<Dyadic, N>& coefficients) {
  for (const Dyadic& x : coefficients) {
    if (x.sign() != 0) return false;
  }
  return true;
}
template <std::size_t N>
bool is_zero(const Polynomial<N>& p) {
  return is_zero(p.exact);
}

Cubic elevated(const Quadratic& j);
Cubic elevated(const Line& l);

/// Functions of one axis: the first `count` of them.
template <class Function>
struct Functions {
  std::size_t count = 0;
  std::array<Function, 4> of;
};

/// The moving features of a pair. Axes: 0, 1, 2.
class Features {
 public:
  /// `points`: those of the pair (impact.h); finite.
  Features(Pair pair, const double* points);
  Pair pair() const { return pair_; }

  /// Y, zero where four points are coplanar: of vertex-face and edge-edge pairs.
  Cubic coplanarity() const;
  /// The projected quadratics z of theorem 1.4: at a contact no two of one axis have opposite signs. Of a vertex and an
  /// edge: the moment of the edge about the vertex, zero at a contact. Of two vertices none.
  Functions<Quadratic> moments(std::size_t axis) const;
  /// The paths of points of the second feature relative to points of the first, every such pair: where all are positive
  /// or all negative, this axis separates the features.
  Functions<Line> offsets(std::size_t axis) const;

 private:
  double coordinate(std::size_t point, std::size_t axis) const { return points_[3 * point + axis]; }

  Pair pair_;
  std::size_t count_;  ///< points at one end of the step
  std::array<double, 24> points_{};
};

}  // namespace tightrope::ccd::exact
