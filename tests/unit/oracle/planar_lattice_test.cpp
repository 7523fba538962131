/// Motions of four points between the points of a small planar lattice (every third of all): coplanar for the whole
/// step, with all ways of sliding, passing through corners, overlapping, collapsing and turning that there are. The
/// oracle against an own decision in the plane: contact at some time if and only if subdivision does not prove the
/// contrary.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "ccd/oracle/decision.h"
#include "ccd/oracle/oracle.h"
#include "static_contact.h"

namespace tightrope::ccd {
namespace {

using oracle::Defect;
using test::Points;
using test::text;

struct Flat {
  std::int64_t x, y;
};
/// Four points at both ends of an interval of time; the first one rests at 0.
using Motion = std::array<std::array<Flat, 4>, 2>;

/// Signs on the whole interval of cross(p_j - p_i, p_k - p_i), from its three Bernstein coefficients, the middle one
/// doubled.
struct Sides {
  bool positive, negative;          ///< strictly
  bool not_negative, not_positive;  ///< weakly
};

Sides side_of_line(const Motion& m, std::size_t i, std::size_t j, std::size_t k) {
  const auto cross = [&](std::size_t s, std::size_t t) {
    const std::int64_t ux = m[s][j].x - m[s][i].x, uy = m[s][j].y - m[s][i].y;
    const std::int64_t vx = m[t][k].x - m[t][i].x, vy = m[t][k].y - m[t][i].y;
    return ux * vy - uy * vx;
  };
  const auto [low, high] = std::minmax({cross(0, 0), cross(0, 1) + cross(1, 0), cross(1, 1)});
  return {low > 0, high < 0, low >= 0, high <= 0};
}

/// Of the feature that points i and j belong to all points are weakly on one side of their line, all points of the
/// other one strictly on the other side.
bool line_separates(const Motion& m, std::size_t i, std::size_t j, std::size_t first_size) {
  bool left = true, right = true;
  for (std::size_t k = 0; k < 4; ++k) {
    if (k == i || k == j) continue;
    const Sides side = side_of_line(m, i, j, k);
    const bool same_feature = (k < first_size) == (i < first_size);
    left = left && (same_feature ? side.not_negative : side.negative);
    right = right && (same_feature ? side.not_positive : side.positive);
  }
  return left || right;
}

/// Separation at both ends, hence in between, in one of many directions.
bool direction_separates(const Motion& m, std::size_t first_size) {
  constexpr std::int64_t most = 4;
  for (std::int64_t dx = 0; dx <= most; ++dx) {
    for (std::int64_t dy = -most; dy <= most; ++dy) {
      bool above = true, below = true;
      for (const auto& end : m) {
        std::int64_t low[2] = {INT64_MAX, INT64_MAX}, high[2] = {INT64_MIN, INT64_MIN};
        for (std::size_t k = 0; k < 4; ++k) {
          const std::int64_t at = dx * end[k].x + dy * end[k].y;
          const std::size_t feature = k < first_size ? 0 : 1;
          low[feature] = std::min(low[feature], at);
          high[feature] = std::max(high[feature], at);
        }
        above = above && low[0] > high[1];
        below = below && high[0] < low[1];
      }
      if (above || below) return true;
    }
  }
  return false;
}

bool proved_apart(Kind kind, const Motion& m, int depth) {
  const std::size_t first_size = kind == Kind::vertex_face ? 1 : 2;
  if (direction_separates(m, first_size)) return true;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      if ((i < first_size) == (j < first_size) && line_separates(m, i, j, first_size)) return true;
    }
  }
  if (depth == 0) return false;
  Motion left, right;  // at twice the scale
  for (std::size_t k = 0; k < 4; ++k) {
    const Flat middle = {m[0][k].x + m[1][k].x, m[0][k].y + m[1][k].y};
    left[0][k] = {2 * m[0][k].x, 2 * m[0][k].y};
    right[1][k] = {2 * m[1][k].x, 2 * m[1][k].y};
    left[1][k] = right[0][k] = middle;
  }
  return proved_apart(kind, left, depth - 1) && proved_apart(kind, right, depth - 1);
}

struct Comparison {
  int contacts = 0;
  int apart = 0;
  int disagreements = 0;
};

/// All motions of three points between {-1, 0, 1} x {-1, 0, 1}, the fourth at 0: up to a translation that is linear in
/// time every motion of that size. Of motions that the reflection of x, that of y, or the reversal of time turn into
/// each other one, of every `stride` one.
Comparison compare(Kind kind, Defect defect, int stride) {
  Comparison sum;
  std::array<int, 6> code{};  // places 0 .. 8 of points 1, 2, 3 at t = 0, then at t = 1
  int number = 0;
  for (int all = 0; all < 531441; ++all) {
    int rest = all;
    for (int& c : code) {
      c = rest % 9;
      rest /= 9;
    }
    const std::array<int, 6> reversed = {code[3], code[4], code[5], code[0], code[1], code[2]};
    const auto x_reflected = [](std::array<int, 6> c) {
      for (int& k : c) k = k / 3 * 3 + 2 - k % 3;
      return c;
    };
    const auto y_reflected = [](std::array<int, 6> c) {
      for (int& k : c) k = (2 - k / 3) * 3 + k % 3;
      return c;
    };
    if (reversed < code || x_reflected(code) < code || y_reflected(code) < code) continue;
    if (number++ % stride != 0) continue;
    Motion motion{};
    Points points{};
    for (std::size_t i = 0; i < 6; ++i) {
      const int x = code[i] % 3 - 1, y = code[i] / 3 - 1;
      motion[i / 3][i % 3 + 1] = {x, y};
      double* point = &points[12 * (i / 3) + 3 * (i % 3 + 1)];
      point[0] = x;
      point[1] = y;
      point[2] = x - 2 * y;  // some plane
    }
    const bool found = oracle::contact(kind, points, defect);
    const bool apart = proved_apart(kind, motion, 12);
    ++(found ? sum.contacts : sum.apart);
    if (found != apart) continue;
    ++sum.disagreements;
    if (defect == Defect::none && sum.disagreements < 4) ADD_FAILURE() << text(kind) << testing::PrintToString(points);
  }
  return sum;
}

TEST(OracleInThePlane, AgreesWithSubdivisionOnMotionsOfALattice) {
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    const Comparison sum = compare(kind, Defect::none, 3);
    EXPECT_EQ(sum.disagreements, 0) << text(kind);
    EXPECT_GT(sum.contacts, 1000);
    EXPECT_GT(sum.apart, 1000);
    std::printf("%s: %d contacts, %d apart\n", text(kind), sum.contacts, sum.apart);
  }
}

TEST(OracleInThePlaneWithADefect, Disagrees) {
  for (const Defect defect :
       {Defect::collapsed_never_touches, Defect::coplanar_motion_only_at_ends, Defect::open_features}) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      EXPECT_GT(compare(kind, defect, 101).disagreements, 0) << text(kind) << static_cast<int>(defect);
    }
  }
}

}  // namespace
}  // namespace tightrope::ccd
