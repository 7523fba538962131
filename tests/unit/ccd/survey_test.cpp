/// The survey of degenerate families: the truth that their construction promises is the oracle's.

#include "scenes/survey.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "oracle/oracle.h"
#include "tests/stability/show_query.h"

namespace tightrope::ccd {
namespace {

constexpr std::array<Kind, 2> both_kinds = {Kind::vertex_face, Kind::edge_edge};

std::array<double, 24> coordinates(const Query& query) {
  std::array<double, 24> points{};
  auto out = points.begin();
  for (const auto* side : {&query.start, &query.end}) {
    for (const Point& point : *side) {
      *out++ = point.x;
      *out++ = point.y;
      *out++ = point.z;
    }
  }
  return points;
}

struct Tally {
  int touching = 0;  ///< by construction
  int apart = 0;     ///< by construction
  int found = 0;     ///< by the oracle
  int wrong = 0;
};

/// `nudge`: one coordinate is moved by its last bit after the construction.
Tally tally(Scene scene, Kind kind, int queries, bool nudge) {
  Random random(77);
  Tally sum;
  for (int n = 0; n < queries; ++n) {
    const Constructed made = construct(scene, kind, random);
    std::array<double, 24> points = coordinates(made.query);
    if (nudge) {
      const auto moved = static_cast<std::size_t>(random.integer(0, 23));
      const bool both_ends = scene == Scene::at_rest;  // which touches at the other end otherwise
      for (const std::size_t i : {moved, (moved + 12) % 24}) {
        if (i == moved || both_ends) points[i] = std::nextafter(points[i], std::numeric_limits<double>::infinity());
      }
    }
    const bool contact = oracle::contact(kind, points);
    sum.found += contact ? 1 : 0;
    if (!made.touches) continue;
    ++(*made.touches ? sum.touching : sum.apart);
    if (contact == *made.touches) continue;
    ++sum.wrong;
    if (!nudge && sum.wrong < 4) {
      ADD_FAILURE() << "touches " << *made.touches << ' ' << name(kind) << '\n' << show_query(points.data());
    }
  }
  return sum;
}

class Survey : public testing::TestWithParam<Scene> {};

TEST_P(Survey, TheOracleFindsTheTruthThatTheConstructionPromises) {
  for (const Kind kind : both_kinds) {
    constexpr int queries = 1500;
    const Tally sum = tally(GetParam(), kind, queries, false);
    EXPECT_EQ(sum.wrong, 0) << name(kind);
    EXPECT_GT(sum.touching, queries * 2 / 5) << name(kind);
    EXPECT_GT(queries - sum.found, queries * (GetParam() == Scene::rotation ? 1 : 4) / 10) << name(kind);
    std::printf("%s %s: %d contacts of %d, %d constructed to miss\n", name(GetParam()).data(), name(kind).data(),
                sum.found, queries, sum.apart);
  }
}

/// Contacts are lost when one coordinate moves by its last bit: they touch by no more than they must.
TEST_P(Survey, ContactsAreNarrow) {
  int lost = 0;
  for (const Kind kind : both_kinds) lost += tally(GetParam(), kind, 400, true).wrong;
  EXPECT_GT(lost, 20);
}

std::vector<Scene> survey() {
  std::vector<Scene> all;
  for (const SceneInfo& info : scenes()) {
    if (info.survey) all.push_back(info.scene);
  }
  return all;
}

std::string test_name(const testing::TestParamInfo<Scene>& info) {
  std::string text(name(info.param));
  std::replace(text.begin(), text.end(), '-', '_');
  return text;
}

INSTANTIATE_TEST_SUITE_P(Families, Survey, testing::ValuesIn(survey()), test_name);

}  // namespace
}  // namespace tightrope::ccd
