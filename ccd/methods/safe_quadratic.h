#pragma once
/// The quadratic solver of SafeCCD [Wang 2014, Appendix A].
///
/// Its roots are guesses: everything that uses them proves afterwards what it needs, so no error bound of theirs enters
/// a decision. What Appendix A shows of them (root error 2 eps^(1/2), residual 16 B eps) makes the guesses good enough.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "ccd/host_device.h"
#include "tightrope/sign.h"

namespace tightrope::generated {
template <class Bound, class Real>
struct safe_quadratic;
}  // namespace tightrope::generated

namespace tightrope::ccd::safe {

/// A part of the step.
template <class Real>
struct Interval {
  Real l;
  Real r;
};

/// Roots in (0, 1), ascending.
template <class Real>
struct QuadraticRoots {
  std::array<Real, 2> t{};
  std::size_t count = 0;
  Real slope = 0;  ///< magnitude of the derivative at the roots, about
};

/// Roots of the quadratic with Bernstein coefficients q over [0, 1], at most 2 in magnitude. Without cancellation: the
/// two terms that are added have one sign. A discriminant below 0 is clamped to 0, so that rounding cannot remove a
/// double root; the parameter of the extremum is returned then. The degenerate cases of A.3 (a = 0, b = 0) need no
/// branch: a quotient that is infinite or NaN is no root in (0, 1).
template <class Real>
TIGHTROPE_HOST_DEVICE QuadraticRoots<Real> quadratic_roots(const std::array<Real, 3>& q) {
  const auto power = generated::safe_quadratic<bound::none, Real>::evaluate_in_range(q.data());
  QuadraticRoots<Real> roots;
  const auto keep = [&](Real t) {
    if (t > 0 && t < 1) roots.t[roots.count++] = t;
  };
  const Real root = std::sqrt(std::max(power.discriminant.value, Real(0)));
  const Real half_b = power.half_b.value;
  const Real sum = half_b > 0 ? -half_b - root : root - half_b;
  keep(sum / power.a.value);
  keep(power.c.value / sum);
  if (roots.count == 2 && roots.t[1] < roots.t[0]) std::swap(roots.t[0], roots.t[1]);
  roots.slope = 2 * root;
  return roots;
}

}  // namespace tightrope::ccd::safe
