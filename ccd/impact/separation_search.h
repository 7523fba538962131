#pragma once
/// Conservative advancement with turning planes.
///
/// Lemma. Let w(t) be a vector and m(t) >= d |w(t)| over [l, r]. If w . (b_j - a_i) - m > 0 there for all points a_i of
/// the one feature and b_j of the other, the features are farther than d apart all over [l, r].
/// Proof. y - x for points x, y of the features is a convex combination of the b_j - a_i, so d |w| <= m < w . (y - x)
/// <= |w| |y - x|; and |w| = 0 would give 0 < 0. QED. We take quadratic w; by the triangle inequality the quadratic m
/// with the Bernstein coefficients d |w_i|, or larger ones, will do. What must be positive is cubic; it is where its
/// Bernstein coefficients are, whose signs the generated predicates tell. Quadratics, because the normals of a moving
/// triangle and of two moving edges are.
///
/// Everything else chooses w and r, and may be as wrong as it likes. From l the search takes the largest r that it can
/// prove, with a plane that turns from the best at l to the best at r. A plane that keeps its direction is a step of
/// Newton's method for the distance: the width of its slab is linear in t and never above the distance, so that steps
/// lead towards the root, never over it. Half of that step leaves half of what the distance exceeds d by: if that
/// cannot be proved, it is within rounding errors. As no width changes faster than the speed V, the half is (distance -
/// d) / 2 V at least. So the search ends, after at most 2 V / (d slack) steps (in practice about ten), where the
/// features are as near as is promised; what is promised has room for a quarter of `separation_noise`, so that tiny
/// separations end, too.
///
/// Who includes this includes the generated header of its bound mode (separation.pred) first.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "ccd/impact/scaled_points.h"
#include "ccd/impact/separation.h"
#include "ccd/impact/separation_plane.h"
#include "tightrope/sign.h"

namespace tightrope::generated {
template <class Bound, class Real>
struct separation_reach;
template <class Bound, class Real>
struct separation_step;
template <class Bound, class Real>
struct separation_part;
}  // namespace tightrope::generated

