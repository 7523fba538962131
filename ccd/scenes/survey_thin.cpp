#include <utility>

#include "scenes/survey.h"

namespace tightrope::ccd {
namespace {

/// A velocity that leaves the plane z = 0.
Point upwards(Construction& c) {
  Point u;
  u.x = c.coarse();
  u.y = c.coarse();
  u.z = c.coarse_not_zero();
  return u;
}

void rest(Construction& c, std::size_t point, const Point& at) { c.set(point, at, at); }

}  // namespace

/// A side of the first feature on the x-axis, up to x = end; at one time a point of the second feature (a whole
/// parallel edge) is on that line, at its end or beyond by the gap, or overlapping by the margin. A face has y <= 0.
Constructed parallel_edges(Construction c) {
  const double end = c.coarse();
  rest(c, c.first(0), {end - c.coarse_positive(), 0, 0});
  rest(c, c.first(1), {end, 0, 0});
  double x = end + c.gap;
  if (c.touches && c.random.chance(0.3)) x -= c.margin;
  const double t = c.time();
  const Point u = upwards(c);
  c.pass(c.second(0), {x, 0, 0}, {x, 0, 0}, t, u);
  if (c.kind == Kind::vertex_face) {
    rest(c, c.first(2), {c.coarse(), -c.coarse_positive(), 0});
  } else {
    const double far = x + c.coarse_positive();
    c.pass(c.second(1), {far, 0, 0}, {far, 0, 0}, t, u);
  }
  return c.done();
}

namespace {

/// The face is a segment on the x-axis; the vertex passes through its end, or beyond.
void flat_face(Construction& c) {
  const double left = -c.coarse_positive();
  const double right = c.coarse_positive();
  rest(c, 1, {left, 0, 0});
  rest(c, 2, {right, 0, 0});
  c.set(3, {0.5 * left, 0, 0}, {0.5 * right, 0, 0});
  Point through{right + c.gap, 0, 0};
  const Point u = upwards(c);
  if (c.random.chance(0.5)) through = {0.25 * left, c.gap * u.z, -c.gap * u.y};  // beside the plane of x-axis and u
  c.pass(0, through, through, c.time(), u);
}

/// A face of height 2^-45 .. 2^-4 over a side on the x-axis; the vertex passes through that side, or beside it.
void needle(Construction& c) {
  const double height = std::ldexp(1.0, c.random.integer(-c.finest, -4));
  rest(c, 1, {-c.coarse_positive(), 0, 0});
  rest(c, 2, {c.coarse_positive(), 0, 0});
  rest(c, 3, {c.coarse(), height, 0});
  const Point through{0, -c.gap, 0};
  c.pass(0, through, through, c.time(), upwards(c));
}

/// Both edges on the x-axis at one time, one after the other; the second one turns out of it.
void aligned_edges(Construction& c) {
  const double end = c.coarse();
  rest(c, 0, {end - c.coarse_positive(), 0, 0});
  rest(c, 1, {end, 0, 0});
  const Point near{end + c.gap, 0, 0};
  const Point far{near.x + c.coarse_positive(), 0, 0};
  const Point u = upwards(c);
  Point v = upwards(c);
  v.z = u.z * (v.z > 0 ? v.z : -v.z);  // both ends on one side of z = 0 at every other time
  const double t = c.time();
  c.pass(2, near, near, t, u);
  c.pass(3, far, far, t, v);
}

/// The second edge crosses the x-axis at x = 0 with a slope of 2^-45 .. 2^-4, the first one begins there or beyond.
void almost_parallel_edges(Construction& c) {
  const double slope = std::ldexp(1.0, c.random.integer(-c.finest, -4));
  rest(c, 0, {c.gap, 0, 0});
  rest(c, 1, {c.gap + c.coarse_positive(), 0, 0});
  const Point before{-1, -slope, 0};
  const Point after{1, slope, 0};
  const Point u = upwards(c);
  const double t = c.time();
  c.pass(2, before, before, t, u);
  c.pass(3, after, after, t, u);
}

}  // namespace

Constructed zero_area(Construction c) {
  const bool flat = c.random.chance(0.5);
  if (c.kind == Kind::vertex_face) {
    (flat ? flat_face : needle)(c);
  } else {
    (flat ? aligned_edges : almost_parallel_edges)(c);
  }
  return c.done();
}

/// Of length zero: an edge of the face or both of its, one edge or both, for the whole step or at t = 0 only. What is
/// left is a point that passes through a segment on the x-axis (or a point at 0), or beside it.
Constructed zero_length(Construction c) {
  const bool segment = c.random.chance(0.7);
  const double left = segment ? -c.coarse_positive() : 0;
  const double right = segment ? c.coarse_positive() : 0;
  if (c.random.chance(0.2) && c.kind == Kind::edge_edge) {  // the first edge opens at t = 0 over the second one
    const Point from{0.25 * (left + right), 0, c.gap};
    for (const std::size_t end : {0U, 1U}) c.set(end, from, c.coarse_at(c.coarse_positive()));
  } else {
    Point through{c.random.chance(0.5) ? right : 0.25 * left, 0, 0};
    const Point u = upwards(c);
    through = through + Point{0, c.gap * u.z, -c.gap * u.y};
    const double t = c.time();
    c.pass(0, through, through, t, u);
    if (c.kind == Kind::edge_edge) c.pass(1, through, through, t, u);
  }
  const std::size_t other = c.kind == Kind::vertex_face ? 1 : 2;
  rest(c, other, {left, 0, 0});
  rest(c, other + 1, {right, 0, 0});
  if (c.kind == Kind::vertex_face) rest(c, 3, {c.random.chance(0.5) ? left : right, 0, 0});
  return c.done();
}

}  // namespace tightrope::ccd
