#pragma once
/// Queries for the tests of batches: of every scene, and numbers of every kind where coordinates should be.

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include "scenes/scene.h"

namespace tightrope::ccd::test {

inline constexpr std::size_t numbers = 24;

/// `count` queries of the scene.
inline std::vector<double> queries_of(Scene scene, Kind kind, std::size_t count, std::uint64_t seed) {
  std::vector<double> points(numbers * count);
  generate(scene, kind, count, seed)->fill(points);
  return points;
}

/// Makes coordinates infinite, NaN, subnormal, zero, huge or equal to others, or scales the whole query.
template <class Real>
void disturb(std::span<Real> query, std::mt19937_64& random) {
  using Limits = std::numeric_limits<Real>;
  const auto below = [&](std::uint64_t n) { return static_cast<std::size_t>(random() % n); };
  switch (below(8)) {
    case 0:
      query[below(numbers)] = Limits::quiet_NaN();
      break;
    case 1:
      query[below(numbers)] = below(2) == 0 ? Limits::infinity() : -Limits::infinity();
      break;
    case 2:
      query[below(numbers)] = below(2) == 0 ? Limits::max() : -Limits::max();
      break;
    case 3:
      query[below(numbers)] = Limits::denorm_min() * static_cast<Real>(below(9));
      break;
    case 4:
      query[below(numbers)] = query[below(numbers)];
      break;
    default: {
      const int range = Limits::max_exponent;
      const int exponent = static_cast<int>(below(static_cast<std::uint64_t>(2 * range))) - range;
      for (Real& x : query) x = std::ldexp(x, exponent);
      break;
    }
  }
}

/// Queries of every scene, `each` of each, a third of them disturbed; more than two chunks' worth, and no multiple of
/// any number of lanes.
template <class Real>
std::vector<Real> mixed_queries(Kind kind, std::size_t each, std::uint64_t seed) {
  std::vector<Real> points;
  std::mt19937_64 random(seed);
  for (const SceneInfo& info : scenes()) {
    for (const double x : queries_of(info.scene, kind, each, seed)) points.push_back(static_cast<Real>(x));
  }
  for (std::size_t i = 0; i < points.size() / numbers; i += 3) {
    disturb(std::span<Real>(points).subspan(numbers * i, numbers), random);
  }
  return points;
}

}  // namespace tightrope::ccd::test
