#pragma once
/// One function a method: decides the query of 24 coordinates at `points` (see ccd.h).

#include "tightrope/ccd.h"

namespace tightrope::ccd {

bool bsc_float_collides(Kind kind, const double* points);
bool bsc_safe_collides(Kind kind, const double* points);
bool tight_collides(Kind kind, const double* points);

}  // namespace tightrope::ccd
