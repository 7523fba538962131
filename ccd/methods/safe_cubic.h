#pragma once
/// The cubic solver of SafeCCD: where in a part of [0, 1] can F, a cubic known up to bounds, vanish?
///
/// After Huamin Wang, "Defending Continuous Collision Detection against Errors", 2014, Appendix A (quadratic solver)
/// and B (cubic solver): split at the extrema, then Newton's method guarded by bisection on every piece. There F is in
/// power form, and thresholds of 16746 B^3 eps (two roots in a computed piece), 32746 (three) and 64 B^3 eps^(3/4)
/// cover what wrong extrema do. Here F is in Bernstein form, and the error of the extrema is measured instead of
/// bounded in advance, so that nothing depends on how good they are:
///
/// Lemma S1 (monotone up to slack). Let F' >= -D on [s, e], and m = D (e - s). Then for every x in [s, e]: F(x) > m
/// implies F > 0 on [x, e], F(x) < -m implies F < 0 on [s, x]. Proof: integrate F' from x to e, from s to x. The
/// mirror image holds for F' <= D. D comes from the hull of F' on the piece: 0 if the extrema are exact, of the order
/// of their residual otherwise.
///
/// Who includes this includes the generated headers of safe_cubic.pred first.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "ccd/methods/safe_bound.h"
#include "ccd/methods/safe_quadratic.h"
#include "ccd/tables.h"

namespace tightrope::generated {
template <class Bound, class Real>
struct safe_slope;
template <class Bound, class Real>
struct safe_slopes;
template <class Bound, class Real>
struct safe_derivative;
}  // namespace tightrope::generated

namespace tightrope::ccd::safe {

/// F on [0, 1] with values and bounds; coefficients at most 1 in magnitude.
template <class Bound, class Real>
class Cubic {
 public:
  TIGHTROPE_HOST_DEVICE explicit Cubic(const std::array<Bounded<Real>, 4>& k) : k_(k), value_(k) {
    for (std::size_t i = 0; i < 4; ++i) plain_[i] = k[i].value;
  }
  TIGHTROPE_HOST_DEVICE Bounded<Real> operator()(Real t) const { return value_(k_, t); }
  TIGHTROPE_HOST_DEVICE const std::array<Bounded<Real>, 4>& coefficients() const { return k_; }
  TIGHTROPE_HOST_DEVICE const Real* plain() const { return plain_.data(); }
  /// F' at t, about.
  TIGHTROPE_HOST_DEVICE Real slope(Real t) const {
    return 3 * generated::safe_derivative<bound::none, Real>::evaluate_in_range(plain_.data(), t).slope.value;
  }

 private:
  std::array<Bounded<Real>, 4> k_;
  std::array<Real, 4> plain_;
  CubicValue<Bound, Real> value_;
};

/// The parameters in (0, 1) at which the cubic has extrema, ascending, or its inflection where it has none: F' is least
/// in magnitude there, and a cut keeps the hull of F' one-signed on both sides.
template <class Real>
TIGHTROPE_HOST_DEVICE QuadraticRoots<Real> extrema(const Real* k) {
  const auto slopes = generated::safe_slopes<bound::none, Real>::evaluate_in_range(k);
  return quadratic_roots<Real>({slopes.q[0].value, slopes.q[1].value, slopes.q[2].value});
}

/// F on a piece [s, e] on which it is monotone up to slack (S1).
template <class Bound, class Real, class Signs>
class MonotonePiece {
 public:
  TIGHTROPE_HOST_DEVICE MonotonePiece(const Cubic<Bound, Real>& f, Interval<Real> piece, Bounded<Real> at_s,
                                      Bounded<Real> at_e, Signs& signs)
      : f_(f), piece_(piece), rising_(at_e.value >= at_s.value), signs_(signs) {
    const auto slopes =
        generated::safe_slope<Bound, Real>::evaluate_in_range(f.coefficients().data(), piece.l, piece.r);
    Real against = 0;  // F' / 3 >= -against (F rising)
    for (const Bounded<Real>& q : slopes.q) against = maximum(against, (rising_ ? -q.value : q.value) + q.bound);
    // Five roundings, of the sum, the width and the products: less than 8 u relative.
    slack_ = 3 * against * (piece.r - piece.l) * (1 + 8 * std::numeric_limits<Real>::epsilon()) +
             std::numeric_limits<Real>::min();
    at_s_ = side(at_s);
    at_e_ = side(at_e);
  }

