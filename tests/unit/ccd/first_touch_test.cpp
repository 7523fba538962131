/// Method `tightrope`, decision and time of impact, against the oracle; what does not change the geometry changes
/// nothing.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "ccd/impact/query.h"
#include "ccd/query.h"
#include "contacts.h"
#include "oracle/oracle.h"
#include "scenes/scene.h"
#include "tests/stability/show_query.h"

namespace tightrope::ccd {
namespace {

using test::ContactGenerator;
using test::Query;
using test::Random;

std::vector<Query> queries_of(Kind kind, std::size_t each) {
  std::vector<Query> queries;
  for (const SceneInfo& info : scenes()) {
    std::vector<double> points(24 * each);
    generate(info.scene, kind, each, 101)->fill(points);
    for (std::size_t i = 0; i < each; ++i) std::copy_n(points.data() + 24 * i, 24, queries.emplace_back().begin());
  }
  ContactGenerator contacts(102);
  for (std::size_t i = 0; i < 4 * each; ++i) queries.push_back(contacts.contact(kind));
  return queries;
}

class FirstTouch : public testing::TestWithParam<Kind> {};

/// The times are never late, never early by more than the tolerance, and 0 only where contact is at 0.
TEST_P(FirstTouch, TimesAgreeWithTheOracle) {
  const Kind kind = GetParam();
  int contacts = 0, at_start = 0;
  for (const Query& query : queries_of(kind, 150)) {
    const auto truth = oracle::first_contact(kind, query);
    ASSERT_EQ(tightrope_collides(kind, query.data()), truth.has_value()) << show_query(query.data());
    for (const double tolerance : {1e-6, 1e-13, 0.0}) {
      const auto impact = first_touch(kind, query.data(), tolerance, 1.0);
      ASSERT_EQ(impact.has_value(), truth.has_value()) << show_query(query.data());
      if (!truth) continue;
      if (tolerance == 0) {
        EXPECT_EQ(impact->time, truth->lower) << show_query(query.data());
      }
      EXPECT_LE(impact->time, truth->lower) << show_query(query.data());
      EXPECT_LE(truth->lower - impact->time, tolerance) << show_query(query.data());
      EXPECT_EQ(impact->time == 0, truth->lower == 0) << show_query(query.data());
    }
    contacts += truth ? 1 : 0;
    at_start += truth && truth->upper == 0 ? 1 : 0;
  }
  EXPECT_GT(contacts, 1000);
  EXPECT_GT(at_start, 50);
}

/// Who wants the time leaves more to exact arithmetic than who does not, and never less.
TEST_P(FirstTouch, StagesDependOnTheQuestion) {
  const Kind kind = GetParam();
  int more = 0;
  for (const Query& query : queries_of(kind, 40)) {
    const Stage whether = deciding_stage(kind, query.data(), Question::whether);
    const Stage when = deciding_stage(kind, query.data(), Question::when);
    EXPECT_LE(whether, when) << show_query(query.data());
    more += whether < when ? 1 : 0;
  }
  EXPECT_GT(more, 5);
}

TEST_P(FirstTouch, ContactsAfterTMaxDoNotCount) {
  const Kind kind = GetParam();
  int counted = 0, left_out = 0;
  for (const Query& query : queries_of(kind, 40)) {
    const auto truth = oracle::first_contact(kind, query);
    if (!truth) continue;
    for (const double t_max : {truth->lower, truth->upper, std::nextafter(truth->lower, 0.0), truth->lower / 2, 1.0}) {
      const auto impact = first_touch(kind, query.data(), 1e-6, t_max);
      const bool counts = truth->upper <= t_max || (truth->lower == truth->upper && truth->lower <= t_max);
      EXPECT_EQ(impact.has_value(), counts) << t_max << '\n' << show_query(query.data());
      counted += counts ? 1 : 0;
      left_out += counts ? 0 : 1;
      if (impact) {
        EXPECT_LE(impact->time, truth->lower);
      }
    }
  }
  EXPECT_GT(counted, 500);
  EXPECT_GT(left_out, 500);
}

/// Where the features touch: weights of each feature in [0, 1] with sum 1, of points that are close together at that
/// time, measured by the size of the query.
TEST_P(FirstTouch, WeightsSayWhere) {
  const Kind kind = GetParam();
  int contacts = 0;
  for (const Query& query : queries_of(kind, 60)) {
    const auto impact = first_touch(kind, query.data(), 1e-9, 1.0);
    if (!impact) continue;
    ++contacts;
    const auto& w = impact->weights;
    for (const double x : w) EXPECT_TRUE(x >= 0 && x <= 1) << show_query(query.data());
    if (kind == Kind::vertex_face) {
      EXPECT_EQ(w[0], 1);
      EXPECT_NEAR(w[1] + w[2] + w[3], 1, 1e-14);
    } else {
      EXPECT_NEAR(w[0] + w[1], 1, 1e-14);
      EXPECT_NEAR(w[2] + w[3], 1, 1e-14);
    }
    double largest = 0;
    for (const double x : query) largest = std::max(largest, std::fabs(x));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double apart = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        const double x =
            (1 - impact->time) * (query[3 * i + axis] / largest) + impact->time * (query[12 + 3 * i + axis] / largest);
        apart += (i == 0 || (kind == Kind::edge_edge && i == 1) ? 1 : -1) * w[i] * x;
      }
      EXPECT_LE(std::fabs(apart), 1e-7) << show_query(query.data());
    }
  }
  EXPECT_GT(contacts, 500);
}

