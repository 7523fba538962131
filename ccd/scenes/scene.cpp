#include "scenes/scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/cloth_fold.h"
#include "scenes/families.h"
#include "scenes/survey.h"

namespace tightrope::ccd {
namespace {

constexpr std::array<SceneInfo, 32> all_scenes = {{
    {Scene::random, "random", "coordinates uniform in [-1, 1]"},
    {Scene::grazing, "grazing", "a vertex or an edge passes within 1e-16 .. 1e-3 of an edge, a vertex or an end"},
    {Scene::cloth_fold, "cloth-fold", "two folding sheets, pairs that survive a broad phase"},
    {Scene::lattice, "lattice", "small integer coordinates, contacts in degenerate position"},
    {Scene::degenerate, "degenerate", "coincident, collinear and coplanar points, contact at t = 0, 1/2 or 1"},
    {Scene::static_lattice, "static-lattice", "lattice, most points at rest"},
    {Scene::tangent, "tangent", "almost double roots: relative motion along the contact plane"},
    {Scene::slow, "slow", "displacements of 2^-50 .. 2^-6"},
    {Scene::near_coplanar, "near-coplanar", "all points within 2^-60 .. 2^-10 of a moving plane"},
    {Scene::needles, "needles", "triangles of width 2^-40 .. 2^-4, almost parallel edges"},
    {Scene::tiny, "tiny", "a mixture of the others at scales 2^-345 .. 2^-20"},
    {Scene::huge, "huge", "the mixture at scales 2^20 .. 2^1000"},
    {Scene::far, "far", "the mixture at distances of 1e2 .. 1e12 from the origin"},
    {Scene::single, "single", "the mixture rounded to float32 values"},
    {Scene::coplanar, "coplanar", "motion in one plane, past a corner: touching it, or not by a margin", true},
    {Scene::sliding, "sliding", "a vertex or an end slides along the line of an edge, up to its end or beside it",
     true},
    {Scene::through_vertex, "through-vertex", "a vertex or an end passes through another one, or beside it", true},
    {Scene::through_edge, "through-edge", "a vertex or an end passes through an edge in a plane, or beside it", true},
    {Scene::parallel_edges, "parallel-edges",
     "parallel edges meet at an end, overlap or miss; a vertex at a side's end", true},
    {Scene::zero_area, "zero-area", "flat faces, needles; edges on one line or almost parallel", true},
    {Scene::zero_length, "zero-length", "edges and sides of length zero, for the whole step or at t = 0", true},
    {Scene::double_root, "double-root", "coplanar twice at one time, or almost", true},
    {Scene::triple_root, "triple-root", "coplanar three times at one time, touching at a side or end, or not", true},
    {Scene::step_ends, "step-ends", "contact at t = 0 or at t = 1 exactly, or short of it", true},
    {Scene::rotation, "rotation", "a feature turns by 60 .. 180 degrees, the coplanarity has an inflection", true},
    {Scene::at_rest, "at-rest", "nothing moves; touching, or not by a margin", true},
    {Scene::displacements, "displacements", "points that move by 1e-300 .. 1e150 past features of size 1", true},
    {Scene::offsets, "offsets", "the families above at 1e2 .. 1e8 lengths from the origin", true},
    {Scene::degenerate_families, "degenerate-families", "a mixture of coplanar .. offsets", true},
    {Scene::cloth_obstacle, "cloth-obstacle", "a folding sheet passes through a sheet at rest, after a broad phase"},
    {Scene::cloth_millimetre, "cloth-millimetre", "cloth-fold with sheets of 10 mm, in metres"},
    {Scene::terrain, "terrain", "cloth-obstacle with sheets of 1 km, in metres, 10 km from the origin"},
}};

Query static_lattice_query(Random& random) {
  Query query = lattice_query(random, 3);
  for (std::size_t i = 0; i < 4; ++i) {
    if (random.chance(0.7)) query.end[i] = query.start[i];
  }
  return query;
}

Query scaled_query(Kind kind, Random& random, int low, int high) {
  Query query = mixed_query(kind, random);
  const int exponent = random.integer(low, high);
  for_each_coordinate(query, [&](double x) { return std::ldexp(x, exponent); });
  return query;
}

Query far_query(Kind kind, Random& random) {
  Query query = mixed_query(kind, random);
  Point offset;
  offset.x = random.magnitude(7, 39);
  offset.y = random.magnitude(7, 39);
  offset.z = random.magnitude(7, 39);
  for (int i = 0; i < 4; ++i) query.translate(i, offset);
  return query;
}

Query single_query(Kind kind, Random& random) {
  Query query = mixed_query(kind, random);
  for_each_coordinate(query, [](double x) -> double {
    volatile float rounded = static_cast<float>(x);  // g++ 12 -O3 drops this rounding of some coordinates otherwise
    return rounded;
  });
  return query;
}

Query make_query(Scene scene, Kind kind, Random& random) {
  switch (scene) {
    case Scene::random:
      return random_query(random);
    case Scene::grazing:
      return grazing_query(kind, random);
    case Scene::cloth_fold:
    case Scene::cloth_obstacle:
    case Scene::cloth_millimetre:
    case Scene::terrain:
      break;  // not query by query
    case Scene::lattice:
      return lattice_query(random, 4);
    case Scene::degenerate:
      return degenerate_query(kind, random);
    case Scene::static_lattice:
      return static_lattice_query(random);
    case Scene::tangent:
      return tangent_query(kind, random);
    case Scene::slow:
      return slow_query(kind, random);
    case Scene::near_coplanar:
      return near_coplanar_query(kind, random);
    case Scene::needles:
      return needle_query(kind, random);
    case Scene::tiny:
      return scaled_query(kind, random, -345, -20);
    case Scene::huge:
      return scaled_query(kind, random, 20, 1000);
    case Scene::far:
      return far_query(kind, random);
    case Scene::single:
      return single_query(kind, random);
    case Scene::coplanar:
    case Scene::sliding:
    case Scene::through_vertex:
    case Scene::through_edge:
    case Scene::parallel_edges:
    case Scene::zero_area:
    case Scene::zero_length:
    case Scene::double_root:
    case Scene::triple_root:
    case Scene::step_ends:
    case Scene::rotation:
    case Scene::at_rest:
    case Scene::displacements:
    case Scene::offsets:
    case Scene::degenerate_families:
      return construct(scene, kind, random).query;
  }
  return {};
}

std::optional<ClothVariant> cloth_variant(Scene scene) {
  if (scene == Scene::cloth_fold) return ClothVariant{};
  if (scene == Scene::cloth_obstacle) return ClothVariant{.size = 1, .distance = 0, .obstacle = true};
  if (scene == Scene::cloth_millimetre) return ClothVariant{.size = 0.01, .distance = 0, .obstacle = false};
  if (scene == Scene::terrain) return ClothVariant{.size = 1000, .distance = 10'000, .obstacle = true};
  return std::nullopt;
}

class QueryByQuery final : public SceneGenerator {
 public:
  QueryByQuery(Scene scene, Kind kind, std::uint64_t seed) : scene_(scene), kind_(kind), random_(seed) {}

  void fill(std::span<double> points) override {
    for (auto out = points.begin(); out != points.end();) {
      const Query query = make_query(scene_, kind_, random_);
      for (const auto* side : {&query.start, &query.end}) {
        for (const Point& point : *side) {
          *out++ = point.x;
          *out++ = point.y;
          *out++ = point.z;
        }
      }
    }
  }

 private:
  Scene scene_;
  Kind kind_;
  Random random_;
};

}  // namespace

std::span<const SceneInfo> scenes() { return all_scenes; }

std::optional<Scene> scene_by_name(std::string_view name) {
  const auto found = std::find_if(all_scenes.begin(), all_scenes.end(), [&](const auto& s) { return s.name == name; });
  if (found == all_scenes.end()) return std::nullopt;
  return found->scene;
}

std::string_view name(Scene scene) {
  const auto found =
      std::find_if(all_scenes.begin(), all_scenes.end(), [&](const auto& s) { return s.scene == scene; });
  return found == all_scenes.end() ? std::string_view{} : found->name;
}

std::unique_ptr<SceneGenerator> generate(Scene scene, Kind kind, std::size_t queries, std::uint64_t seed) {
  const auto stream = 2 * static_cast<std::uint64_t>(scene) + static_cast<std::uint64_t>(kind);
  if (const auto variant = cloth_variant(scene)) {
    return generate_cloth_fold(kind, queries, derived_seed(seed, stream), *variant);
  }
  return std::make_unique<QueryByQuery>(scene, kind, derived_seed(seed, stream));
}

}  // namespace tightrope::ccd