  /// An interval that holds every root of F in the piece; none if there are none.
  TIGHTROPE_HOST_DEVICE std::optional<Interval<Real>> roots() const {
    if (at_s_ == Sign::positive || at_e_ == Sign::negative) return std::nullopt;
    if (at_s_ == Sign::uncertain && at_e_ == Sign::uncertain) return piece_;
    Interval<Real> held = piece_;
    Real t = at_s_ == Sign::uncertain ? piece_.l : piece_.r;
    if (at_s_ != Sign::uncertain && at_e_ != Sign::uncertain) t = approach(held);
    tighten(t, held);
    return held;
  }

 private:
  /// With F rising (else of -F): negative if F < 0 from s to where y was computed, positive if F > 0 from there to e.
  TIGHTROPE_HOST_DEVICE Sign side(Bounded<Real> y) const {
    const Sign sign =
        signs_(Bounded<Real>{y.value, (y.bound + slack_) * (1 + 4 * std::numeric_limits<Real>::epsilon())});
    return rising_ ? sign : -sign;
  }

  /// Takes what the side at t says into account: the roots in `held` are on one side of t then.
  TIGHTROPE_HOST_DEVICE Sign narrow(Real t, Interval<Real>& held) const {
    const Sign s = side(f_(t));
    if (s == Sign::negative) held.l = t;
    if (s == Sign::positive) held.r = t;
    return s;
  }

  /// Newton's method from the middle, guarded by bisection of `held`, to a parameter where F is within its bound.
  /// Each step halves the interval or is Newton's; the number of steps is limited, and whatever happens `held` keeps
  /// every root, so that stopping early costs width and nothing else.
  TIGHTROPE_HOST_DEVICE Real approach(Interval<Real>& held) const {
    constexpr int limit = 2 * std::numeric_limits<Real>::digits;
    Real t = held.l + (held.r - held.l) / 2;
    for (int step = 0; step < limit && held.l < t && t < held.r; ++step) {
      const Bounded<Real> y = f_(t);
      const Sign s = side(y);
      if (s == Sign::uncertain) return t;
      (s == Sign::negative ? held.l : held.r) = t;
      const Real newton = t - y.value / f_.slope(t);
      const bool useful = newton > held.l && newton < held.r && step % 4 != 3;
      t = useful ? newton : held.l + (held.r - held.l) / 2;
    }
    return t;
  }

  /// Looks for definite sides close to t, at distances of what F's bound means at its slope there, at most what it
  /// means where F has a triple root.
  TIGHTROPE_HOST_DEVICE void tighten(Real t, Interval<Real>& held) const {
    constexpr Real eps = std::numeric_limits<Real>::epsilon();
    constexpr Real at_triple_root = sizeof(Real) == 8 ? Real(0x1p-17) : Real(0x1p-7);  // eps^(1/3)
    const Bounded<Real> y = f_(t);
    const Real simple = 2 * (y.bound + slack_ + std::fabs(y.value)) / std::fabs(f_.slope(t)) + 2 * eps;
    const Real least = simple < at_triple_root ? simple : at_triple_root;
    for (Real x = t + least, step = least; x < held.r && narrow(x, held) != Sign::positive; x = t + step) step *= 8;
    for (Real x = t - least, step = least; x > held.l && narrow(x, held) != Sign::negative; x = t - step) step *= 8;
  }

  const Cubic<Bound, Real>& f_;
  Interval<Real> piece_;
  bool rising_;
  Real slack_ = 0;
  Sign at_s_ = Sign::uncertain;
  Sign at_e_ = Sign::uncertain;
  Signs& signs_;
};

/// Intervals, ascending, that hold every root of F in [0, 1]; at most three.
template <class Real>
struct Roots {
  std::array<Interval<Real>, 3> at;
  std::size_t count = 0;
};

template <class Bound, class Real, class Signs>
TIGHTROPE_HOST_DEVICE Roots<Real> roots(const Cubic<Bound, Real>& f, Signs& signs) {
  const QuadraticRoots<Real> cuts = extrema(f.plain());
  Roots<Real> all{};
  Real s = 0;
  Bounded<Real> at_s = f.coefficients()[0];
  for (std::size_t i = 0; i <= cuts.count; ++i) {
    const Real e = i < cuts.count ? cuts.t[i] : 1;
    const Bounded<Real> at_e = i < cuts.count ? f(e) : f.coefficients()[3];
    const MonotonePiece<Bound, Real, Signs> piece(f, {s, e}, at_s, at_e, signs);
    if (const auto held = piece.roots()) all.at[all.count++] = *held;
    s = e;
    at_s = at_e;
  }
  return all;
}

}  // namespace tightrope::ccd::safe
