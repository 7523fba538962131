#pragma once
/// Two square sheets of triangles that fold over each other and pass through one another: what a cloth simulation hands
/// to its continuous collision detection. The queries are the survivors of a broad phase: pairs of features without a
/// common vertex whose boxes, swept over the time step, overlap.
/// Variants differ in size and place, and in whether the second sheet is an obstacle at rest: then the queries are
/// those of the first sheet's vertices and edges with the obstacle's faces and edges.

#include <cstddef>
#include <cstdint>
#include <memory>

#include "scenes/scene.h"

namespace tightrope::ccd {

struct ClothVariant {
  double size = 1;        ///< of a sheet, in units of length
  double distance = 0;    ///< from the origin, about, in each coordinate
  bool obstacle = false;  ///< the second sheet is at rest
};

std::unique_ptr<SceneGenerator> generate_cloth_fold(Kind kind, std::size_t queries, std::uint64_t seed,
                                                    const ClothVariant& variant = {});

}  // namespace tightrope::ccd
