#pragma once
/// Isolation of a single crossing: an interval, as narrow as rounding allows, that holds the only root of a cubic.
///
/// Who includes this includes the generated headers of subdivision.pred first.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "ccd/host_device.h"
#include "ccd/tables.h"
#include "tightrope/sign.h"

namespace tightrope::generated {
template <class Bound, class Real>
struct cubic_slopes;
template <class Bound, class Real>
struct cubic_at;
template <class Bound, class Real>
struct newton_step;
}  // namespace tightrope::generated

namespace tightrope::ccd {

/// Bernstein coefficients of the cubic Y on a part of the step, with bounds.
using Cubic = std::array<Bounded<double>, 4>;

/// The direction in which the cubic passes through zero: positive if Y has at most one root in [0, 1], Y < 0 before and
/// Y > 0 after it (negative: the other way round); `uncertain` if there may be more roots. By Descartes' rule
/// (MATH 2.1), or because Y is monotone; k: signs of the coefficients.
template <class Signs>
TIGHTROPE_HOST_DEVICE Sign crossing_direction(const Cubic& y, const std::array<Sign, 4>& k, Signs& signs) {
  if (const Sign single = single_crossing(k[0], k[1], k[2], k[3]); single != Sign::uncertain) return single;
  const auto slopes = generated::cubic_slopes<bound::tight, double>::evaluate_in_range(y.data());
  return common(common(signs(slopes.q[0]), signs(slopes.q[1])), signs(slopes.q[2]));
}

/// About where the cubic crosses zero: Newton's method, guarded by bisection. How good it is decides nothing.
TIGHTROPE_HOST_DEVICE inline double estimated_crossing(const Cubic& y) {
  const double k[4] = {y[0].value, y[1].value, y[2].value, y[3].value};
  const bool rising = k[3] > k[0];
  double low = 0, high = 1;
  double t = k[0] / (k[0] - k[3]);
  if (!(t > 0 && t < 1)) t = 0.5;
  constexpr int enough = 16;
  for (int step = 0; step < enough; ++step) {
    const auto at_t = generated::newton_step<bound::none, double>::evaluate_in_range(k, t);
    ((at_t.y.value > 0) == rising ? high : low) = t;
    double next = t - at_t.y.value / (3 * at_t.slope.value);
    if (std::fabs(next - t) <= 0x1p-50) return std::clamp(next, low, high);
    if (!(next >= low && next <= high)) next = low + (high - low) / 2;
    t = next;
  }
  return t;
}

struct Bracket {
  double l, r;   ///< holds every root that the cubic has in [0, 1]
  bool crossed;  ///< Y certainly has opposite signs at l and r
};

/// A bracket around the root of a cubic that passes through zero in a known direction; none if no narrow one is found.
///
/// Left of the root Y has the sign of -direction, right of it that of direction, or there is no root at all: so a
/// definite sign of Y at l, opposite to the direction, puts every root right of l.
template <class Signs>
TIGHTROPE_HOST_DEVICE std::optional<Bracket> isolated_crossing(const Cubic& y, const std::array<Sign, 4>& k,
                                                               Sign direction, Signs& signs) {
  using value_at = generated::cubic_at<bound::tight, double>;
  const double t = estimated_crossing(y);
  const double plain[4] = {y[0].value, y[1].value, y[2].value, y[3].value};
  const auto about = generated::newton_step<bound::none, double>::evaluate_in_range(plain, t);
  const auto at_t = value_at::evaluate_in_range(y.data(), t);
  // Twice the distance at which Y leaves its bound, at its slope.
  double reach = (2 * (at_t.y.bound + std::fabs(at_t.y.value))) / (3 * std::fabs(about.slope.value)) + 0x1p-52;
  constexpr int attempts = 4;
  constexpr double too_wide = 0.25;
  for (int attempt = 0; attempt < attempts && reach < too_wide; ++attempt, reach *= 8) {
    const double l = std::max(t - reach, 0.0), r = std::min(t + reach, 1.0);
    const Sign at_l = l > 0 ? signs(value_at::evaluate_in_range(y.data(), l).y) : k[0];
    const Sign at_r = r < 1 ? signs(value_at::evaluate_in_range(y.data(), r).y) : k[3];
    const bool before = at_l == -direction, after = at_r == direction;
    if ((before || l == 0) && (after || r == 1)) return Bracket{l, r, before && after};
  }
  return std::nullopt;
}

}  // namespace tightrope::ccd
