#pragma once
/// Values with bounds of the polynomials that SafeCCD evaluates at run-time parameters.
///
/// Lemma S2 (de Casteljau's scheme under SafeBound). Let c be Bernstein coefficients of degree n, each known up to E
/// and at most M in magnitude as computed, and t in [0, 1] a floating-point number, or several of them, one a level
/// (blossoming). The scheme with c_i (1 - t) + c_{i+1} t in each of its n levels has an error of at most
/// E + gamma(3 n) M plus underflow. Proof: 1 - t carries one rounding, the product one, the sum one, so each path from
/// a coefficient to the result carries at most 3 n factors 1 + d, |d| <= u, and the paths' weights are non-negative
/// with sum 1. (The rule of the compiler, which does not see that t and 1 - t have the sum 1, gives 3 n too, but B = (1
/// + 2 t)^n M.) Products lose less than eta to underflow each and the losses are averaged in turn: less than 2 n eta,
/// which the smallest normal number that `rescale` adds to every bound covers.

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "ccd/host_device.h"
#include "tightrope/sign.h"

namespace tightrope::generated {
template <class Bound, class Real>
struct safe_value;
template <class Bound, class Real>
struct safe_restriction;
}  // namespace tightrope::generated

namespace tightrope::ccd::safe {

/// At least gamma(k) = k u / (1 - k u), with room for the roundings of the bound that it becomes part of: two more.
template <class Real>
constexpr Real gamma(int k) {
  return static_cast<Real>(k + 2) * (std::numeric_limits<Real>::epsilon() / 2) *
         (1 + 64 * std::numeric_limits<Real>::epsilon());
}

/// E + gamma(3 n) M of Lemma S2, rounded up.
template <int Degree, class Real, std::size_t N>
TIGHTROPE_HOST_DEVICE Real casteljau_bound(const std::array<Bounded<Real>, N>& c) {
  static_assert(N == Degree + 1);
  Real largest = 0, error = 0;
  for (const Bounded<Real>& x : c) {
    largest = maximum(largest, magnitude(x.value));
    error = maximum(error, x.bound);
  }
  return (error + product(largest, gamma<Real>(3 * Degree))) * (1 + 4 * std::numeric_limits<Real>::epsilon());
}

/// A cubic's value at t: one bound for all of [0, 1] (S2), or TightBound's for each.
template <class Bound, class Real>
struct CubicValue;

template <class Real>
struct CubicValue<bound::safe, Real> {
  TIGHTROPE_HOST_DEVICE explicit CubicValue(const std::array<Bounded<Real>, 4>& k) : bound(casteljau_bound<3>(k)) {}
  TIGHTROPE_HOST_DEVICE Bounded<Real> operator()(const std::array<Bounded<Real>, 4>& k, Real t) const {
    return {generated::safe_value<bound::none, Real>::evaluate_in_range(k.data(), t).y.value, bound};
  }
  Real bound;
};

template <class Real>
struct CubicValue<bound::tight, Real> {
  TIGHTROPE_HOST_DEVICE explicit CubicValue(const std::array<Bounded<Real>, 4>&) {}
  TIGHTROPE_HOST_DEVICE Bounded<Real> operator()(const std::array<Bounded<Real>, 4>& k, Real t) const {
    return generated::safe_value<bound::tight, Real>::evaluate_in_range(k.data(), t).y;
  }
};

/// The Bernstein coefficients of a quadratic over [l, r].
template <class Bound, class Real>
TIGHTROPE_HOST_DEVICE std::array<Bounded<Real>, 3> restricted(const std::array<Bounded<Real>, 3>& m, Real l, Real r) {
  constexpr bool constant_bound = std::is_same_v<Bound, bound::safe>;
  using Evaluated = std::conditional_t<constant_bound, bound::none, Bound>;
  const auto result = generated::safe_restriction<Evaluated, Real>::evaluate_in_range(m.data(), l, r);
  std::array<Bounded<Real>, 3> part{result.part[0], result.part[1], result.part[2]};
  if constexpr (constant_bound) {
    const Real bound = casteljau_bound<2>(m);
    for (Bounded<Real>& x : part) x.bound = bound;
  }
  return part;
}

}  // namespace tightrope::ccd::safe
