#pragma once
/// Queries of all sorts for the tests of what runs on a GPU.

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "scenes/scene.h"
#include "tests/stability/query_folder.h"
#include "tightrope/batch.h"
#include "tightrope/plain.h"

namespace tightrope::ccd::gpu {

inline constexpr std::size_t numbers = 24;

/// Typical and degenerate queries, contacts once missed, and numbers that are none; by coordinate too.
template <class Real>
struct Sample {
  Sample(Kind k, std::size_t queries_a_scene) : kind(k) {
    for (const Scene scene : {Scene::cloth_fold, Scene::degenerate_families, Scene::tiny, Scene::huge}) {
      std::vector<double> points(queries_a_scene * numbers);
      generate(scene, kind, queries_a_scene, 5)->fill(points);
      together.insert(together.end(), points.begin(), points.end());
    }
    const auto hard = queries_below(TIGHTROPE_SOURCE_DIR "/tests/data/hard")[kind == Kind::vertex_face ? 0 : 1];
    together.insert(together.end(), hard.points.begin(), hard.points.end());
    std::mt19937_64 random(1);
    for (std::size_t q = 0; q < 40; ++q) {
      together.insert(together.end(), numbers, q % 3 == 0 ? Real(0) : Real(q));  // four points that are one
      if (q % 3 == 1) together[together.size() - 1 - random() % numbers] = std::numeric_limits<Real>::quiet_NaN();
      if (q % 3 == 2) together[together.size() - 1 - random() % numbers] = std::numeric_limits<Real>::infinity();
    }
    pitch = count() + 3;
    apart.resize(pitch * numbers);
    for (std::size_t i = 0; i < together.size(); ++i) apart[i % numbers * pitch + i / numbers] = together[i];
  }
  std::size_t count() const { return together.size() / numbers; }
  Queries<Real> queries(Layout layout) const {
    return {kind, count(), layout == Layout::by_query ? together.data() : apart.data(), layout, pitch};
  }
  std::vector<unsigned char> answers(Method method) const {
    std::vector<unsigned char> all(count());
    ccd::collides(kind, together.data(), count(), all.data(), method);
    return all;
  }

  Kind kind;
  std::vector<Real> together, apart;
  std::size_t pitch = 0;
};

}  // namespace tightrope::ccd::gpu
