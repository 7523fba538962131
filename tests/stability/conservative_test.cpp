/// No false negative of a conservative method on any scene, no false positive of an exact one.
/// TIGHTROPE_STABILITY_QUERIES sets the number of queries a kind, TIGHTROPE_SURVEY_QUERIES that of the survey's scenes.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "scenes/scene.h"
#include "scenes/single_precision.h"
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

/// What conservative methods answered on one scene, in one type.
struct Tally {
  std::size_t queries = 0;
  std::size_t contacts = 0;
  std::vector<std::size_t> false_positives = std::vector<std::size_t>(methods().size());
  int shown = 0;

  /// Failures where a conservative method misses a contact, or an exact one reports none.
  template <class Real>
  void add(Kind kind, std::span<const Real> points, std::span<const unsigned char> truths, const char* type) {
    queries += truths.size();
    contacts += static_cast<std::size_t>(std::count(truths.begin(), truths.end(), 1));
    std::vector<unsigned char> answers(truths.size());
    for (std::size_t m = 0; m < methods().size(); ++m) {
      if (!methods()[m].conservative) continue;
      collides(kind, points.data(), truths.size(), answers.data(), methods()[m].method);
      for (std::size_t i = 0; i < truths.size(); ++i) {
        false_positives[m] += answers[i] > truths[i] ? 1 : 0;
        const bool may_differ = answers[i] > truths[i] && !methods()[m].exact;
        if (answers[i] == truths[i] || may_differ || ++shown > 5) continue;
        const std::vector<double> query(points.begin() + static_cast<std::ptrdiff_t>(24 * i),
                                        points.begin() + static_cast<std::ptrdiff_t>(24 * i + 24));
        ADD_FAILURE() << methods()[m].name << " in " << type << " answers " << (answers[i] != 0) << " to this "
                      << name(kind) << " query:\n"
                      << show_query(query.data());
      }
    }
  }

  void print(Scene scene, Kind kind, const char* type) const {
    EXPECT_GT(contacts, 0U) << "a test without contacts shows nothing";
    std::printf("%s %s %s: %zu queries, %zu contacts; false positives:", name(scene).data(), name(kind).data(), type,
                queries, contacts);
    for (std::size_t m = 0; m < methods().size(); ++m) {
      if (methods()[m].conservative) std::printf(" %s %zu", methods()[m].name.data(), false_positives[m]);
    }
    std::printf("\n");
  }
};

class Conservative : public testing::TestWithParam<std::tuple<Scene, Kind>> {};

/// In double, and every third block rounded to float, where contact is decided anew.
TEST_P(Conservative, NoFalseNegative) {
  const auto [scene, kind] = GetParam();
  const std::size_t total = number_of_queries(scene);
  ASSERT_GT(total, 0U);
  constexpr std::uint64_t seed = 20240607;
  const auto generator = generate(scene, kind, total, seed);
  QueryBlock block;
  block.kind = kind;
  Tally in_double, in_float;
  std::size_t number = 0;
  for (std::size_t done = 0; done < total; done += block.size()) {
    const std::size_t count = std::min<std::size_t>(std::min<std::size_t>(16384, total / 3 + 1), total - done);
    block.points.resize(24 * count);
    block.truths.resize(count);
    generator->fill(block.points);
    exact_truths(kind, block.points, block.truths);
    in_double.add<double>(kind, block.points, block.truths, "double");
    if (number++ % 3 != 0) continue;
    const SingleBlock single = in_single_precision(block, true);
    in_float.add<float>(kind, single.points, single.truths, "float");
  }
  in_double.print(scene, kind, "double");
  in_float.print(scene, kind, "float");
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
