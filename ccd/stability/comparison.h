#pragma once
/// Two atlases of the same sweep: has anything become worse?

#include <string>
#include <vector>

#include "stability/atlas.h"

namespace tightrope::ccd::stability {

/// What methods promise and did not keep: misses of conservative ones, false alarms of exact ones. One line each.
std::vector<std::string> broken_promises(const Atlas& atlas);

/// What is worse in `now` than in `golden`, one line each: a cell with more false alarms, another truth, a method or a
/// map that is gone, another sweep. Methods that are new have nothing to be compared with.
std::vector<std::string> regressions(const Atlas& golden, const Atlas& now);

}  // namespace tightrope::ccd::stability
