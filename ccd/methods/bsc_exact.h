#pragma once
/// The two stages of `bsc-exact` after `tight` (MATH 2.7), for its tests. Coordinates must be finite.

#include <optional>

#include "ccd/sign_reader.h"
#include "tightrope/method.h"

namespace tightrope::ccd::exact {

/// Is there contact? Decided in exact arithmetic.
bool contact(Kind kind, const double* points);

/// The same in floating point with TightBound; empty where a sign that it needs is uncertain.
std::optional<bool> filtered_contact(Kind kind, const double* points);

}  // namespace tightrope::ccd::exact
