#pragma once
/// The exact time of first contact, as finely as wanted.

#include <gmpxx.h>

#include <optional>
#include <span>

#include "tightrope/ccd.h"

namespace tightrope::ccd::oracle {

/// lower == upper: exactly this time, a rational one. Otherwise an irrational (algebraic) time strictly between them,
/// which are dyadic.
struct TimeInterval {
  mpq_class lower;
  mpq_class upper;
};

/// The first time of contact in [0, 1], exactly if it is rational, else to at most `width` > 0; of the polynomial that
/// it is a root of (the coplanarity, or in coplanar motion a component of a cross product or a dot product) the
/// interval holds no other root. Empty: no contact. `points` as in contact(), oracle.h.
std::optional<TimeInterval> first_contact(Kind kind, std::span<const double, 24> points, const mpq_class& width);

}  // namespace tightrope::ccd::oracle
