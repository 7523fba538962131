#pragma once
/// Bernstein sign classification. Who includes this includes the generated headers of his bound mode first.

#include "ccd/classification.h"
#include "ccd/gpu/stages.h"

namespace tightrope::ccd::gpu {

/// The first look; axes and hulls; the classification.
template <class Bound, class Real>
struct ClassificationStages {
  static constexpr int count = 3;

  template <int Stage>
  TIGHTROPE_HOST_DEVICE static Answer look(Kind kind, const Real* points) {
    SignReader signs;
    if constexpr (Stage == 0) {
      return apart_or(rejected_at_first_look<Bound>(kind, points, signs), Answer::next);
    } else if constexpr (Stage == 1) {
      return apart_or(is_separated(kind, points, signs) || is_apart_by_hulls(kind, points, signs), Answer::next);
    } else {
      return answer(collides_by_second_look<Bound>(kind, points, signs));
    }
  }

 private:
  /// Do the signs of Y's or of the quadratics' coefficients exclude contact? Then the classification answers `false`,
  /// too: it asks the same, in this order, and answers `true` before only where a number is too large to be rescaled,
  /// which none is: of coordinates up to 2^53 (2^32) Y has coefficients and bounds below 2^170 (2^110).
  TIGHTROPE_HOST_DEVICE static bool is_apart_by_hulls(Kind kind, const Real* points, SignReader& signs) {
    if (!has_moderate_coordinates(points) || !(spread(points) >= least_spread<Real>)) return false;
    return !with_polynomials<Bound>(kind, points, false, [&](const auto& k, const auto& compute_quadratics) {
      if (common(read_all(signs, k)) != Sign::uncertain) return false;
      for (const auto& axis : hull_signs(compute_quadratics(), signs)) {
        if (any_opposite(axis)) return false;
      }
      return true;
    });
  }

  /// What is not finite, or four points that are one all the time, collides whatever its axes say.
  TIGHTROPE_HOST_DEVICE static bool is_separated(Kind kind, const Real* points, SignReader& signs) {
    return has_finite_coordinates(points) && separated(kind, points, signs);
  }
};

template <class Real>
struct Stages<Method::bsc_float, Real> : ClassificationStages<bound::none, Real> {};
template <class Real>
struct Stages<Method::bsc_safe, Real> : ClassificationStages<bound::safe, Real> {};
template <class Real>
struct Stages<Method::tight, Real> : ClassificationStages<bound::tight, Real> {};

/// What `tight` answers `false` to is free of contact; the rest is open.
template <class Real>
struct Stages<Method::bsc_exact, Real> {
  static constexpr int count = ClassificationStages<bound::tight, Real>::count;

  template <int Stage>
  TIGHTROPE_HOST_DEVICE static Answer look(Kind kind, const Real* points) {
    const Answer by_bounds = ClassificationStages<bound::tight, Real>::template look<Stage>(kind, points);
    return by_bounds == Answer::touches ? Answer::open : by_bounds;
  }
};

}  // namespace tightrope::ccd::gpu
