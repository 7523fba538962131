#pragma once
/// Minimum separation: when do two moving features first come within a distance?

#include <optional>

#include "tightrope/plain.h"

namespace tightrope::ccd {

/// Relative slack of the separation: features that come within (1 + separation_slack) times it may be reported.
inline constexpr double separation_slack = 0x1p-20;

/// And absolute slack, for what floating point cannot tell: this times the largest difference between two of the points
/// in a coordinate, at the ends of the step.
inline constexpr double separation_noise = 0x1p-47;

/// When the closed features first come within `separation` of each other. `points` as in `Pair`, 3 coordinates a point.
///
/// Empty: a proof that they stay farther apart than that during [0, t_max]. Otherwise they are farther apart before
/// `time`, a proof again, and within separation * (1 + separation_slack) + separation_noise * (largest difference) at a
/// time in [time, time + tolerance]; `weights`: of the points nearest to each other then. The step is [0, 1], and t_max
/// is taken to be in it (NaN: 1).
///
/// A separation of 0 or less asks for contact, with the slack above: the exact question is `first_impact`'s. Infinity
/// and NaN, for the separation or a coordinate: time 0.
std::optional<Impact> first_approach(Pair pair, const double* points, double separation, double tolerance,
                                     double t_max);

}  // namespace tightrope::ccd
