#include "scenes/survey.h"

#include <array>
#include <cmath>
#include <utility>

namespace tightrope::ccd {
namespace {

/// Renames corners of the face, ends of the edges, and the edges.
void permute_points(Kind kind, Random& random, Query& query) {
  const auto swap_points = [&](std::size_t i, std::size_t j) {
    std::swap(query.start[i], query.start[j]);
    std::swap(query.end[i], query.end[j]);
  };
  if (kind == Kind::vertex_face) {
    for (const std::size_t i : {2U, 3U})
      swap_points(i, static_cast<std::size_t>(random.integer(1, static_cast<int>(i))));
    return;
  }
  if (random.chance(0.5)) swap_points(0, 1);
  if (random.chance(0.5)) swap_points(2, 3);
  if (random.chance(0.5)) {
    swap_points(0, 2);
    swap_points(1, 3);
  }
}

using Coordinate = double Point::*;
constexpr std::array<Coordinate, 3> axes = {&Point::x, &Point::y, &Point::z};

template <class Change>
void for_each_point(Query& query, Change change) {
  for (auto* points : {&query.start, &query.end}) {
    for (Point& point : *points) change(point);
  }
}

/// Exchanges and reflects axes: exact for all coordinates.
void turn_axes(Random& random, Query& query) {
  std::array<int, 3> order = {0, 1, 2};
  for (const std::size_t i : {1U, 2U})
    std::swap(order[i], order[static_cast<std::size_t>(random.integer(0, static_cast<int>(i)))]);
  std::array<double, 3> sign{};
  for (double& s : sign) s = random.chance(0.5) ? 1 : -1;
  for_each_point(query, [&](Point& point) {
    const Point old = point;
    for (std::size_t i = 0; i < 3; ++i) point.*axes[i] = sign[i] * old.*axes[static_cast<std::size_t>(order[i])];
  });
}

/// Two shears with factors -1, 0, 1: coordinates grow to at most three times their size.
void shear(Random& random, Query& query) {
  for (int i = 0; i < 2; ++i) {
    const auto to = static_cast<std::size_t>(random.integer(0, 2));
    const std::size_t from = (to + static_cast<std::size_t>(random.integer(1, 2))) % 3;
    const double factor = random.integer(-1, 1);
    for_each_point(query, [&](Point& point) { point.*axes[to] += factor * point.*axes[from]; });
  }
}

/// Another origin at each end of the step.
void translate_ends(Random& random, Query& query) {
  for (auto* points : {&query.start, &query.end}) {
    Point by;
    by.x = random.integer(-7, 7);
    by.y = random.integer(-7, 7);
    by.z = random.integer(-7, 7);
    for (Point& point : *points) point = point + by;
  }
}

/// To 1e2 .. 1e8 sizes of the query from the origin.
void translate_far(Random& random, Query& query) {
  Point by;
  by.x = std::floor(random.magnitude(7, 26));
  by.y = std::floor(random.magnitude(7, 26));
  by.z = std::floor(random.magnitude(7, 26));
  for (int i = 0; i < 4; ++i) query.translate(i, by);
}

struct Family {
  Scene scene;
  Constructed (*make)(Construction);
};
constexpr std::array<Family, 12> families = {{
    {Scene::coplanar, coplanar},
    {Scene::sliding, sliding},
    {Scene::through_vertex, through_vertex},
    {Scene::through_edge, through_edge},
    {Scene::parallel_edges, parallel_edges},
    {Scene::zero_area, zero_area},
    {Scene::zero_length, zero_length},
    {Scene::double_root, double_root},
    {Scene::triple_root, triple_root},
    {Scene::step_ends, step_ends},
    {Scene::rotation, rotation},
    {Scene::at_rest, at_rest},
}};

/// Coordinates below 2^5 that are multiples of 2^-45 (of 2^-20 if `far`) stay exact.
Constructed map(Constructed made, Kind kind, Random& random, bool far) {
  permute_points(kind, random, made.query);
  if (random.chance(0.7)) shear(random, made.query);
  turn_axes(random, made.query);
  if (random.chance(0.7)) translate_ends(random, made.query);
  if (far) translate_far(random, made.query);
  if (random.chance(0.3)) {
    const int exponent = random.integer(-40, 40);
    for_each_coordinate(made.query, [&](double x) { return std::ldexp(x, exponent); });
  }
  return made;
}

}  // namespace

Constructed construct(Scene scene, Kind kind, Random& random) {
  std::size_t chosen = 0;
  while (chosen < families.size() && families[chosen].scene != scene) ++chosen;
  if (scene == Scene::degenerate_families) {  // all of them, displacements and offsets too
    chosen = static_cast<std::size_t>(random.integer(0, static_cast<int>(families.size()) + 1));
    if (chosen == families.size() + 1) scene = Scene::offsets;
  }
  const bool far = scene == Scene::offsets;
  if (far) chosen = static_cast<std::size_t>(random.integer(0, static_cast<int>(families.size()) - 1));
  if (chosen >= families.size()) {
    Constructed made = displacements(kind, random);
    permute_points(kind, random, made.query);
    turn_axes(random, made.query);
    return made;
  }
  constexpr int finest = 45;
  constexpr int finest_far = 20;
  return map(families[chosen].make(Construction(kind, random, far ? finest_far : finest)), kind, random, far);
}

}  // namespace tightrope::ccd
