#pragma once
/// Two square sheets of triangles that fold over each other and pass through one another: what a cloth simulation hands
/// to its continuous collision detection. The queries are the survivors of a broad phase: pairs of features without a
/// common vertex whose boxes, swept over the time step, overlap.

#include <cstddef>
#include <cstdint>
#include <memory>

#include "scenes/scene.h"

namespace tightrope::ccd {

std::unique_ptr<SceneGenerator> generate_cloth_fold(Kind kind, std::size_t queries, std::uint64_t seed);

}  // namespace tightrope::ccd
