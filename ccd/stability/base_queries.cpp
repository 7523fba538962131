#include "stability/base_queries.h"

#include <algorithm>
#include <cmath>

#include "scenes/families.h"
#include "scenes/survey.h"

namespace tightrope::ccd::stability {
namespace {

bool is_mixture(Scene scene) { return scene == Scene::offsets || scene == Scene::degenerate_families; }

/// Of extent 1 .. 2, if a power of two makes it so without a coordinate changing otherwise.
Query normalized(const Query& query) {
  const double size = extent(query);
  if (!(size > 0) || !std::isfinite(size)) return query;
  const int exponent = -std::ilogb(size);
  bool exact = true;
  Query result = query;
  for_each_coordinate(result, [&](double x) {
    const double scaled = std::ldexp(x, exponent);
    exact &= std::ldexp(scaled, -exponent) == x;
    return scaled;
  });
  return exact ? result : query;
}

Constructed draw(Scene family, Kind kind, Random& random) {
  if (family == Scene::degenerate) return {degenerate_query(kind, random), std::nullopt};
  return construct(family, kind, random);
}

Query draw_touching(Scene family, Kind kind, Random& random) {
  while (true) {
    const Constructed made = draw(family, kind, random);
    if (family == Scene::degenerate || made.touches == true) return made.query;  // half of the survey's do
  }
}

}  // namespace

std::vector<Scene> families() {
  std::vector<Scene> result;
  for (const SceneInfo& info : scenes()) {
    if (info.scene == Scene::degenerate || (info.survey && !is_mixture(info.scene))) result.push_back(info.scene);
  }
  return result;
}

double extent(const Query& query) {
  double largest = 0;
  for (const auto* points : {&query.start, &query.end}) {
    for (const Point& p : *points) {
      for (const Point& q : *points) largest = std::max({largest, p.x - q.x, p.y - q.y, p.z - q.z});
    }
  }
  return largest;
}

std::vector<BaseQuery> base_queries(Scene family, Kind kind, std::size_t count, std::uint64_t seed) {
  const auto stream = 2 * static_cast<std::uint64_t>(family) + static_cast<std::uint64_t>(kind);
  Random random(derived_seed(seed, stream));
  std::vector<BaseQuery> result(count);
  for (BaseQuery& base : result) {
    base.as_made = normalized(draw(family, kind, random).query);
    base.touching = normalized(draw_touching(family, kind, random));
    for (double& u : base.directions) u = random.between(-1, 1);
    for (double& axis : base.offset) {
      const double size = 0.125 * random.integer(8, 15);
      axis = random.chance(0.5) ? size : -size;
    }
  }
  return result;
}

std::array<double, 24> placed(const BaseQuery& base, double distance, double offset) {
  const Query& query = distance > 0 ? base.touching : base.as_made;
  const double size = extent(query);
  const double step = distance * (size > 0 ? size : 1);
  std::array<double, 24> result{};
  std::size_t i = 0;
  for (const auto* points : {&query.start, &query.end}) {
    for (const Point& point : *points) {
      for (const double x : {point.x, point.y, point.z}) {
        const double there = x + offset * base.offset[i % 3];
        result[i] = there + step * base.directions[i];
        ++i;
      }
    }
  }
  return result;
}

}  // namespace tightrope::ccd::stability
