#include "stability/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace tightrope::ccd::stability {
namespace {

std::string map_name(const Map& map) { return fmt::format("{}, {}, {}", map.family, name(map.kind), name(map.real)); }

std::string cell_name(const Axes& axes, std::size_t cell, Real real) {
  const std::size_t scale = cell % axes.scales.size();
  const std::size_t distance = cell / axes.scales.size() % axes.distances.size();
  const std::size_t offset = cell / axes.scales.size() / axes.distances.size();
  return fmt::format("distance {}, scale 2^{}, offset {}", axes.distances[distance],
                     scale_exponent(axes.scales[scale], real), axes.offsets[offset]);
}

const MethodCounts* find(const Map& map, const std::string& method) {
  const auto found = std::find_if(map.methods.begin(), map.methods.end(),
                                  [&](const MethodCounts& counts) { return counts.method == method; });
  return found == map.methods.end() ? nullptr : &*found;
}

const Map* find(const Atlas& atlas, const Map& wanted) {
  const auto found = std::find_if(atlas.maps.begin(), atlas.maps.end(), [&](const Map& map) {
    return map.family == wanted.family && map.kind == wanted.kind && map.real == wanted.real;
  });
  return found == atlas.maps.end() ? nullptr : &*found;
}

std::uint64_t sum(const Counts& counts) { return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}); }

/// Adds the cells of a map that have become worse.
void compare(const Axes& axes, const Map& golden, const Map& now, std::vector<std::string>& worse) {
  if (golden.queries != now.queries || golden.contacts != now.contacts) {
    worse.push_back(map_name(golden) + ": other queries or another truth");
    return;
  }
  for (const MethodCounts& before : golden.methods) {
    const MethodCounts* after = find(now, before.method);
    if (after == nullptr) {
      worse.push_back(fmt::format("{}: no figures of {}", map_name(golden), before.method));
      continue;
    }
    for (std::size_t cell = 0; cell < before.false_alarms.size(); ++cell) {
      if (after->false_alarms[cell] <= before.false_alarms[cell]) continue;
      worse.push_back(fmt::format("{}, {}: {}: {} false alarms among {} queries, were {}", before.method,
                                  map_name(golden), cell_name(axes, cell, golden.real), after->false_alarms[cell],
                                  golden.queries[cell], before.false_alarms[cell]));
    }
  }
}

}  // namespace

std::vector<std::string> broken_promises(const Atlas& atlas) {
  std::vector<std::string> result;
  const auto tell = [&](const Map& map, const std::string& method, const char* what, std::uint64_t count) {
    if (count > 0) result.push_back(fmt::format("{}, {}: {} {}", method, map_name(map), count, what));
  };
  for (const Map& map : atlas.maps) {
    for (const AtlasMethod& method : atlas.methods) {
      const MethodCounts* counts = find(map, method.name);
      if (counts == nullptr) continue;
      if (method.conservative) tell(map, method.name, "misses", sum(counts->misses));
      if (method.exact) tell(map, method.name, "false alarms", sum(counts->false_alarms));
    }
  }
  return result;
}

std::vector<std::string> regressions(const Atlas& golden, const Atlas& now) {
  if (golden.axes != now.axes || golden.seed != now.seed || golden.queries != now.queries) {
    return {"another sweep: seed, number of queries or axes differ"};
  }
  std::vector<std::string> worse;
  for (const Map& before : golden.maps) {
    if (const Map* after = find(now, before)) {
      compare(golden.axes, before, *after, worse);
    } else {
      worse.push_back(map_name(before) + ": no such map");
    }
  }
  return worse;
}

}  // namespace tightrope::ccd::stability
