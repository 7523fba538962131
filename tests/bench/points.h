#pragma once
/// Point sets for the benchmark of classical predicates: generic, and as close to a zero of the predicate as rounded
/// coordinates come.

#include <cmath>
#include <random>
#include <vector>

namespace tightrope::bench {

/// `calls` tuples of `points` points with three coordinates each, tuple after tuple.
struct PointTuples {
  int points = 0;
  std::vector<double> coordinates;
  std::size_t size() const { return coordinates.size() / (3 * static_cast<std::size_t>(points)); }
  const double* operator()(std::size_t tuple, int point) const {
    return &coordinates[3 * (tuple * static_cast<std::size_t>(points) + static_cast<std::size_t>(point))];
  }
};

/// Coordinates uniform in [0, 1).
inline PointTuples random_points(int points, std::size_t calls, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  PointTuples tuples{points, std::vector<double>(3 * static_cast<std::size_t>(points) * calls)};
  for (double& x : tuples.coordinates) x = uniform(random);
  return tuples;
}

/// Four points; the last is an affine combination of the others, rounded: within an ulp of their plane.
inline PointTuples near_coplanar_points(std::size_t calls, unsigned seed) {
  PointTuples tuples = random_points(4, calls, seed);
  std::mt19937_64 random(seed + 1);
  std::uniform_real_distribution<double> weight(-1, 1);
  for (std::size_t i = 0; i < calls; ++i) {
    const double s = weight(random), t = weight(random);
    double* d = &tuples.coordinates[12 * i + 9];
    for (int k = 0; k < 3; ++k) {
      const double a = tuples(i, 0)[k], b = tuples(i, 1)[k], c = tuples(i, 2)[k];
      d[k] = a + s * (b - a) + t * (c - a);
    }
  }
  return tuples;
}

/// Five points on a sphere of radius 1/2 around (1/2, 1/2, 1/2), each coordinate rounded.
inline PointTuples near_cospherical_points(std::size_t calls, unsigned seed) {
  PointTuples tuples{5, std::vector<double>(15 * calls)};
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < 5 * calls; ++i) {
    const double v[3] = {normal(random), normal(random), normal(random)};
    const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (std::size_t k = 0; k < 3; ++k) tuples.coordinates[3 * i + k] = 0.5 + 0.5 * (v[k] / length);
  }
  return tuples;
}

}  // namespace tightrope::bench