namespace tightrope::ccd {

/// The search for the first time at which the features may be within `separation`.
template <class Bound>
class Approach {
 public:
  /// The points satisfy the ranges of separation.pred; not so small that their squares drown in underflow.
  Approach(Pair pair, const double* points, double separation)
      : count_(number_of_points(pair)),
        first_(points_of_first(pair)),
        pair_(pair),
        points_(points),
        separation_(separation) {
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        start_[i][axis] = at_0(i)[axis] - at_0(0)[axis];
        end_[i][axis] = at_1(i)[axis] - at_1(0)[axis];
        extent_ = std::max({extent_, std::fabs(start_[i][axis]), std::fabs(end_[i][axis])});
      }
    }
  }

  /// None: not in [0, t_max].
  std::optional<double> first_time(double tolerance, double t_max) const {
    if (count_ == 4 && proved(0, t_max, common_normal(pair_, positions_at(0), positions_at(t_max)))) {
      return std::nullopt;
    }
    Search search{slab_at(0), t_max, t_max, std::numeric_limits<double>::infinity()};
    do {
      if (!advance(search) || search.near - search.at.t <= tolerance) return search.at.t;
    } while (search.at.t < t_max);
    return std::nullopt;
  }

  Positions positions_at(double t) const {
    Positions positions;
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        positions[i][axis] = (1 - t) * start_[i][axis] + t * end_[i][axis];
      }
    }
    return positions;
  }

 private:
  /// The best plane at a time.
  struct Slab {
    double t;
    Positions positions;
    SeparatingPlane plane;
  };

  struct Search {
    Slab at;  ///< farther apart than the separation until here
    double t_max;
    double step;  ///< the longest to try next
    double near;  ///< a later time at which they are within the separation, about; infinity if none is known
  };

  const double* at_0(std::size_t point) const { return points_ + 3 * point; }
  const double* at_1(std::size_t point) const { return points_ + 3 * (count_ + point); }

  /// Calls `check` for the points of the first feature and of the second, as long as it returns true.
  template <class Check>
  bool for_all_pairs(const Check& check) const {
    for (std::size_t i = 0; i < first_; ++i) {
      for (std::size_t j = first_; j < count_; ++j) {
        if (!check(i, j)) return false;
      }
    }
    return true;
  }

  Slab slab_at(double t) const {
    const Positions positions = positions_at(t);
    return {t, positions, best_plane(pair_, positions)};
  }

  /// At least separation * |w|, for each coefficient.
  std::array<double, 3> reach(const TurningNormal& normal) const {
    std::array<double, 3> result;
    using Reach = generated::separation_reach<Bound, double>;
    for (std::size_t i = 0; i < 3; ++i) {
      const Bounded<double> x = Reach::evaluate_in_range(normal[i].data(), separation_).reach;
      // Upwards: two roundings are less than 2^-51 of it. The last term covers what `scaled_to_one` lost to underflow
      // (less than 2^-1060 in w . (b - a)).
      result[i] = (x.value + x.bound) * (1 + 0x1p-51) + 0x1p-1000;
    }
    return result;
  }

  /// By the lemma: farther apart than the separation in [l, r]?
  bool proved(double l, double r, const TurningNormal& normal) const {
    const auto positive = [](const Bounded<double>(&beyond)[4]) {
      bool all = true;
      for (const Bounded<double>& x : beyond) all &= sign(x) == Sign::positive;
      return all;
    };
    const std::array<double, 3> m = reach(normal);
    const double* const w = normal[0].data();
    static_assert(sizeof(normal) == 9 * sizeof(double));
    if (l == 0 && r == 1) {
      using Step = generated::separation_step<Bound, double>;
      return for_all_pairs([&](std::size_t i, std::size_t j) {
        return positive(Step::evaluate_in_range(at_0(i), at_1(i), at_0(j), at_1(j), w, m.data()).beyond);
      });
    }
    using Part = generated::separation_part<Bound, double>;
    return for_all_pairs([&](std::size_t i, std::size_t j) {
      return positive(Part::evaluate_in_range(at_0(i), at_1(i), at_0(j), at_1(j), l, r, w, m.data()).beyond);
    });
  }

  /// After which time may the slab, keeping its direction, be too narrow?
  double direct_step(const Slab& slab) const {
    double step = std::numeric_limits<double>::infinity();
    for_all_pairs([&](std::size_t i, std::size_t j) {
      double width_0 = 0, width_1 = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        width_0 += slab.plane.normal[axis] * (start_[j][axis] - start_[i][axis]);
        width_1 += slab.plane.normal[axis] * (end_[j][axis] - end_[i][axis]);
      }
      if (width_1 < width_0) {
        const double now = (1 - slab.t) * width_0 + slab.t * width_1;
        step = std::min(step, (now - separation_) / (width_0 - width_1));
      }
      return true;
    });
    return step;
  }

  /// Moves on to a later time such that no part of the way there is within the separation. False: too near.
  bool advance(Search& search) const {
    const Slab& at = search.at;
    const double excess = at.plane.distance - separation_;
    if (!(excess > separation_ * separation_slack + extent_ * (separation_noise / 4))) return false;
    const double direct = direct_step(at);
    if (!(direct > 0)) return false;
    double step = std::min(std::max(search.step, 4 * direct), (search.near - at.t) / 2);
    for (; step > 1.5 * direct && at.t + step > at.t; step /= 4) {
      const Slab end = slab_at(std::min(at.t + step, search.t_max));
      if (!(end.plane.distance > separation_)) {
        search.near = end.t;
        break;
      }
      if (proved(at.t, end.t, turning_normal(pair_, at.positions, at.plane, end.positions, end.plane))) {
        search.at = end;
        search.step = 4 * step;
        return true;
      }
    }
    for (const double straight : {direct * (1 - 0x1p-20), direct / 2}) {
      const double r = std::min(at.t + straight, search.t_max);
      if ((r > at.t || r == search.t_max) && proved(at.t, r, {at.plane.normal, at.plane.normal, at.plane.normal})) {
        search.at = slab_at(r);
        search.step = 0;
        if (search.near <= r) search.near = std::numeric_limits<double>::infinity();
        return true;
      }
    }
    return false;
  }

  std::size_t count_;
  std::size_t first_;
  Pair pair_;
  const double* points_;
  double separation_;
  Positions start_{};
  Positions end_{};
  double extent_ = 0;  ///< at most the largest difference between two of the points in a coordinate
};

}  // namespace tightrope::ccd
