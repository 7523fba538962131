#pragma once
/// The exact stage of method `tightrope`: is there contact, and when first? Every sign that decides is exact
/// (MATH 3.6); every degenerate case is decided. Coordinates must be finite (the program ends otherwise).

#include <optional>

#include "tightrope/plain.h"

namespace tightrope::ccd {

/// lower <= time <= upper, in steps.
struct TimeBracket {
  double lower, upper;
};

/// The time t* of the first contact; empty if there is none in [0, t_max]. upper - lower <= tolerance or, if
/// `tolerance` is smaller than doubles are apart, lower is the largest double not above t* and upper the smallest not
/// below it. lower is 0 only if t* is 0 or below the smallest positive double. `points`: those of the pair (impact.h),
/// 3 coordinates each.
std::optional<TimeBracket> exact_first_contact(Pair pair, const double* points, double tolerance, double t_max);

/// Is there contact in [0, 1]?
bool exact_contact(Pair pair, const double* points);

/// A bracket as above of the only time in `bracket` at which the four points are coplanar, Y having opposite signs
/// before and after it in `bracket`. Nothing else is asked: whether there is contact is known.
TimeBracket sharpened(Kind kind, const double* points, TimeBracket bracket, double tolerance);

}  // namespace tightrope::ccd
