#include <array>
#include <utility>

#include "scenes/families.h"
#include "scenes/survey.h"

namespace tightrope::ccd {

/// Height over the tilting face (over the turning edge) at its moving foot: (t - t0)^2 + h, h = 0 or the margin above
/// (no root) or below (two close ones).
Constructed double_root(Construction c) {
  const double t0 = c.time();
  double h = c.gap;
  if (c.touches && c.random.chance(0.5)) h = -c.margin;
  const double z0 = t0 * t0 + h;
  const double z1 = (1 - t0) * (1 - t0) + h - 1;
  if (c.kind == Kind::vertex_face) {  // the face is z = -t y, the vertex at y = t
    c.set(0, {1, 0, z0}, {1, 1, z1});
    c.set(1, {0, 0, 0}, {0, 0, 0});
    c.set(2, {4, 0, 0}, {4, 0, 0});
    c.set(3, {0, 4, 0}, {0, 4, -4});
  } else {  // the first edge is z = -t x, the second one at x = t
    c.set(0, {-2, 0, 0}, {-2, 0, 2});
    c.set(1, {2, 0, 0}, {2, 0, -2});
    c.set(2, {0, -1, z0}, {1, -1, z1});
    c.set(3, {0, c.coarse_positive(), z0}, {1, c.coarse_positive(), z1});
  }
  return c.done();
}

/// A = (s, 1, 0), B = (0, s, 1), C = f A + g B + (0, 0, s) with s = 0 at t0 only: det(A, B, C) = s^3. At s = 0 the
/// origin is in the triangle ABC if f, g <= 0; the edges AB and 0C meet if f, g >= 0 and f + g >= 1.
Constructed triple_root(Construction c) {
  const double t0 = c.time();
  const double speed = c.coarse_not_zero();
  c.gap *= 0x1p5;  // products with it stay on the grid
  double f = c.gap;
  double g = -0.5 * c.random.integer(0, 2);
  if (c.kind == Kind::edge_edge) {
    f = -c.gap;
    g = 1 + 0.5 * c.random.integer(c.touches ? 0 : 1, 2);
  }
  if (c.touches && c.random.chance(0.3)) f = c.kind == Kind::vertex_face ? -0.5 : 0.5;  // in the interior
  for (const double t : {0.0, 1.0}) {
    auto& points = t == 0 ? c.query.start : c.query.end;
    const double s = speed * (t - t0);
    const Point a{s, 1, 0};
    const Point b{0, s, 1};
    const Point last = f * a + g * b + Point{0, 0, s};
    const Point origin{};
    if (c.kind == Kind::vertex_face) {
      points = {origin, a, b, last};
    } else {
      points = {a, b, last, origin};
    }
  }
  return c.done();
}

namespace {

/// Second differences of the cubic det(A, B, C)(t) have opposite signs (up to rounding): an inflection in (0, 1).
bool has_inflection(const Query& query) {
  std::array<double, 4> y{};
  for (int k = 0; k < 4; ++k) {
    const double t = k / 3.0;
    const Point d = query.at(0, t);
    y[static_cast<std::size_t>(k)] = dot(query.at(1, t) - d, cross(query.at(2, t) - d, query.at(3, t) - d));
  }
  const double third = (y[3] - 3 * y[2] + 3 * y[1] - y[0]) * 27;  // y''' of the interpolating cubic
  const double middle = (y[3] - y[2] - y[1] + y[0]) * 4.5;        // y'' at t = 1/2
  return (middle + 0.5 * third > 0) != (middle - 0.5 * third > 0);
}

}  // namespace

/// The first feature turns about the z-axis by 60 .. 180 degrees, nearly (its points move on chords), the second one is
/// at a side or corner of it, or at the margin beyond, at a dyadic time; Y has an inflection.
Constructed rotation(Construction c) {
  constexpr std::array<Point, 5> turns = {{{0.5, 0.875, 0}, {0, 1, 0}, {-0.5, 0.875, 0}, {-0.875, 0.5, 0}, {-1, 0, 0}}};
  for (int attempt = 0; attempt < 50; ++attempt) {
    const Point turn = turns[static_cast<std::size_t>(c.random.integer(0, 4))];
    for (std::size_t i = 0; i < 4; ++i) {
      const Point p = c.coarse_at(c.coarse());
      const bool turning = i >= c.first(0) && i < c.first(0) + c.first_size();
      Point end{turn.x * p.x - turn.y * p.y, turn.y * p.x + turn.x * p.y, p.z};
      if (!turning) end = c.coarse_at(c.coarse());
      c.set(i, p, end);
    }
    NearContact contact;
    contact.t = 0.125 * c.random.integer(1, 7);
    contact.s = 0.25 * c.random.integer(0, 4);
    contact.q = c.kind == Kind::vertex_face ? 1 - contact.s : 0.25 * c.random.integer(0, 4);
    if (c.kind == Kind::edge_edge) contact.s = c.random.integer(0, 1);
    const Point inside =
        c.kind == Kind::vertex_face ? c.query.at(1, contact.t) : c.query.at(contact.s == 0 ? 1 : 0, contact.t);
    const Point at = c.kind == Kind::vertex_face
                         ? contact.s * c.query.at(2, contact.t) + contact.q * c.query.at(3, contact.t)
                         : c.query.at(contact.s == 0 ? 0 : 1, contact.t);
    const Point outwards = at - inside;  // away from what the side or end belongs to
    contact.offset.x = outwards.x > 0 ? c.gap : -c.gap;
    contact.offset.y = outwards.y > 0 ? c.gap : -c.gap;
    contact.offset.z = outwards.z > 0 ? c.gap : -c.gap;
    bring_near(c.kind, contact, c.query);
    if (has_inflection(c.query)) break;
  }
  return {c.query, c.touches ? std::optional(true) : std::nullopt};
}

/// The second feature's point moves by 2^-997 .. 2^498 through the origin. Either in the plane z = 0, where the first
/// feature has one corner, at the origin or below it; or across the plane z = 0, in which the first feature has a side
/// on the line y = 0, or y = -gap, and lies at y <= that. The gap is of the displacement's size or up to 2^60 smaller.
Constructed displacements(Kind kind, Random& random) {
  Construction c(kind, random, 45);
  const int exponent = random.integer(-996, 497);
  const double size = std::ldexp(1.0, exponent);
  if (!c.touches) c.gap = std::ldexp(1.0, std::max(exponent - random.integer(0, 60), -1060));
  const double t = c.time();
  const bool across = random.chance(0.5);
  Point u;
  u.x = size * c.coarse_not_zero();
  u.y = size * c.coarse();
  if (across) u.z = size * c.coarse_not_zero();
  if (across) {
    c.set(c.first(0), {-1, -c.gap, 0}, {-1, -c.gap, 0});
    c.set(c.first(1), {0.5, -c.gap, 0}, {0.5, -c.gap, 0});
    if (kind == Kind::vertex_face) {
      const Point third{c.coarse(), -1024 - c.gap, 0};
      c.set(3, third, third);
    }
    c.pass(c.second(0), {}, {}, t, u);
    if (kind == Kind::edge_edge) {  // the whole edge at y >= 0 when it crosses: parallel to the y-axis
      c.pass(3, {0, size, 0}, {0, size, 0}, t, u);
    }
  } else {
    const Point corner{0, 0, -c.gap};
    c.set(c.first(0), corner, corner);
    c.pass(c.second(0), {}, {}, t, u);
    c.place_rest(1, 1);
    for (std::size_t i = 1; i < c.first_size(); ++i) {  // below the corner, however deep it is
      c.query.start[c.first(i)].z -= c.gap;
      c.query.end[c.first(i)].z -= c.gap;
    }
  }
  return c.done();
}

}  // namespace tightrope::ccd
