#pragma once
/// Families of queries, each of them hard or typical in its own way.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "tightrope/ccd.h"

namespace tightrope::ccd {

enum class Scene {
  random,
  grazing,
  cloth_fold,
  lattice,
  degenerate,
  static_lattice,
  tangent,
  slow,
  near_coplanar,
  needles,
  tiny,
  huge,
  far,
  single,
  coplanar,
  sliding,
  through_vertex,
  through_edge,
  parallel_edges,
  zero_area,
  zero_length,
  double_root,
  triple_root,
  step_ends,
  rotation,
  at_rest,
  displacements,
  offsets,
  degenerate_families,
  cloth_obstacle,
  cloth_millimetre,
  terrain,
};

struct SceneInfo {
  Scene scene;
  std::string_view name;  ///< as the commands spell it
  std::string_view what;
  bool survey = false;  ///< of the survey of degenerate families (survey.h)
};

/// Every scene, in the order of the tables.
std::span<const SceneInfo> scenes();
std::optional<Scene> scene_by_name(std::string_view name);
std::string_view name(Scene scene);

/// A stream of finite queries, determined by scene, kind, number of queries and seed.
class SceneGenerator {
 public:
  SceneGenerator() = default;
  SceneGenerator(const SceneGenerator&) = delete;
  SceneGenerator& operator=(const SceneGenerator&) = delete;
  virtual ~SceneGenerator() = default;

  /// Fills `points` (24 doubles a query) with the next queries; how the stream is cut into calls makes no difference.
  virtual void fill(std::span<double> points) = 0;
};

/// `queries`: how many will be asked for; cloth-fold and its variants spread them over the motion.
std::unique_ptr<SceneGenerator> generate(Scene scene, Kind kind, std::size_t queries, std::uint64_t seed);

}  // namespace tightrope::ccd
