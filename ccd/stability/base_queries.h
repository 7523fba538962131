#pragma once
/// The degenerate queries that a map of the atlas starts from.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scenes/point.h"
#include "scenes/random.h"
#include "scenes/scene.h"
#include "tightrope/ccd.h"

namespace tightrope::ccd::stability {

/// The families of degenerate queries: `degenerate` and those of the survey that are no mixtures.
std::vector<Scene> families();

/// The largest difference of coordinates of two of a query's points at the same end of the step.
double extent(const Query& query);

/// A degenerate query and the path on which it leaves its degeneracy: the same directions for all distances, offsets
/// and scales.
struct BaseQuery {
  /// As the scene makes it: touching as narrowly as can be, or missing by 2^-45 .. 2^-10 of its size, all else being
  /// degenerate.
  Query as_made;
  /// Touching in all of the survey's families; perturbed, it is as far from touching as it was moved. The extent of
  /// both is in [1, 2), but for those whose coordinates would not survive that, or that are one point.
  Query touching;
  std::array<double, 24> directions{};  ///< of the coordinates, in [-1, 1)
  std::array<double, 3> offset{};       ///< in units of the offset: multiples of 1/8 in [1, 2), of either sign
};

/// `count` of them, determined by family, kind and seed.
std::vector<BaseQuery> base_queries(Scene family, Kind kind, std::size_t count, std::uint64_t seed);

/// The 24 coordinates of the query moved by `distance` extents and `offset`, each step rounded to the nearest double.
/// At distance 0 it is the query as made.
std::array<double, 24> placed(const BaseQuery& base, double distance, double offset);

}  // namespace tightrope::ccd::stability
