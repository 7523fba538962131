/// The queries that the stability atlas asks.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "oracle/oracle.h"
#include "stability/base_queries.h"
#include "tests/stability/show_query.h"

namespace tightrope::ccd::stability {
namespace {

constexpr std::array<Kind, 2> kinds = {Kind::vertex_face, Kind::edge_edge};

std::array<double, 24> coordinates(const Query& query) {
  std::array<double, 24> result{};
  std::size_t i = 0;
  for (const auto* points : {&query.start, &query.end}) {
    for (const Point& point : *points) {
      for (const double x : {point.x, point.y, point.z}) result[i++] = x;
    }
  }
  return result;
}

TEST(AtlasQueries, FamiliesAreTheDegenerateOnesWithoutMixtures) {
  const std::vector<Scene> all = families();
  EXPECT_EQ(all.size(), 14U);
  EXPECT_EQ(all.front(), Scene::degenerate);
  EXPECT_EQ(std::count(all.begin(), all.end(), Scene::offsets), 0);
  EXPECT_EQ(std::count(all.begin(), all.end(), Scene::degenerate_families), 0);
}

/// The rows above distance 0 start from contact: exact, so that what a perturbation does is its own.
TEST(AtlasQueries, TouchingOnesTouch) {
  for (const Scene family : families()) {
    if (family == Scene::degenerate) continue;
    for (const Kind kind : kinds) {
      for (const BaseQuery& base : base_queries(family, kind, 40, 7)) {
        const auto points = coordinates(base.touching);
        EXPECT_TRUE(oracle::contact(kind, points)) << name(family) << "\n" << show_query(points.data());
      }
    }
  }
}

TEST(AtlasQueries, HalfOfThemAsMadeMiss) {
  for (const Scene family : families()) {
    for (const Kind kind : kinds) {
      int contacts = 0;
      for (const BaseQuery& base : base_queries(family, kind, 60, 7)) {
        contacts += oracle::contact(kind, placed(base, 0, 0)) ? 1 : 0;
      }
      EXPECT_GT(contacts, 10) << name(family);
      EXPECT_LT(contacts, 55) << name(family);
    }
  }
}

TEST(AtlasQueries, HaveASizeOfOneToTwo) {
  for (const Scene family : families()) {
    if (family == Scene::displacements) continue;  // some cannot be scaled without loss
    for (const BaseQuery& base : base_queries(family, Kind::edge_edge, 40, 3)) {
      const double size = extent(base.touching);
      EXPECT_TRUE(size == 0 || (size >= 1 && size < 2)) << name(family) << " " << size;
    }
  }
}

TEST(AtlasQueries, MoveByTheDistance) {
  for (const BaseQuery& base : base_queries(Scene::rotation, Kind::vertex_face, 20, 5)) {
    const auto touching = coordinates(base.touching);
    EXPECT_EQ(placed(base, 0, 0), coordinates(base.as_made));
    double before = 0;
    for (const double distance : {1e-12, 1e-6, 1e-2, 1.0}) {
      const auto moved = placed(base, distance, 0);
      double largest = 0;
      for (std::size_t i = 0; i < 24; ++i) largest = std::max(largest, std::abs(moved[i] - touching[i]));
      EXPECT_LE(largest, distance * extent(base.touching) * (1 + 1e-3));
      EXPECT_GT(largest, distance / 4);  // the largest of 24 uniform numbers
      EXPECT_GT(largest, before);
      before = largest;
    }
  }
}

/// No coordinate of a query at offset 1 is closer to 0 than to 1e-18 times 2^53.
TEST(AtlasQueries, SmallestDistanceMovesNothingAwayFromTheOrigin) {
  for (const Scene family : {Scene::through_vertex, Scene::at_rest, Scene::zero_area}) {
    for (const BaseQuery& base : base_queries(family, Kind::edge_edge, 20, 5)) {
      EXPECT_EQ(placed(base, 1e-18, 0x1p10), placed(base, 1e-19, 0x1p10)) << name(family);
    }
  }
}

TEST(AtlasQueries, AreTheSameForTheSameSeed) {
  const auto first = base_queries(Scene::sliding, Kind::edge_edge, 5, 9);
  const auto again = base_queries(Scene::sliding, Kind::edge_edge, 5, 9);
  const auto other = base_queries(Scene::sliding, Kind::edge_edge, 5, 10);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(placed(first[i], 1e-3, 1), placed(again[i], 1e-3, 1));
  EXPECT_NE(placed(first[0], 1e-3, 1), placed(other[0], 1e-3, 1));
}

/// The sweep asks the oracle once for all scales that change no coordinate otherwise.
TEST(AtlasQueries, TruthDoesNotChangeWithTheScale) {
  for (const Scene family : families()) {
    if (family == Scene::displacements) continue;
    for (const Kind kind : kinds) {
      for (const BaseQuery& base : base_queries(family, kind, 4, 11)) {
        for (const double distance : {0.0, 1e-14, 1e-3}) {
          const auto points = placed(base, distance, 1);
          const bool contact = oracle::contact(kind, points);
          for (const int exponent : {-200, 200}) {
            std::array<double, 24> scaled{};
            std::transform(points.begin(), points.end(), scaled.begin(),
                           [&](double x) { return std::ldexp(x, exponent); });
            EXPECT_EQ(oracle::contact(kind, scaled), contact) << name(family) << "\n" << show_query(points.data());
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace tightrope::ccd::stability
