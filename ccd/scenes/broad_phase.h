#pragma once
/// Pairs of axis-aligned boxes that overlap.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "scenes/point.h"

namespace tightrope::ccd {

struct Box {
  Point low;
  Point high;
};

/// All (i, j) for which first[i] and second[j] overlap, touching included, in an order that depends on the boxes alone.
std::vector<std::pair<std::uint32_t, std::uint32_t>> overlapping_pairs(std::span<const Box> first,
                                                                       std::span<const Box> second);

}  // namespace tightrope::ccd
