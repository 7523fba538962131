#include "scenes/families.h"

namespace tightrope::ccd {
namespace {

Point random_point(Random& random) {
  Point point;
  point.x = random.between(-1, 1);
  point.y = random.between(-1, 1);
  point.z = random.between(-1, 1);
  return point;
}

/// A direction of length 1, far enough from 0 before the division.
Point random_direction(Random& random) {
  while (true) {
    const Point point = random_point(random);
    if (dot(point, point) > 0.01) return normalized(point);
  }
}

/// Weights of a random point of the triangle's interior, or parameters on two segments.
void random_weights(Kind kind, Random& random, NearContact& contact) {
  contact.s = random.uniform();
  contact.q = random.uniform();
  if (kind == Kind::vertex_face && contact.s + contact.q > 1) {
    contact.s = 1 - contact.s;
    contact.q = 1 - contact.q;
  }
}

/// Edges of the face (of both segments) that span the contact plane at time t.
struct Directions {
  Point first;
  Point second;
};

Directions directions(Kind kind, const Query& query, double t) {
  if (kind == Kind::vertex_face) return {query.at(2, t) - query.at(1, t), query.at(3, t) - query.at(1, t)};
  return {query.at(1, t) - query.at(0, t), query.at(3, t) - query.at(2, t)};
}

/// A point on the edge from f1 to f2, or at f1, moved by `distance` in the plane of the face, away from the edge.
void graze_face(Random& random, double distance, const Query& query, NearContact& contact) {
  const bool at_vertex = random.chance(0.3);
  contact.s = at_vertex ? 1 : random.uniform();
  contact.q = 1 - contact.s;
  const Point edge = query.at(3, contact.t) - query.at(2, contact.t);
  const Point normal = cross(edge, query.at(1, contact.t) - query.at(2, contact.t));
  const Point outwards = at_vertex ? random_direction(random) : normalized(cross(edge, normal));
  contact.offset = distance * outwards;
}

/// The second edge's interior, or one end of it, at `distance` before or behind an end of the first edge.
void graze_end(Random& random, double distance, const Query& query, NearContact& contact) {
  const bool at_both_ends = random.chance(0.3);
  contact.s = random.chance(0.5) ? 0 : 1;
  contact.q = at_both_ends ? random.integer(0, 1) : random.uniform();
  const Point edge = query.at(1, contact.t) - query.at(0, contact.t);
  contact.offset = distance * (at_both_ends ? random_direction(random) : normalized(edge));
}

}  // namespace

Query random_query(Random& random) {
  Query query;
  for_each_coordinate(query, [&](double) { return random.between(-1, 1); });
  return query;
}

Query lattice_query(Random& random, int size) {
  Query query;
  for_each_coordinate(query, [&](double) { return static_cast<double>(random.integer(-size, size)); });
  return query;
}

void bring_near(Kind kind, const NearContact& contact, Query& query) {
  const double t = contact.t;
  if (kind == Kind::vertex_face) {
    const Point target = (1 - contact.s - contact.q) * query.at(1, t) + contact.s * query.at(2, t) +
                         contact.q * query.at(3, t) + contact.offset;
    query.translate(0, target - query.at(0, t));
    return;
  }
  const Point target = (1 - contact.s) * query.at(0, t) + contact.s * query.at(1, t) + contact.offset;
  const Point now = (1 - contact.q) * query.at(2, t) + contact.q * query.at(3, t);
  query.translate(2, target - now);
  query.translate(3, target - now);
}

void bring_near(Kind kind, Random& random, Query& query) {
  NearContact contact;
  contact.t = random.uniform();
  random_weights(kind, random, contact);
  if (random.chance(0.5)) {
    const double distance = random.magnitude(-50, -4);
    contact.offset = distance * random_direction(random);
  }
  bring_near(kind, contact, query);
}

Query grazing_query(Kind kind, Random& random) {
  Query query = random_query(random);
  const double distance = random.magnitude(-53, -10);
  NearContact contact;
  contact.t = random.uniform();
  if (random.chance(0.2)) {
    random_weights(kind, random, contact);
    contact.t = random.integer(0, 1) + distance;
  } else if (kind == Kind::vertex_face) {
    graze_face(random, distance, query, contact);
  } else {
    graze_end(random, distance, query, contact);
  }
  bring_near(kind, contact, query);
  return query;
}

/// With the material point p under the vertex and d(t) = p(t) + w (t - t0): Y(t) = (t - t0) n(t).w, which has a double
/// root at t0 if w is in the plane there. The same holds for the points of two edges.
Query tangent_query(Kind kind, Random& random) {
  Query query = random_query(random);
  NearContact contact;
  contact.t = random.uniform();
  random_weights(kind, random, contact);
  const Directions plane = directions(kind, query, contact.t);
  const double along_first = random.between(-1, 1);
  const double along_second = random.between(-1, 1);
  const Point w = along_first * plane.first + along_second * plane.second;
  if (kind == Kind::vertex_face) {
    const auto material = [&](const std::array<Point, 4>& points) {
      return (1 - contact.s - contact.q) * points[1] + contact.s * points[2] + contact.q * points[3];
    };
    query.start[0] = material(query.start);
    query.end[0] = material(query.end) + w;
  } else {
    const auto distance = [&](const std::array<Point, 4>& points) {
      return (1 - contact.s) * points[0] + contact.s * points[1] - (1 - contact.q) * points[2] - contact.q * points[3];
    };
    const Point at_start = distance(query.start);
    const Point at_end = distance(query.end) + w;
    for (const std::size_t point : {std::size_t{2}, std::size_t{3}}) {
      query.start[point] = query.start[point] + at_start;
      query.end[point] = query.end[point] + at_end;
    }
  }
  contact.offset = random.magnitude(-60, -4) * normalized(cross(plane.first, plane.second));
  bring_near(kind, contact, query);
  return query;
}

Query slow_query(Kind kind, Random& random) {
  Query query = random_query(random);
  const double speed = random.magnitude(-50, -6);
  for (std::size_t i = 0; i < 4; ++i) query.end[i] = query.start[i] + speed * query.end[i];
  if (random.chance(0.5)) bring_near(kind, random, query);
  return query;
}

Query near_coplanar_query(Kind kind, Random& random) {
  Query query;
  const double height = random.magnitude(-60, -10);
  for (auto* points : {&query.start, &query.end}) {
    const Point first = random_direction(random);
    const Point second = random_direction(random);
    const Point normal = cross(first, second);
    for (Point& point : *points) {
      const double x = random.between(-1, 1);
      const double y = random.between(-1, 1);
      const double z = random.between(-1, 1);
      point = x * first + y * second + (height * z) * normal;
    }
  }
  if (random.chance(0.3)) bring_near(kind, random, query);
  return query;
}

Query needle_query(Kind kind, Random& random) {
  Query query = random_query(random);
  const double width = random.magnitude(-40, -4);
  const double along = random.between(-0.5, 1.5);
  for (auto* points : {&query.start, &query.end}) {
    const Point across = random_direction(random);
    if (kind == Kind::vertex_face) {
      (*points)[3] = (*points)[1] + along * ((*points)[2] - (*points)[1]) + width * across;
    } else {
      (*points)[3] = (*points)[2] + ((*points)[1] - (*points)[0]) + width * across;
    }
  }
  bring_near(kind, random, query);
  return query;
}

Query mixed_query(Kind kind, Random& random) {
  switch (random.integer(0, 7)) {
    case 0:
      return random_query(random);
    case 1:
      return lattice_query(random, 4);
    case 2:
      return tangent_query(kind, random);
    case 3:
      return near_coplanar_query(kind, random);
    case 4:
      return needle_query(kind, random);
    case 5:
      return degenerate_query(kind, random);
    default:
      return grazing_query(kind, random);
  }
}

}  // namespace tightrope::ccd
