/// What an exact answer may not depend on.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>

#include "ccd/oracle/oracle.h"
#include "queries.h"
#include "static_contact.h"

namespace tightrope::ccd {
namespace {

using oracle::Contact;
using test::Points;
using test::QueryMaker;
using test::text;

/// Point i of the result is point order[i] of the query.
Points permuted(const Points& points, const std::array<std::size_t, 4>& order) {
  Points result;
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) result[3 * i + axis] = points[3 * (order[i % 4] + i / 4 * 4) + axis];
  }
  return result;
}

::testing::AssertionResult same(const std::optional<Contact>& x, const std::optional<Contact>& y) {
  if (x.has_value() == y.has_value() && (!x || (x->lower == y->lower && x->upper == y->upper))) {
    return ::testing::AssertionSuccess();
  }
  return ::testing::AssertionFailure() << (x ? x->lower : -1) << " against " << (y ? y->lower : -1);
}

/// Calls check(kind, points, first contact) on queries of all families.
template <class Check>
void on_queries(std::uint64_t seed, int count, Check check) {
  QueryMaker random(seed);
  int contacts = 0;
  for (int i = 0; i < count; ++i) {
    const Points points = random.make(i % QueryMaker::families);
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      const std::optional<Contact> found = oracle::first_contact(kind, points);
      check(kind, points, found);
      contacts += found ? 1 : 0;
      if (::testing::Test::HasFailure()) FAIL() << text(kind) << ' ' << testing::PrintToString(points);
    }
  }
  EXPECT_GT(contacts, count / 4);
}

TEST(OracleInvariance, OrderOfTheFacesCorners) {
  on_queries(41, 3000, [](Kind kind, const Points& points, const std::optional<Contact>& found) {
    if (kind != Kind::vertex_face) return;
    for (const std::array<std::size_t, 4>& order : std::array<std::array<std::size_t, 4>, 5>{
             {{0, 1, 3, 2}, {0, 2, 1, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {0, 3, 2, 1}}}) {
      EXPECT_TRUE(same(found, oracle::first_contact(kind, permuted(points, order))));
    }
  });
}

TEST(OracleInvariance, OrderAndDirectionOfTheEdges) {
  on_queries(42, 3000, [](Kind kind, const Points& points, const std::optional<Contact>& found) {
    if (kind != Kind::edge_edge) return;
    for (const std::array<std::size_t, 4>& order : std::array<std::array<std::size_t, 4>, 7>{
             {{0, 1, 3, 2}, {1, 0, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {2, 3, 1, 0}, {3, 2, 0, 1}, {3, 2, 1, 0}}}) {
      EXPECT_TRUE(same(found, oracle::first_contact(kind, permuted(points, order))));
    }
  });
}

TEST(OracleInvariance, DirectionOfTime) {
  on_queries(43, 6000, [](Kind kind, const Points& points, const std::optional<Contact>& found) {
    Points reversed;
    for (std::size_t i = 0; i < 24; ++i) reversed[i] = points[(i + 12) % 24];
    EXPECT_EQ(found.has_value(), oracle::contact(kind, reversed));
  });
}

TEST(OracleInvariance, HalvesOfTime) {
  on_queries(44, 6000, [](Kind kind, const Points& points, const std::optional<Contact>& found) {
    Points early = points, late = points;  // to and from the position at t = 1/2, which is exact
    for (std::size_t i = 0; i < 12; ++i) early[i + 12] = late[i] = (points[i] + points[i + 12]) / 2;
    const std::optional<Contact> in_early = oracle::first_contact(kind, early);
    const std::optional<Contact> in_late = oracle::first_contact(kind, late);
    EXPECT_EQ(found.has_value(), in_early || in_late);
    EXPECT_EQ(in_early.has_value(), found && found->lower <= 0.5);
    if (in_early && found) {  // the time of the first half counts double; exact, as 2^-1 only shifts it
      EXPECT_EQ(in_early->lower, 2 * found->lower);
      EXPECT_EQ(in_early->upper, 2 * found->upper);
    }
  });
}

TEST(OracleInvariance, ScaleByPowersOfTwo) {
  on_queries(45, 3000, [](Kind kind, const Points& points, const std::optional<Contact>& found) {
    for (const int exponent : {-1074, -1, 700, 1019}) {
      Points scaled;
      for (std::size_t i = 0; i < 24; ++i) scaled[i] = std::ldexp(points[i], exponent);
      if (exponent == -1074) {
        for (const double x : points) {
          if (x != std::floor(x)) return;  // would not scale exactly
        }
      }
      EXPECT_TRUE(same(found, oracle::first_contact(kind, scaled)));
    }
  });
}

TEST(OracleInvariance, CommonTranslation) {
  on_queries(46, 3000, [](Kind kind, const Points& points, const std::optional<Contact>& found) {
    Points shifted = points;  // exact: small multiples of 1/8 next to these
    for (std::size_t i = 0; i < 24; ++i) {
      shifted[i] += std::array<double, 3>{0x1p20, -77, 0x1p-20}[i % 3] +
                    (i < 12 ? 0.0 : std::array<double, 3>{3, 0.25, -9}[i % 3]);
    }
    EXPECT_TRUE(same(found, oracle::first_contact(kind, shifted)));
  });
}

TEST(OracleInvariance, SymmetriesAndShearsOfSpace) {
  on_queries(47, 3000, [](Kind kind, const Points& points, const std::optional<Contact>& found) {
    Points turned, sheared;
    for (std::size_t i = 0; i < 24; i += 3) {
      turned[i] = -points[i + 1];
      turned[i + 1] = points[i + 2];
      turned[i + 2] = -points[i];
      sheared[i] = points[i] + 3 * points[i + 2];  // affine and invertible: contact does not change
      sheared[i + 1] = 5 * points[i + 1] - points[i];
      sheared[i + 2] = points[i + 2];
    }
    EXPECT_TRUE(same(found, oracle::first_contact(kind, turned)));
    EXPECT_TRUE(same(found, oracle::first_contact(kind, sheared)));
  });
}

}  // namespace
}  // namespace tightrope::ccd
