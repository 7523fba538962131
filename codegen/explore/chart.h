#pragma once
/// An exploration as a picture.

#include "codegen/charts/chart.h"
#include "codegen/explore/exploration.h"

namespace tightrope::codegen::explore {

/// Time (operations, if nothing was timed) against size of bound: one series a bound, labels for the front and for the
/// defaults. Schemes without a bound, or with one that is of no use on these inputs, have no place.
charts::Chart exploration_chart(const Exploration& exploration);

}  // namespace tightrope::codegen::explore
