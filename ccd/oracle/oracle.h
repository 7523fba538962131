#pragma once
/// The exact oracle: decides vertex-face and edge-edge queries by exact arithmetic alone, in every degenerate case.
/// It includes none of the methods' code (tests/ checks that) and no generated code; GMP does the arithmetic.

#include <optional>
#include <span>

#include "tightrope/ccd.h"

namespace tightrope::ccd::oracle {

/// The exact time of first contact in [0, 1] between neighbouring doubles, by exact sign tests; lower == upper where
/// the time is that double.
struct Contact {
  double lower;  ///< the largest double not above the time
  double upper;  ///< the smallest double not below it
};

/// Decides a query exactly; `points` as in collides(Kind, const double*), 24 finite numbers. Empty: no contact.
std::optional<Contact> first_contact(Kind kind, std::span<const double, 24> points);

/// Only whether there is contact (cheaper: no refinement of the time, certain non-contacts are found by exact signs
/// first).
bool contact(Kind kind, std::span<const double, 24> points);

}  // namespace tightrope::ccd::oracle
