/// `bsc-exact` is exact: against the oracle, which shares no code with it, on contacts, near contacts and every kind of
/// degeneracy; the exact stage and the filter also on their own.

#include "ccd/methods/bsc_exact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "contacts.h"
#include "oracle/oracle.h"
#include "scenes/scene.h"
#include "tests/stability/show_query.h"

namespace tightrope::ccd {
namespace {

using test::ContactGenerator;
using test::Query;
using test::Random;

constexpr std::array<Kind, 2> kinds{Kind::vertex_face, Kind::edge_edge};

struct Answers {
  int contacts = 0, free = 0, filtered = 0;
};

void compare(Kind kind, const Query& query, Answers& answers) {
  const bool truth = oracle::contact(kind, query);
  (truth ? answers.contacts : answers.free) += 1;
  ASSERT_EQ(exact::contact(kind, query.data()), truth) << name(kind) << '\n' << show_query(query.data());
  ASSERT_EQ(collides(kind, query.data(), Method::bsc_exact), truth) << name(kind) << '\n' << show_query(query.data());
  const auto filtered = exact::filtered_contact(kind, query.data());
  answers.filtered += filtered.has_value() ? 1 : 0;
  ASSERT_EQ(filtered.value_or(truth), truth) << name(kind) << '\n' << show_query(query.data());
}

/// Points on a small lattice: all coincidences there are.
TEST(BscExact, AgreesWithTheOracleOnLattices) {
  for (const Kind kind : kinds) {
    Random random(61);
    Answers answers;
    for (int i = 0; i < 10'000; ++i) {
      const int size = random.whole(1, 3), still = random.whole(0, 3), flat = random.whole(0, 3);
      Query query;
      for (double& x : query) x = random.whole(0, size);
      for (std::size_t j = 0; j < 12; ++j) {
        if (still == 0 && random.chance(80)) query[12 + j] = query[j];  // mostly at rest
        if (j % 3 == 2 && flat >= 1) query[j] = query[12 + j] = 0;      // in a plane
        if (j % 3 == 1 && flat == 2) query[j] = 2 * query[j - 1];       // on a line at t = 0
        if (j % 3 == 1 && flat == 3) {                                  // all the time
          query[j] = query[j - 1];
          query[12 + j] = query[11 + j];
        }
      }
      ASSERT_NO_FATAL_FAILURE(compare(kind, query, answers)) << i;
    }
    EXPECT_GT(answers.contacts, 2500);
    EXPECT_GT(answers.free, 1000);
  }
}

TEST(BscExact, AgreesWithTheOracleOnContactsAndOneUlpBeside) {
  for (const Kind kind : kinds) {
    ContactGenerator generator(62);
    Answers answers;
    for (int i = 0; i < 4'000; ++i) {
      Query query = generator.contact(kind);
      ASSERT_NO_FATAL_FAILURE(compare(kind, query, answers));
      double& x = query[static_cast<std::size_t>(generator.random().whole(0, 23))];
      x = std::nextafter(x, generator.random().chance(50) ? 1e9 : -1e9);
      ASSERT_NO_FATAL_FAILURE(compare(kind, query, answers));
    }
    EXPECT_GT(answers.contacts, 4'000);
    EXPECT_GT(answers.free, 200);
    EXPECT_GT(answers.filtered, 200);
  }
}

TEST(BscExact, AgreesWithTheOracleOnEveryScene) {
  constexpr std::size_t count = 250;
  for (const SceneInfo& info : scenes()) {
    for (const Kind kind : kinds) {
      std::vector<double> points(24 * count);
      generate(info.scene, kind, count, 63)->fill(points);
      Answers answers;
      for (std::size_t i = 0; i < count; ++i) {
        Query query;
        std::copy_n(points.data() + 24 * i, 24, query.begin());
        ASSERT_NO_FATAL_FAILURE(compare(kind, query, answers)) << info.name;
      }
    }
  }
}

TEST(BscExact, DecidesSinglePrecisionExactly) {
  for (const Kind kind : kinds) {
    ContactGenerator generator(64);
    for (int i = 0; i < 5'000; ++i) {
      const Query query = generator.contact(kind);
      std::array<float, 24> points;
      Query exact_points;
      for (std::size_t j = 0; j < 24; ++j) exact_points[j] = points[j] = static_cast<float>(query[j]);
      ASSERT_EQ(collides(kind, points.data(), Method::bsc_exact), oracle::contact(kind, exact_points));
    }
  }
}

/// The false positives of the published formulation (MATH 1.5), which its normal n and cubic Y cannot tell: decided
/// here.
TEST(BscExact, HasNotTheFalsePositivesOfTheFormulation) {
  const auto decide = [](Kind kind, const Query& query) { return collides(kind, query.data(), Method::bsc_exact); };
  // A triangle that collapses to the segment from (0, 0, 0) to (2, 0, 0), the vertex on its line beyond it: n(t) = 0.
  const Query beyond{3, 0, 2, 0, 0, 1, 1, 1, 1, 2, 0, 1, 3, 0, -2, 0, 0, -1, 1, -1, -1, 2, 0, -1};
  const Query within{1, 0, 2, 0, 0, 1, 1, 1, 1, 2, 0, 1, 1, 0, -2, 0, 0, -1, 1, -1, -1, 2, 0, -1};
  EXPECT_FALSE(decide(Kind::vertex_face, beyond));
  EXPECT_TRUE(decide(Kind::vertex_face, within));
  // Everything in the plane z = 0 all the time: Y is identically zero. The vertex passes the corner, or grazes it.
  const auto passing = [](double x) {
    return Query{x, -1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, x + 2, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0};
  };
  EXPECT_FALSE(decide(Kind::vertex_face, passing(0x1p-50)));
  EXPECT_TRUE(decide(Kind::vertex_face, passing(0)));
  EXPECT_TRUE(decide(Kind::vertex_face, passing(-0x1p-50)));
}

}  // namespace
}  // namespace tightrope::ccd
