#pragma once
/// Which queries a method leaves to exact arithmetic: what they cost most.

#include <span>

#include "tightrope/ccd.h"

namespace tightrope::ccd::stability {

/// Whether the method has an exact stage whose use can be told.
bool has_exact_stage(Method method);

/// Whether exact arithmetic decides this query; `method` has such a stage, coordinates are finite.
bool reaches_exact_stage(Method method, Kind kind, std::span<const double, 24> points);
bool reaches_exact_stage(Method method, Kind kind, std::span<const float, 24> points);

}  // namespace tightrope::ccd::stability
