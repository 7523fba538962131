#include "scenes/broad_phase.h"

#include <algorithm>
#include <cmath>

namespace tightrope::ccd {
namespace {

bool overlap(const Box& a, const Box& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

struct Placed {
  int strip;  ///< of the box's lower y
  Box box;
  std::uint32_t index;
};

/// Extents of the widest box, and the lowest y.
struct Extents {
  double x = 0;
  double y = 0;
  double lowest_y = 0;
};

Extents extents(std::span<const Box> boxes) {
  Extents result{.x = 0, .y = 0, .lowest_y = boxes.front().low.y};
  for (const Box& box : boxes) {
    result.x = std::max(result.x, box.high.x - box.low.x);
    result.y = std::max(result.y, box.high.y - box.low.y);
    result.lowest_y = std::min(result.lowest_y, box.low.y);
  }
  return result;
}

}  // namespace

/// The boxes of `second` are sorted into strips of y as high as the highest of them, and by x within a strip. A box
/// meets only boxes that begin in the strips that it touches or in the one below them.
std::vector<std::pair<std::uint32_t, std::uint32_t>> overlapping_pairs(std::span<const Box> first,
                                                                       std::span<const Box> second) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  if (first.empty() || second.empty()) return pairs;
  constexpr double most_strips = 1e6;
  const Extents widest = extents(second);
  const double strip_height = std::max(widest.y * 1.001, 1e-9);  // a margin for rounding
  const auto strip = [&](double y) {
    return static_cast<int>(std::clamp(std::floor((y - widest.lowest_y) / strip_height), -2.0, most_strips));
  };
  std::vector<Placed> placed;
  for (std::uint32_t j = 0; j < second.size(); ++j) placed.push_back({strip(second[j].low.y), second[j], j});
  const auto before = [](const Placed& a, const Placed& b) {
    if (a.strip != b.strip) return a.strip < b.strip;
    return a.box.low.x != b.box.low.x ? a.box.low.x < b.box.low.x : a.index < b.index;
  };
  std::sort(placed.begin(), placed.end(), before);
  const double reach = widest.x * 1.001;
  for (std::uint32_t i = 0; i < first.size(); ++i) {
    const Box& box = first[i];
    for (int s = strip(box.low.y) - 1; s <= strip(box.high.y); ++s) {
      Placed least{s, {}, 0};
      least.box.low.x = box.low.x - reach;
      for (auto at = std::lower_bound(placed.begin(), placed.end(), least, before);
           at != placed.end() && at->strip == s && at->box.low.x <= box.high.x; ++at) {
        if (overlap(box, at->box)) pairs.emplace_back(i, at->index);
      }
    }
  }
  return pairs;
}

}  // namespace tightrope::ccd
