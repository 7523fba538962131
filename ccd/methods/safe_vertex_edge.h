#pragma once
/// When may something happen between a vertex and an edge? The candidate times of SafeCCD's vertex-edge test [Wang
/// 2014, Section 4.3 and Appendix C].
///
/// There F_0ij(t) = |x_0i x x_ji|_1 - S |x_ji|_inf is minimised over four families of candidates: (1) the ends, (2)
/// extrema of the quadratics that F is made of, (3) times at which two components of x_ji are equal in magnitude, (4)
/// roots of the components of x_0i x x_ji, components below rho = 3 B^2 eps^(1/2) removed; and a contact is what comes
/// below 725 B^2 eps^(1/2) and passes |x_ji|^2 > 2100 B^2 eps^(1/2). Here the candidates cut the step into parts, each
/// of which is then proved free or not, so that nothing depends on their precision. No thickness S is needed, which
/// leaves family (3) without a purpose; rho is the component's error bound. A vertex passes a line at a root of family
/// (4): close to it signs are uncertain, and they are settled up to there. Extrema (2) leave monotone parts.
/// Vertex-vertex: times at which two vertices share a coordinate.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "ccd/methods/safe_quadratic.h"

namespace tightrope::ccd::safe {

/// Parts of an interval, ascending, that cover it.
template <class Real>
class Candidates {
 public:
  TIGHTROPE_HOST_DEVICE explicit Candidates(Interval<Real> within) : within_(within) {}

  /// Families (2) and (4) of one component of x_0i x x_ji: `m` its Bernstein coefficients over [0, 1].
  TIGHTROPE_HOST_DEVICE void add_component(const std::array<Bounded<Real>, 3>& m) {
    Real bound = 0, largest = 0;
    for (const Bounded<Real>& x : m) {
      bound = std::max(bound, x.bound);
      largest = std::max(largest, magnitude(x.value));
    }
    if (!(largest > 2 * bound)) return;  // rho: the component is noise all the time
    const QuadraticRoots<Real> roots = quadratic_roots<Real>({m[0].value, m[1].value, m[2].value});
    for (std::size_t i = 0; i < roots.count; ++i) add_root(roots.t[i], bound, roots.slope);
    const Real rise = m[1].value - m[0].value;
    add_cut(rise / (rise - (m[2].value - m[1].value)));
  }

  /// Vertex-vertex: the difference of two vertices in one coordinate, d0 and d1 at the ends of [0, 1].
  TIGHTROPE_HOST_DEVICE void add_difference(Real d0, Real d1) {
    const Real size = std::max(magnitude(d0), magnitude(d1));
    add_root(d0 / (d0 - d1), std::numeric_limits<Real>::epsilon() * size, magnitude(d1 - d0));
  }

  /// Calls `visit` with each part until it returns true.
  template <class Visit>
  TIGHTROPE_HOST_DEVICE bool any_part(const Visit& visit) const {
    Real l = within_.l;
    for (std::size_t i = 0; i < count_; ++i) {
      if (!(cuts_[i] > l)) continue;
      if (visit(Interval<Real>{l, cuts_[i]})) return true;
      l = cuts_[i];
    }
    return visit(Interval<Real>{l, within_.r});
  }

 private:
  /// Cuts on both sides of a root, where the bound of the function with this slope no longer hides its sign.
  TIGHTROPE_HOST_DEVICE void add_root(Real t, Real bound, Real slope) {
    constexpr Real eps = std::numeric_limits<Real>::epsilon();
    constexpr Real widest = Real(1) / 64;
    const Real distance = 4 * bound / slope + 8 * eps;
    if (!(distance < widest)) return add_cut(t);  // close to a double root
    add_cut(t - distance);
    add_cut(t + distance);
  }

  TIGHTROPE_HOST_DEVICE void add_cut(Real t) {
    if (!(t > within_.l && t < within_.r) || count_ == cuts_.size()) return;  // NaN, too
    std::size_t i = count_++;
    for (; i > 0 && cuts_[i - 1] > t; --i) cuts_[i] = cuts_[i - 1];
    cuts_[i] = t;
  }

  Interval<Real> within_;
  std::array<Real, 108> cuts_;  ///< ascending; 12 components with 5 cuts each, 12 differences with 2: 84
  std::size_t count_ = 0;
};

}  // namespace tightrope::ccd::safe
