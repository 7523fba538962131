#include "codegen/charts/pareto.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace tightrope::charts {

std::vector<std::size_t> pareto_front(std::span<const Cost> costs) {
  std::vector<std::size_t> order(costs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(costs[a].first, costs[a].second, a) < std::tuple(costs[b].first, costs[b].second, b);
  });
  std::vector<std::size_t> front;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : order) {
    if (!(costs[i].second < least)) continue;
    least = costs[i].second;
    front.push_back(i);
  }
  return front;
}

}  // namespace tightrope::charts
