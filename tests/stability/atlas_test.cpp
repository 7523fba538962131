/// The stability atlas: a small one against its golden, and what the comparison itself is worth.
///
///     TIGHTROPE_UPDATE_GOLDEN=1 ctest --test-dir build/release -R stability.Atlas
///
/// renews the golden: when false alarms have become fewer, a method has joined, or the families have changed.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "stability/atlas_json.h"
#include "stability/base_queries.h"
#include "stability/comparison.h"
#include "stability/sweep.h"

namespace tightrope::ccd::stability {
namespace {

constexpr const char* golden_path = TIGHTROPE_SOURCE_DIR "/tests/data/stability/small.json";

/// All methods, both kinds and types.
SweepResult swept(const std::vector<Scene>& scenes) {
  SweepRequest request{.families = scenes,
                       .kinds = {Kind::vertex_face, Kind::edge_edge},
                       .methods = {},
                       .reals = {Real::in_double, Real::in_float},
                       .axes = small_axes(),
                       .queries = 10,
                       .seed = 1};
  for (const MethodInfo& info : methods()) request.methods.push_back(info.method);
  return *sweep(request, [](std::uint64_t, std::uint64_t) { return true; });
}

const SweepResult& small_sweep() {
  static const SweepResult result = swept(families());
  return result;
}
const Atlas& small_atlas() { return small_sweep().atlas; }

/// Enough to see what a comparison does.
const Atlas& tiny_atlas() {
  static const SweepResult result = swept({Scene::sliding, Scene::zero_area});
  return result.atlas;
}

MethodCounts& counts(Map& map, const std::string& method) {
  return *std::find_if(map.methods.begin(), map.methods.end(), [&](const auto& m) { return m.method == method; });
}

std::string lines(const std::vector<std::string>& all) {
  std::string text;
  for (const std::string& line : all) text += line + "\n";
  return text;
}

TEST(Atlas, SoundMethodsMissNothingAndExactOnesClaimNothing) {
  EXPECT_EQ(lines(broken_promises(small_atlas())), "");
  EXPECT_TRUE(small_sweep().broken.empty());
}

/// What the test above is worth: the method without bounds, were it to promise what others do, is caught.
TEST(Atlas, CatchesAMethodWithoutErrorBounds) {
  Atlas atlas = small_atlas();
  ASSERT_EQ(atlas.methods.front().name, "bsc-float");
  atlas.methods.front().conservative = true;
  EXPECT_GT(broken_promises(atlas).size(), 10U) << "maps with misses of bsc-float";
}

TEST(Atlas, NoCellHasMoreFalseAlarmsThanItsGolden) {
  if (std::getenv("TIGHTROPE_UPDATE_GOLDEN") != nullptr) {
    std::ofstream(golden_path, std::ios::binary) << to_json(small_atlas());
    return;
  }
  std::ifstream file(golden_path, std::ios::binary);
  const auto golden = atlas_from_json(std::string(std::istreambuf_iterator<char>(file), {}));
  ASSERT_TRUE(std::holds_alternative<Atlas>(golden)) << golden_path << ": " << std::get<NoAtlas>(golden).message;
  EXPECT_EQ(lines(regressions(std::get<Atlas>(golden), small_atlas())), "");
}

TEST(Atlas, OneFalseAlarmMoreInOneCellIsARegression) {
  Atlas golden = tiny_atlas();
  MethodCounts& tight = counts(golden.maps.at(1), "tight");
  const auto some = std::find_if(tight.false_alarms.begin(), tight.false_alarms.end(), [](auto n) { return n > 0; });
  ASSERT_NE(some, tight.false_alarms.end());
  *some -= 1;
  const auto found = regressions(golden, tiny_atlas());
  ASSERT_EQ(found.size(), 1U) << lines(found);
  EXPECT_EQ(found.front().substr(0, 12), "tight, " + golden.maps[1].family.substr(0, 5)) << found.front();
}

TEST(Atlas, FewerFalseAlarmsAreNoRegression) {
  Atlas golden = tiny_atlas();
  for (Map& map : golden.maps) {
    for (std::uint32_t& count : counts(map, "tight").false_alarms) count += 1;
  }
  EXPECT_EQ(lines(regressions(golden, tiny_atlas())), "");
}

TEST(Atlas, AnotherTruthIsARegression) {
  Atlas golden = tiny_atlas();
  golden.maps.at(3).contacts.back() += 1;
  EXPECT_EQ(regressions(golden, tiny_atlas()).size(), 1U);
}

TEST(Atlas, WhatIsGoneIsARegressionWhatIsNewIsNone) {
  Atlas less = tiny_atlas();
  less.maps.pop_back();
  less.maps.front().methods.pop_back();
  EXPECT_EQ(regressions(tiny_atlas(), less).size(), 2U);
  EXPECT_EQ(lines(regressions(less, tiny_atlas())), "");
}

TEST(Atlas, AnotherSweepCannotBeCompared) {
  Atlas other = tiny_atlas();
  other.seed += 1;
  EXPECT_EQ(regressions(other, tiny_atlas()).size(), 1U);
}

TEST(Atlas, ReadsWhatItWrites) {
  const std::string text = to_json(tiny_atlas());
  const auto read = atlas_from_json(text);
  ASSERT_TRUE(std::holds_alternative<Atlas>(read)) << std::get<NoAtlas>(read).message;
  EXPECT_EQ(to_json(std::get<Atlas>(read)), text);
  EXPECT_TRUE(std::holds_alternative<NoAtlas>(atlas_from_json("{}")));
  EXPECT_TRUE(std::holds_alternative<NoAtlas>(atlas_from_json(text.substr(0, text.size() / 2))));
}

/// Which cells tell something: contacts and others, misses of the method without bounds, doubt, exact arithmetic.
TEST(Atlas, ShowsEveryFigureSomewhere) {
  std::uint64_t contacts = 0, others = 0, misses = 0, alarms = 0, uncertain = 0, exact = 0;
  for (Map map : small_atlas().maps) {
    for (std::size_t cell = 0; cell < map.queries.size(); ++cell) {
      contacts += map.contacts[cell];
      others += map.queries[cell] - map.contacts[cell];
      misses += counts(map, "bsc-float").misses[cell];
      alarms += counts(map, "tight").false_alarms[cell];
      uncertain += counts(map, "tight").uncertain[cell];
      exact += counts(map, "bsc-exact").exact[cell];
    }
  }
  for (const std::uint64_t count : {contacts, others, misses, alarms, uncertain, exact}) EXPECT_GT(count, 100U);
}

TEST(Atlas, StopsWhenToldTo) {
  const SweepRequest request{.families = {Scene::sliding},
                             .kinds = {Kind::edge_edge},
                             .methods = {Method::tight},
                             .reals = {Real::in_double},
                             .axes = small_axes(),
                             .queries = 2};
  int calls = 0;
  EXPECT_FALSE(sweep(request, [&](std::uint64_t, std::uint64_t) { return ++calls < 3; }));
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace tightrope::ccd::stability
