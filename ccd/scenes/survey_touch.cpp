#include <utility>

#include "scenes/survey.h"

namespace tightrope::ccd {

Point Construction::coarse_at(double z) {
  Point point;
  point.x = coarse();
  point.y = coarse();
  point.z = z;
  return point;
}

void Construction::place_rest(std::size_t i, std::size_t j) {
  const auto place = [&](std::size_t point, double sign) {
    const Point start = coarse_at(sign * coarse_positive());
    set(point, start, coarse_at(sign * coarse_positive()));
  };
  for (; i < first_size(); ++i) place(first(i), -1);
  for (; j < second_size(); ++j) place(second(j), 1);
}

/// All in the plane z = 0. A line with normal w has the first feature weakly on one side at all times, touching it in a
/// corner at rest; the second feature weakly on the other side, one point running along the line through that corner,
/// or beside it.
Constructed coplanar(Construction c) {
  Point w;
  while (w.x == 0 && w.y == 0) {
    w.x = c.random.integer(-3, 3);
    w.y = c.random.integer(-3, 3);
  }
  const auto on_side = [&](const Point& corner, double sign) {  // a random point with sign * w.(point - corner) >= 0
    const Point point = c.coarse_at(0);
    const Point from = point - corner;
    return sign * dot(w, from) >= 0 ? point : corner - from;
  };
  const Point corner = c.coarse_at(0);
  c.set(c.first(0), corner, corner);
  for (std::size_t i = 1; i < c.first_size(); ++i) {
    const Point start = on_side(corner, -1);
    c.set(c.first(i), start, on_side(corner, -1));
  }
  const Point outwards = w.x != 0 ? Point{w.x > 0 ? 1.0 : -1.0, 0, 0} : Point{0, w.y > 0 ? 1.0 : -1.0, 0};
  const Point near = corner + c.gap * outwards;
  const double speed = c.coarse_not_zero();
  c.pass(c.second(0), near, near, c.time(), {-speed * w.y, speed * w.x, 0});
  for (std::size_t j = 1; j < c.second_size(); ++j) {
    const Point start = on_side(c.query.start[c.second(0)], 1);
    c.set(c.second(j), start, on_side(c.query.end[c.second(0)], 1));
  }
  return c.done();
}

/// A side of the first feature lies on the x-axis; a point of the second one stays on that line, or beside it: either
/// within the side or up to its end at t = 1. The other end of a second edge is above, or on the line too.
Constructed sliding(Construction c) {
  const double left = -c.coarse_positive();
  const double right = c.coarse_positive();
  c.set(c.first(0), {left, 0, 0}, {left, 0, 0});
  c.set(c.first(1), {right, 0, 0}, {right, 0, 0});
  c.place_rest(2, 1);
  Point start{left - c.coarse_positive(), 0, 0};
  Point end{left - c.gap, 0, 0};
  if (c.random.chance(0.5)) {  // within
    start = {0.5 * left, 0, c.gap};
    end = {0.5 * right, 0, c.gap};
    if (c.random.chance(0.5)) std::swap(start.y, start.z), std::swap(end.y, end.z);
  }
  if (c.random.chance(0.5)) std::swap(start, end);
  c.set(c.second(0), start, end);
  if (c.second_size() == 2 && c.random.chance(0.4)) {
    const Point behind{-c.coarse_positive(), 0, 0};
    c.set(c.second(1), start + behind, end + behind);
  }
  return c.done();
}

/// A corner of the first feature, the only point of it at z = 0, and one of the second; one passes through the other,
/// in the plane z = 0 or beside it.
Constructed through_vertex(Construction c) {
  const Point start = c.coarse_at(0);
  const Point end = c.coarse_at(0);
  c.set(c.first(0), start, end);
  Point u;
  u.x = c.coarse_not_zero();
  u.y = c.coarse();
  Point beside{0, c.gap, 0};  // not along u
  if (c.random.chance(0.5)) std::swap(beside.y, beside.z);
  c.pass(c.second(0), start + beside, end + beside, c.time(), u);
  c.place_rest(1, 1);
  return c.done();
}

/// A side of the first feature moves at z = 0, a point of the second feature passes through it there, or above.
Constructed through_edge(Construction c) {
  std::array<Point, 2> start{};
  std::array<Point, 2> end{};
  for (std::size_t i = 0; i < 2; ++i) {
    start[i] = c.coarse_at(0);
    end[i] = c.coarse_at(0);
    c.set(c.first(i), start[i], end[i]);
  }
  const double s = 0.125 * c.random.integer(1, 7);
  const Point up{0, 0, c.gap};
  const Point u = c.coarse_at(0);
  const double t = c.time();
  c.pass(c.second(0), (1 - s) * start[0] + s * start[1] + up, (1 - s) * end[0] + s * end[1] + up, t, u);
  c.place_rest(2, 1);
  return c.done();
}

namespace {

/// Both features in the plane z = 0, a common point at dyadic weights (corners and sides among them), the second one
/// lifted by the gap.
std::array<Point, 4> flat_contact(Construction& c) {
  std::array<Point, 4> points{};
  for (Point& point : points) point = c.coarse_at(0);
  const double s = 0.25 * c.random.integer(0, 4);
  if (c.kind == Kind::vertex_face) {
    const double q = c.random.chance(0.5) ? 1 - s : 0.5 * (1 - s);
    points[0] = (1 - s - q) * points[1] + s * points[2] + q * points[3];
    points[0].z = c.gap;
    return points;
  }
  const double inverse_q = c.random.integer(0, 2) == 0 ? 4 : c.random.integer(1, 2);  // parameter 1, 1/2, 1/4
  const Point contact = (1 - s) * points[0] + s * points[1];
  points[3] = points[2] + inverse_q * (contact - points[2]);
  points[2].z = points[3].z = c.gap;
  return points;
}

}  // namespace

/// Features in contact at t = 0 or at t = 1, apart before or after.
Constructed step_ends(Construction c) {
  c.place_rest(0, 0);
  (c.random.chance(0.5) ? c.query.start : c.query.end) = flat_contact(c);
  return c.done();
}

/// Nothing moves.
Constructed at_rest(Construction c) {
  c.query.start = flat_contact(c);
  c.query.end = c.query.start;
  return c.done();
}

}  // namespace tightrope::ccd
