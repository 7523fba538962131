/// The oracle against proofs of "no contact" by subdivision in rational arithmetic, on the projected criterion
/// (MATH 1.4), which the oracle does not use: where subdivision proves that the features stay apart the oracle may find
/// no contact.

#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "ccd/oracle/oracle.h"
#include "queries.h"
#include "static_contact.h"

namespace tightrope::ccd {
namespace {

using test::Points;
using test::QueryMaker;
using test::text;
using Vector = std::array<mpq_class, 3>;
using Moving = std::array<Vector, 2>;  // at the ends of an interval of time
using Quadratics = std::array<Vector, 3>;

Vector cross(const Vector& u, const Vector& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}
mpq_class dot(const Vector& u, const Vector& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }
Vector sum(const Vector& u, const Vector& v) { return {u[0] + v[0], u[1] + v[1], u[2] + v[2]}; }
Moving difference(const Moving& u, const Moving& v) {
  Moving r;
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t axis = 0; axis < 3; ++axis) r[end][axis] = u[end][axis] - v[end][axis];
  }
  return r;
}
/// Bernstein coefficients, the middle one doubled.
Quadratics cross(const Moving& u, const Moving& v) {
  return {cross(u[0], v[0]), sum(cross(u[0], v[1]), cross(u[1], v[0])), cross(u[1], v[1])};
}
int common_sign(const std::array<int, 3>& s) { return s[0] == s[1] && s[1] == s[2] ? s[0] : 0; }

/// Whether the hulls on this interval exclude contact, by MATH 1.4 (a): a definite Y, two definite and opposite
/// projections of the same coordinate, or strict separation along an axis at both ends.
bool apart(Kind kind, const std::array<Moving, 4>& p) {
  const std::size_t first = kind == Kind::vertex_face ? 1 : 0;
  const Moving &d = p[(first + 3) % 4], a = difference(p[first], d), b = difference(p[first + 1], d),
               c = difference(p[first + 2], d);
  const std::array<Quadratics, 3> m = {cross(b, c), cross(c, a), cross(a, b)};
  const std::array<mpq_class, 4> y = {dot(a[0], m[0][0]), dot(a[0], m[0][1]) + dot(a[1], m[0][0]),
                                      dot(a[0], m[0][2]) + dot(a[1], m[0][1]), dot(a[1], m[0][2])};
  const int s = sgn(y[0]);
  if (s != 0 && sgn(y[1]) == s && sgn(y[2]) == s && sgn(y[3]) == s) return true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    bool positive = false, negative = false;
    const auto add = [&](int sign, const mpq_class& q0, const mpq_class& q1, const mpq_class& q2) {
      const int definite = sign * common_sign({sgn(q0), sgn(q1), sgn(q2)});
      positive |= definite > 0;
      negative |= definite < 0;
    };
    std::array<mpq_class, 3> n;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) n[j] += m[i][j][axis];
      add(kind == Kind::edge_edge && i == 2 ? -1 : 1, m[i][0][axis], m[i][1][axis], m[i][2][axis]);
    }
    if (kind == Kind::edge_edge) add(1, n[0], n[1], n[2]);
    if (positive && negative) return true;
    bool above = true, below = true;  // all of the first feature beyond all of the second, seen from d
    for (std::size_t end = 0; end < 2; ++end) {
      const mpq_class &x = a[end][axis], &z = b[end][axis], &w = c[end][axis];
      const mpq_class low = kind == Kind::vertex_face || w > 0 ? mpq_class(0) : w;
      const mpq_class high = kind == Kind::vertex_face || w < 0 ? mpq_class(0) : w;
      const bool w_above = kind == Kind::edge_edge || w > 0, w_below = kind == Kind::edge_edge || w < 0;
      above = above && x > high && z > high && w_above;
      below = below && x < low && z < low && w_below;
    }
    if (above || below) return true;
  }
  return false;
}

bool proved_apart(Kind kind, const std::array<Moving, 4>& p, int depth) {
  if (apart(kind, p)) return true;
  if (depth == 0) return false;
  std::array<Moving, 4> left = p, right = p;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      left[i][1][axis] = right[i][0][axis] = (p[i][0][axis] + p[i][1][axis]) / 2;
    }
  }
  return proved_apart(kind, left, depth - 1) && proved_apart(kind, right, depth - 1);
}

bool proved_apart(Kind kind, const Points& points, int depth) {
  std::array<Moving, 4> p;
  for (std::size_t i = 0; i < 4; ++i) p[i] = {test::at_time(points, 0)[i], test::at_time(points, 1)[i]};
  return proved_apart(kind, p, depth);
}

TEST(Oracle, AgreesWithProofsBySubdivision) {
  QueryMaker random(31);
  int proofs = 0, none = 0;
  for (int i = 0; i < 3000; ++i) {
    const Points points = random.make(i % QueryMaker::families);
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      const bool found = oracle::contact(kind, points), proved = proved_apart(kind, points, found ? 10 : 12);
      EXPECT_FALSE(found && proved) << text(kind) << ' ' << testing::PrintToString(points);
      proofs += proved ? 1 : 0;
      none += found ? 0 : 1;
      // On these lattices features that do not touch stay apart far enough for a proof at this depth.
      EXPECT_TRUE(found || proved) << text(kind) << ' ' << testing::PrintToString(points);
    }
  }
  EXPECT_GT(proofs, 1000);
  EXPECT_EQ(proofs, none);
}

}  // namespace
}  // namespace tightrope::ccd
