#pragma once
/// Ranges and ticks of logarithmic axes.

#include <string>
#include <vector>

namespace tightrope::charts {

struct Tick {
  double value = 0;
  std::string label = {};     ///< empty: a small tick
  std::string exponent = {};  ///< not empty: raised behind the label
};

/// Ticks of the axis from `low` to `high`, 0 < low < high, `most` of them with labels at most (at least 2): 1, 2 and 5
/// times powers of ten on short axes, every k-th power of ten on long ones.
std::vector<Tick> log_ticks(double low, double high, int most);

}  // namespace tightrope::charts
