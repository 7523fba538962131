#pragma once
/// The filter of method `tightrope`. Who includes this includes the generated headers first.

#include "ccd/gpu/stages.h"
#include "ccd/impact/filter.h"

namespace tightrope::ccd::gpu {

/// The first look; separation; the hull; subdivision.
template <class Real>
struct Stages<Method::tightrope, Real> {
  static constexpr int count = 4;

  template <int Stage>
  TIGHTROPE_HOST_DEVICE static Answer look(Kind kind, const Real* points) {
    SignReader signs;
    if constexpr (Stage == 0) {
      return apart_or(separated_by_plane<true>(kind, points, signs), Answer::next);
    } else {
      const auto& exact_points = in_double_precision(points);
      return look_in_double_precision<Stage>(kind, exact_points.data(), signs);
    }
  }

 private:
  template <int Stage>
  TIGHTROPE_HOST_DEVICE static Answer look_in_double_precision(Kind kind, const double* points, SignReader& signs) {
    if constexpr (Stage == 1) {
      if (!has_finite_coordinates(points)) return Answer::open;
      if (sizeof(Real) < sizeof(double) && separated_by_plane<true>(kind, points, signs)) return Answer::apart;
      return apart_or(separated_by_axis_or_plane(kind, points, signs), Answer::next);
    } else {
      constexpr bool subdivide = Stage == 3;
      const Finding found = filtered_unseparated<subdivide>(kind, points, Question::whether, 1, signs).finding;
      switch (found.verdict) {
        case Verdict::no_contact:
          return Answer::apart;
        case Verdict::contact:
          return Answer::touches;
        case Verdict::open:
          return subdivide ? Answer::open : Answer::next;
      }
      return Answer::open;
    }
  }
};

}  // namespace tightrope::ccd::gpu
