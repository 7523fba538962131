#pragma once
/// The exact stage of method `tightrope`: the first time of contact of any pair of features, in exact arithmetic.

#include <optional>

#include "tightrope/ccd.h"
#include "tightrope/impact.h"

namespace tightrope::ccd {

/// lower <= time <= upper
struct TimeBracket {
  double lower;
  double upper;
};

/// Empty: no contact in [0, t_max], exactly. Else the first contact, with upper - lower <= tolerance, or, where that is
/// less than the distance of two doubles, lower the largest double not above it and upper the smallest not below it.
/// lower is 0 only if the contact is at 0 or before the smallest positive double. Coordinates must be finite.
std::optional<TimeBracket> exact_first_contact(Pair pair, const double* points, double tolerance, double t_max);

/// Is there contact in [0, 1]? Coordinates must be finite.
bool exact_contact(Pair pair, const double* points);

/// Sharpens a bracket in which Y changes its sign exactly once, at a contact and with no earlier one, until it is what
/// `exact_first_contact` returns; by exact signs of Y at doubles alone.
TimeBracket sharpened(Kind kind, const double* points, TimeBracket bracket, double tolerance);

}  // namespace tightrope::ccd
