/// The oracle against a predicate that shares nothing with it (linear programming at fixed times), on lattices, where
/// every kind of degeneracy is frequent.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>

#include "ccd/oracle/decision.h"
#include "ccd/oracle/oracle.h"
#include "queries.h"
#include "static_contact.h"

namespace tightrope::ccd {
namespace {

using oracle::Contact;
using oracle::Defect;
using test::Points;
using test::QueryMaker;
using test::static_contact;
using test::text;
using test::touching_at;

constexpr std::array kinds = {Kind::vertex_face, Kind::edge_edge};

Points still(const std::array<int, 12>& coordinates) {
  Points points;
  for (std::size_t i = 0; i < 12; ++i) points[i] = points[i + 12] = coordinates[i];
  return points;
}

/// Configurations of four fixed points of {0, 1, 2} x {0, 1} x {0, 1} (all of them, or those with first point 0) on
/// which the oracle and linear programming disagree. All degenerate positions of points, segments and triangles occur.
int static_disagreements(Kind kind, Defect defect, int first_points) {
  constexpr int lattice_size = 12;
  const auto place = [](int code, int axis) { return axis == 0 ? code / 4 : axis == 1 ? code / 2 % 2 : code % 2; };
  int count = 0;
  std::array<int, 12> x;
  for (int code = 0; code < first_points * lattice_size * lattice_size * lattice_size; ++code) {
    const std::array<int, 4> corner = {code / 1728, code / 144 % 12, code / 12 % 12, code % 12};
    std::array<std::array<mpq_class, 3>, 4> p;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        x[3 * i + axis] = place(corner[i], static_cast<int>(axis));
        p[i][axis] = x[3 * i + axis];
      }
    }
    if (oracle::contact(kind, still(x), defect) != static_contact(kind, p)) ++count;
  }
  return count;
}

TEST(OracleOnFixedPoints, AgreesWithLinearProgrammingOnAWholeLattice) {
  for (const Kind kind : kinds) EXPECT_EQ(static_disagreements(kind, Defect::none, 12), 0) << text(kind);
}

TEST(OracleOnFixedPoints, AgreesWithLinearProgrammingOnALargerLattice) {
  QueryMaker random(21);
  std::array<int, 12> x;
  for (int i = 0; i < 20000; ++i) {
    for (int& coordinate : x) coordinate = random.integer(0, 2);
    const Points points = still(x);
    for (const Kind kind : kinds) {
      const std::optional<Contact> found = oracle::first_contact(kind, points);
      ASSERT_EQ(found.has_value(), touching_at(kind, points, 0)) << text(kind) << ' ' << testing::PrintToString(x);
      if (found) {
        EXPECT_EQ(found->upper, 0.0);
      }
    }
  }
}

/// How an answer contradicts linear programming at fixed times, if it does: "misses", "late", "false".
std::optional<const char*> contradiction(Kind kind, const Points& points, const std::optional<Contact>& found) {
  constexpr int steps = 12;  // 1/2, 1/3, 1/4, 1/6 and 1/12: where lattice motions like to meet
  for (int i = 0; i <= steps; ++i) {
    mpq_class t(i, steps);
    t.canonicalize();
    if (found && mpq_class(found->lower) < t) break;
    if (!touching_at(kind, points, t)) continue;
    if (!found) return "misses";
    if (mpq_class(found->lower) > t) return "late";
  }
  if (found && found->lower == found->upper && !touching_at(kind, points, mpq_class(found->lower))) return "false";
  return std::nullopt;
}

int moving_contradictions(Defect defect, int queries, std::uint64_t seed) {
  QueryMaker random(seed);
  int count = 0;
  for (int i = 0; i < queries; ++i) {
    const Points points = random.make(i % QueryMaker::families);
    for (const Kind kind : kinds) {
      const auto wrong = contradiction(kind, points, oracle::first_contact(kind, points, defect));
      if (!wrong) continue;
      ++count;
      if (defect == Defect::none) ADD_FAILURE() << *wrong << ' ' << text(kind) << ' ' << testing::PrintToString(points);
    }
  }
  return count;
}

TEST(OracleOnMovingPoints, AgreesWithLinearProgrammingAtFixedTimes) {
  EXPECT_EQ(moving_contradictions(Defect::none, 6000, 22), 0);
}

TEST(OracleOnMovingPoints, EnclosesTheTimeTightly) {
  QueryMaker random(23);
  int exact = 0, between = 0;
  for (int i = 0; i < 6000; ++i) {
    const Points points = random.make(i % QueryMaker::families);
    for (const Kind kind : kinds) {
      const std::optional<Contact> found = oracle::first_contact(kind, points);
      ASSERT_EQ(found.has_value(), oracle::contact(kind, points));
      if (!found) continue;
      EXPECT_GE(found->lower, 0.0);
      EXPECT_LE(found->upper, 1.0);
      if (found->lower == found->upper) {
        ++exact;
      } else {
        ++between;
        EXPECT_EQ(std::nextafter(found->lower, 2.0), found->upper);
        EXPECT_FALSE(touching_at(kind, points, mpq_class(found->lower)));
      }
    }
  }
  EXPECT_GT(exact, 500);
  EXPECT_GT(between, 500);
}

// Each defect is caught by one of the comparisons above, at a fraction of their size.
TEST(OracleWithADefect, DisagreesOnFixedPoints) {
  for (const Defect defect :
       {Defect::collapsed_never_touches, Defect::collapsed_always_touches, Defect::open_features}) {
    for (const Kind kind : kinds) EXPECT_GT(static_disagreements(kind, defect, 1), 0) << static_cast<int>(defect);
  }
}

TEST(OracleWithADefect, DisagreesOnMovingPoints) {
  for (const Defect defect :
       {Defect::collapsed_never_touches, Defect::collapsed_always_touches, Defect::coplanar_motion_only_at_ends,
        Defect::open_features, Defect::sign_change_expected}) {
    EXPECT_GT(moving_contradictions(defect, 600, 22), 0) << static_cast<int>(defect);
  }
}

}  // namespace
}  // namespace tightrope::ccd
