#pragma once
/// The polynomials of the contact criterion (MATH 1.4) as exact numbers, with doubles beside them for filters.

#include <array>
#include <cstddef>

#include "tightrope/ccd.h"
#include "tightrope/exact.h"
#include "tightrope/impact.h"
#include "tightrope/sign.h"

namespace tightrope::ccd::exact {

/// Bernstein coefficients, up to a positive factor.
template <std::size_t N>
struct Polynomial {
  std::array<Dyadic, N> exact;
  std::array<Bounded<double>, N> near;  ///< `exact` times one power of two, within the bounds
};
using Line = Polynomial<2>;
using Quadratic = Polynomial<3>;
using Cubic = Polynomial<4>;

template <std::size_t N>
Polynomial<N> polynomial(std::array<Dyadic, N> exact);
template <std::size_t N>
bool is_zero(const Polynomial<N>& p) {
  for (const Dyadic& x : p.exact) {
    if (x.sign() != 0) return false;
  }
  return true;
}

Cubic elevated(const Quadratic& j);
Cubic elevated(const Line& l);

/// Functions [axis][0 .. count).
template <class Function>
struct PerAxis {
  std::size_t count = 0;
  std::array<std::array<Function, 4>, 3> of;
};

/// Y, zero where the four points of a vertex-face or edge-edge pair are coplanar.
Cubic coplanarity(Kind kind, const double* points);

/// The projected quadratics z of theorem 1.4: at a contact no two of one axis have opposite signs. Of a vertex and an
/// edge: the one moment of the edge about the vertex, zero at a contact.
PerAxis<Quadratic> moments(Pair pair, const double* points);

/// The paths of points of the second feature relative to points of the first, every such pair: where all are positive
/// or all negative in one axis, this axis separates the features.
PerAxis<Line> offsets(Pair pair, const double* points);

}  // namespace tightrope::ccd::exact
