/// No false negative of a conservative method on any scene. TIGHTROPE_STABILITY_QUERIES sets the number of queries a
/// kind, TIGHTROPE_SURVEY_QUERIES that of the survey's scenes.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <tuple>
#include <vector>

#include "scenes/scene.h"
#include "scenes/truth.h"
#include "tests/stability/show_query.h"

namespace tightrope::ccd {
namespace {

/// Of each kind.
std::size_t number_of_queries(Scene scene) {
  const auto info =
      std::find_if(scenes().begin(), scenes().end(), [&](const SceneInfo& s) { return s.scene == scene; });
  const char* text = std::getenv(info->survey ? "TIGHTROPE_SURVEY_QUERIES" : "TIGHTROPE_STABILITY_QUERIES");
  if (text != nullptr) return std::strtoull(text, nullptr, 10);
  return info->survey ? 4000 : 20000;
}

class Conservative : public testing::TestWithParam<std::tuple<Scene, Kind>> {};

TEST_P(Conservative, NoFalseNegative) {
  const auto [scene, kind] = GetParam();
  const std::size_t total = number_of_queries(scene);
  ASSERT_GT(total, 0U);
  constexpr std::uint64_t seed = 20240607;
  const auto generator = generate(scene, kind, total, seed);
  std::vector<double> points;
  std::vector<unsigned char> truths;
  std::vector<unsigned char> answers;
  std::size_t contacts = 0;
  std::vector<std::size_t> false_positives(methods().size());
  int shown = 0;
  for (std::size_t done = 0; done < total; done += truths.size()) {
    const std::size_t count = std::min<std::size_t>(16384, total - done);
    points.resize(24 * count);
    truths.resize(count);
    answers.resize(count);
    generator->fill(points);
    exact_truths(kind, points, truths);
    contacts += static_cast<std::size_t>(std::count(truths.begin(), truths.end(), 1));
    for (std::size_t m = 0; m < methods().size(); ++m) {
      if (!methods()[m].conservative) continue;
      collides(kind, points.data(), count, answers.data(), methods()[m].method);
      for (std::size_t i = 0; i < count; ++i) {
        false_positives[m] += answers[i] > truths[i] ? 1 : 0;
        if (answers[i] >= truths[i] || ++shown > 5) continue;
        ADD_FAILURE() << methods()[m].name << " misses " << name(kind) << " query " << done + i << " of " << name(scene)
                      << ", seed " << seed << ":\n"
                      << show_query(points.data() + 24 * i);
      }
    }
  }
  EXPECT_GT(contacts, 0U) << "a test without contacts shows nothing";
  std::printf("%s %s: %zu queries, %zu contacts; false positives:", name(scene).data(), name(kind).data(), total,
              contacts);
  for (std::size_t m = 0; m < methods().size(); ++m) {
    if (methods()[m].conservative) std::printf(" %s %zu", methods()[m].name.data(), false_positives[m]);
  }
  std::printf("\n");
}

/// What the test above is worth: the same algorithm with its error bounds dropped is caught in these scenes.
TEST(ConservativeTest, WouldCatchAMethodWithoutErrorBounds) {
  constexpr std::size_t count = 3000;
  for (const Scene scene : {Scene::grazing, Scene::degenerate, Scene::tangent, Scene::needles, Scene::tiny, Scene::huge,
                            Scene::far, Scene::single, Scene::through_vertex, Scene::through_edge, Scene::rotation,
                            Scene::displacements, Scene::offsets}) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      std::vector<double> points(24 * count);
      std::vector<unsigned char> truths(count);
      std::vector<unsigned char> answers(count);
      generate(scene, kind, count, 1)->fill(points);
      exact_truths(kind, points, truths);
      collides(kind, points.data(), count, answers.data(), Method::bsc_float);
      std::size_t missed = 0;
      for (std::size_t i = 0; i < count; ++i) missed += answers[i] < truths[i] ? 1 : 0;
      std::printf("%s %s: %zu missed\n", name(scene).data(), name(kind).data(), missed);
      EXPECT_GT(missed, 5U) << name(scene) << " " << name(kind);
    }
  }
}

std::vector<Scene> every_scene() {
  std::vector<Scene> all;
  for (const SceneInfo& info : scenes()) all.push_back(info.scene);
  return all;
}

std::string test_name(const testing::TestParamInfo<std::tuple<Scene, Kind>>& info) {
  std::string text = std::string(name(std::get<0>(info.param))) + "_" + std::string(name(std::get<1>(info.param)));
  std::replace(text.begin(), text.end(), '-', '_');
  return text;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Conservative,
                         testing::Combine(testing::ValuesIn(every_scene()),
                                          testing::Values(Kind::vertex_face, Kind::edge_edge)),
                         test_name);

}  // namespace
}  // namespace tightrope::ccd
