#include "scenes/families.h"

namespace tightrope::ccd {
namespace {

/// Integers, on which degenerate position stays exact, or arbitrary doubles.
Query base_query(Random& random) { return random.chance(0.6) ? lattice_query(random, 4) : random_query(random); }

/// A pair of different points.
struct Pair {
  std::size_t first;
  std::size_t second;
};
Pair random_pair(Random& random) {
  const int first = random.integer(0, 3);
  const int step = random.integer(1, 3);
  return {static_cast<std::size_t>(first), static_cast<std::size_t>((first + step) % 4)};
}

/// One or two points coincide with others, at t = 0, at t = 1 or always: zero-length edges, collapsed triangles,
/// contacts.
Query coincident_points(Random& random) {
  Query query = base_query(random);
  const int pairs = random.integer(1, 2);
  for (int i = 0; i < pairs; ++i) {
    const Pair pair = random_pair(random);
    const int when = random.integer(0, 3);
    if (when != 1) query.start[pair.first] = query.start[pair.second];
    if (when != 0) query.end[pair.first] = query.end[pair.second];
  }
  return query;
}

/// At each of the two times all points, or all but one, on a line.
Query collinear_points(Random& random) {
  Query query = lattice_query(random, 3);
  const int left_out = random.integer(-4, 3);
  const bool same_line = random.chance(0.3);
  for (auto* points : {&query.start, &query.end}) {
    const Point origin = same_line ? query.start[0] : (*points)[0];
    const Point direction = same_line ? query.start[1] - query.start[0] : (*points)[1] - (*points)[0];
    for (int i = 0; i < 4; ++i) {
      const int steps = random.integer(-4, 4);
      if (i != left_out) (*points)[static_cast<std::size_t>(i)] = origin + steps * direction;
    }
  }
  return query;
}

/// All points move in one plane z = a x + b y + c of integer coefficients: Y vanishes identically.
Query coplanar_motion(Random& random) {
  Query query = lattice_query(random, 4);
  const int a = random.integer(-3, 3);
  const int b = random.integer(-3, 3);
  const int c = random.integer(-3, 3);
  for (auto* points : {&query.start, &query.end}) {
    for (Point& point : *points) point.z = a * point.x + b * point.y + c;
  }
  return query;
}

/// Contact, exact on the lattice, at t = 0, 1/2 or 1, at dyadic weights: corners, midpoints, interior.
Query contact_at_special_time(Kind kind, Random& random) {
  Query query = base_query(random);
  NearContact contact;
  contact.t = 0.5 * random.integer(0, 2);
  contact.s = 0.25 * random.integer(0, 4);
  contact.q = kind == Kind::vertex_face ? (random.chance(0.5) ? 1 - contact.s : (1 - contact.s) / 2)
                                        : 0.25 * random.integer(0, 4);
  bring_near(kind, contact, query);
  return query;
}

Query nothing_moves(Kind kind, Random& random) {
  Query query = base_query(random);
  query.end = query.start;
  if (random.chance(0.5)) bring_near(kind, {.t = 0, .s = 0.25, .q = 0.5, .offset = {}}, query);
  return query;
}

}  // namespace

Query degenerate_query(Kind kind, Random& random) {
  switch (random.integer(0, 4)) {
    case 0:
      return coincident_points(random);
    case 1:
      return collinear_points(random);
    case 2:
      return coplanar_motion(random);
    case 3:
      return contact_at_special_time(kind, random);
    default:
      return nothing_moves(kind, random);
  }
}

}  // namespace tightrope::ccd
