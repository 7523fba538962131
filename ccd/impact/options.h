#pragma once
/// Options of the time of impact, made valid.

#include "tightrope/plain.h"

namespace tightrope::ccd {

/// The options as impact.h documents what is out of range; only t_max may be negative still: then no contact counts.
inline ImpactOptions in_range(ImpactOptions options) {
  if (!(options.tolerance > 0)) options.tolerance = 0;
  if (!(options.t_max <= 1)) options.t_max = 1;
  if (options.minimum_separation < 0) options.minimum_separation = 0;
  return options;
}

}  // namespace tightrope::ccd
