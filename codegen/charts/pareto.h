#pragma once
/// What no other choice beats.

#include <cstddef>
#include <span>
#include <vector>

namespace tightrope::charts {

/// Two costs; less is better.
struct Cost {
  double first = 0;
  double second = 0;
};

/// The indices of those that no other is better than in one cost without being worse in the other, by rising first and
/// falling second cost. Of equals the first.
std::vector<std::size_t> pareto_front(std::span<const Cost> costs);

}  // namespace tightrope::charts
