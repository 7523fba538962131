#include "scenes/broad_phase.h"

#include <algorithm>
#include <numeric>

namespace tightrope::ccd {
namespace {

std::vector<std::uint32_t> sorted_by_low_x(std::span<const Box> boxes) {
  std::vector<std::uint32_t> order(boxes.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return boxes[a].low.x != boxes[b].low.x ? boxes[a].low.x < boxes[b].low.x : a < b;
  });
  return order;
}

bool overlap(const Box& a, const Box& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> overlapping_pairs(std::span<const Box> first,
                                                                       std::span<const Box> second) {
  const std::vector<std::uint32_t> first_order = sorted_by_low_x(first);
  const std::vector<std::uint32_t> second_order = sorted_by_low_x(second);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  std::vector<std::uint32_t> active;  // boxes of `second` begun and perhaps not ended
  std::size_t next = 0;
  double widest = 0;  // a box of `first` meets only boxes of `second` that begin before it ends
  for (const Box& box : first) widest = std::max(widest, box.high.x - box.low.x);
  for (const std::uint32_t i : first_order) {
    const Box& box = first[i];
    while (next < second_order.size() && second[second_order[next]].low.x <= box.low.x + widest) {
      active.push_back(second_order[next++]);
    }
    std::erase_if(active, [&](std::uint32_t j) { return second[j].high.x < box.low.x; });
    for (const std::uint32_t j : active) {
      if (overlap(box, second[j])) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

}  // namespace tightrope::ccd
