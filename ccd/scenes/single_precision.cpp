#include "scenes/single_precision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "scenes/truth.h"

namespace tightrope::ccd {

SingleBlock in_single_precision(const QueryBlock& block, bool truth_known) {
  SingleBlock single;
  single.points.reserve(block.points.size());
  std::vector<double> changed_points;
  std::vector<std::size_t> changed;  // their places among those that are kept
  std::array<float, coordinates_per_query> rounded{};
  for (std::size_t i = 0; i < block.size(); ++i) {
    const auto points = std::span(block.points).subspan(coordinates_per_query * i, coordinates_per_query);
    std::transform(points.begin(), points.end(), rounded.begin(), [](double x) { return static_cast<float>(x); });
    if (!std::all_of(rounded.begin(), rounded.end(), [](float x) { return std::isfinite(x); })) {
      ++single.left_out;
      continue;
    }
    const bool same = std::equal(points.begin(), points.end(), rounded.begin(),
                                 [](double x, float y) { return x == static_cast<double>(y); });
    if (!same) {
      changed.push_back(single.points.size() / coordinates_per_query);
      changed_points.insert(changed_points.end(), rounded.begin(), rounded.end());
    }
    single.points.insert(single.points.end(), rounded.begin(), rounded.end());
    if (truth_known) single.truths.push_back(block.truths[i]);
  }
  single.changed = changed.size();
  if (!truth_known) return single;
  std::vector<unsigned char> truths(changed.size());
  exact_truths(block.kind, changed_points, truths);
  for (std::size_t i = 0; i < changed.size(); ++i) single.truths[changed[i]] = truths[i];
  return single;
}

}  // namespace tightrope::ccd