TEST_P(FirstTouch, FloatsAreDecidedAsTheDoublesThatTheyAre) {
  const Kind kind = GetParam();
  int contacts = 0;
  for (const Query& query : queries_of(kind, 100)) {
    std::array<float, 24> single;
    std::array<double, 24> same;
    for (std::size_t i = 0; i < 24; ++i) {
      single[i] = static_cast<float>(query[i]);
      same[i] = single[i];
    }
    if (!std::all_of(same.begin(), same.end(), [](double x) { return std::isfinite(x); })) continue;
    EXPECT_EQ(tightrope_collides(kind, single.data()), tightrope_collides(kind, same.data()));
    const auto a = first_touch(kind, single.data(), 1e-6, 1.0), b = first_touch(kind, same.data(), 1e-6, 1.0);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    ++contacts;
    EXPECT_EQ(a->time, b->time);
    EXPECT_EQ(a->weights, b->weights);
  }
  EXPECT_GT(contacts, 700);
}

TEST_P(FirstTouch, NotFiniteMeansContactAtOnce) {
  Random random(103);
  for (const double bad : {HUGE_VAL, -HUGE_VAL, std::nan("")}) {
    for (std::size_t i = 0; i < 24; ++i) {
      Query query = test::miss(GetParam(), random);
      query[i] = bad;
      EXPECT_TRUE(tightrope_collides(GetParam(), query.data()));
      const auto impact = first_touch(GetParam(), query.data(), 1e-6, 1.0);
      ASSERT_TRUE(impact.has_value());
      EXPECT_EQ(impact->time, 0);
    }
  }
}

/// The query with its points taken in another order, axes swapped, scaled and moved.
struct Change {
  std::array<std::size_t, 4> points{0, 1, 2, 3};
  std::array<std::size_t, 3> axes{0, 1, 2};
  int exponent = 0;
  std::array<double, 3> offset{};  ///< applied to both ends before scaling

  /// False if a coordinate would change by rounding.
  bool apply(const Query& from, Query& to) const {
    bool exact = true;
    for (std::size_t end = 0; end < 2; ++end) {
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double x = from[12 * end + 3 * points[i] + axes[axis]];
          const double moved = x + offset[axis];
          const double y = std::ldexp(moved, exponent);
          exact = exact && moved - offset[axis] == x && moved - x == offset[axis] && std::isfinite(y) &&
                  std::ldexp(y, -exponent) == moved;
          to[12 * end + 3 * i + axis] = y;
        }
      }
    }
    return exact;
  }
};

std::vector<Change> changes(Kind kind) {
  std::vector<Change> all;
  for (const int exponent : {-900, -500, -121, -40, 37, 300, 900}) all.push_back({.exponent = exponent});
  for (const std::array<std::size_t, 3> axes : {std::array<std::size_t, 3>{1, 2, 0}, {2, 0, 1}, {1, 0, 2}}) {
    all.push_back({.axes = axes});
  }
  all.push_back({.offset = {1, -2, 0.5}});
  all.push_back({.offset = {1024, 0, -3 * 1048576.0}});
  if (kind == Kind::vertex_face) {
    for (const std::array<std::size_t, 4> p : {std::array<std::size_t, 4>{0, 2, 3, 1}, {0, 3, 1, 2}, {0, 2, 1, 3}}) {
      all.push_back({.points = p});
    }
  } else {
    for (const std::array<std::size_t, 4> p :
         {std::array<std::size_t, 4>{1, 0, 2, 3}, {0, 1, 3, 2}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 0, 1}}) {
      all.push_back({.points = p});
    }
  }
  return all;
}

/// Exact answers do not depend on units, origin, axes and names: neither decisions nor, without a tolerance, times.
TEST_P(FirstTouch, IsInvariant) {
  const Kind kind = GetParam();
  std::vector<int> compared(changes(kind).size());
  for (const Query& query : queries_of(kind, 25)) {
    const auto here = first_touch(kind, query.data(), 0, 1.0);
    for (std::size_t c = 0; c < compared.size(); ++c) {
      Query changed;
      if (!changes(kind)[c].apply(query, changed)) continue;
      ++compared[c];
      EXPECT_EQ(tightrope_collides(kind, changed.data()), here.has_value()) << c << '\n' << show_query(query.data());
      const auto there = first_touch(kind, changed.data(), 0, 1.0);
      ASSERT_EQ(there.has_value(), here.has_value()) << c << '\n' << show_query(query.data());
      if (here) {
        EXPECT_EQ(there->time, here->time) << c << '\n' << show_query(query.data());
      }
    }
  }
  for (const int count : compared) EXPECT_GT(count, 100);
}

INSTANTIATE_TEST_SUITE_P(Kinds, FirstTouch, testing::Values(Kind::vertex_face, Kind::edge_edge), [](const auto& kind) {
  return std::string(kind.param == Kind::vertex_face ? "vertex_face" : "edge_edge");
});

}  // namespace
}  // namespace tightrope::ccd
