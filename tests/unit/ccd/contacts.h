#pragma once
/// Queries that truly touch, by construction: all coordinates, weights and times are dyadic numbers of few bits, so
/// that the points of contact are exact in double.

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>

#include "tightrope/ccd.h"

namespace tightrope::ccd::test {

using Query = std::array<double, 24>;
using Vector = std::array<double, 3>;

/// The query in another precision; false if that changes a coordinate.
template <class Real>
bool represent(const Query& query, std::array<Real, 24>& points) {
  bool exact = true;
  for (std::size_t i = 0; i < query.size(); ++i) {
    points[i] = static_cast<Real>(query[i]);
    exact = exact && static_cast<double>(points[i]) == query[i];
  }
  return exact;
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  /// A whole number in [low, high].
  int whole(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool chance(int percent) { return whole(0, 99) < percent; }
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_;
};

inline Vector mix(const Vector& x, const Vector& y, double s) {  // exact for the numbers used here
  Vector result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = x[i] + s * (y[i] - x[i]);
  return result;
}

struct Motion {
  Vector t0, t1;
  Vector at(double t) const { return mix(t0, t1, t); }
};

/// Makes contacts. Every family of degeneracy has its share: contact at a vertex, an edge or an end, at t = 0 or 1,
/// static points, coincident and collinear points, motion in a plane, few bits (many exact zeros) and many bits.
class ContactGenerator {
 public:
  explicit ContactGenerator(std::uint64_t seed) : random_(seed) {}

  Query contact(Kind kind) {
    static constexpr std::array<int, 4> magnitudes{1, 2, 16, 1 << 20};
    magnitude_ = magnitudes[static_cast<std::size_t>(random_.whole(0, 3))];
    flat_ = random_.chance(15);
    static_ = random_.chance(20);
    collinear_ = random_.chance(10);
    const double time = 1.0 / (1 << random_.whole(0, 3));
    std::array<Motion, 4> points;
    switch (kind) {
      case Kind::vertex_face:
        points = vertex_face_contact(time);
        break;
      case Kind::edge_edge:
        points = edge_edge_contact(time);
        break;
    }
    if (random_.chance(50)) {  // contact at 1 - time: also at 0
      for (Motion& point : points) std::swap(point.t0, point.t1);
    }
    Query query;
    for (std::size_t i = 0; i < 4; ++i) {
      std::copy_n(points[i].t0.data(), 3, query.data() + 3 * i);
      std::copy_n(points[i].t1.data(), 3, query.data() + 12 + 3 * i);
    }
    return query;
  }

  Random& random() { return random_; }

 private:
  Vector position() {
    Vector x;
    for (double& coordinate : x) coordinate = random_.whole(-magnitude_, magnitude_);
    if (flat_) x[2] = 3 * magnitude_;
    if (collinear_) x[0] = x[1] = x[2];
    return x;
  }

  Motion motion() {
    const Vector start = position();
    return {start, static_ && random_.chance(70) ? start : position()};
  }

  /// A motion that is at `target` at the given time, a power of two.
  Motion motion_through(const Vector& target, double time) {
    Motion result{position(), target};
    for (std::size_t i = 0; i < 3; ++i) {
      if (static_ && time == 1) result.t0[i] = target[i];
      result.t1[i] = result.t0[i] + (target[i] - result.t0[i]) / time;
    }
    return result;
  }

  double weight() {  // often an end
    static constexpr std::array<double, 8> weights{0, 0, 1, 1, 0.5, 0.25, 0.75, 0.375};
    return weights[static_cast<std::size_t>(random_.whole(0, 7))];
  }

  std::array<Motion, 4> vertex_face_contact(double time) {
    Motion a = motion(), b = random_.chance(10) ? a : motion(), c = random_.chance(10) ? b : motion();
    const Vector on_edge = mix(b.at(time), c.at(time), weight());
    return {motion_through(mix(a.at(time), on_edge, weight()), time), a, b, c};
  }

  std::array<Motion, 4> edge_edge_contact(double time) {
    Motion a = motion(), b = random_.chance(10) ? a : motion();
    const Vector target = mix(a.at(time), b.at(time), weight());
    Motion c = motion();
    const int place = random_.whole(0, 4);  // the target is c, or beyond it by a factor of 1, 2, 4 or 8
    if (place == 0) return {a, b, motion_through(target, time), random_.chance(20) ? a : motion()};
    const Vector d = mix(c.at(time), target, 1 << (place - 1));
    return {a, b, c, motion_through(d, time)};
  }

  Random random_;
  int magnitude_ = 1;
  bool flat_ = false, static_ = false, collinear_ = false;
};

/// A query without contact: the vertex (the first edge) stays apart from the rest in x and in y.
inline Query miss(Kind kind, Random& random) {
  Query query;
  for (std::size_t point = 0; point < 8; ++point) {
    const bool first = point % 4 == 0 || (kind == Kind::edge_edge && point % 4 == 1);
    for (std::size_t i = 0; i < 3; ++i) query[3 * point + i] = 2 * random.unit() - 1 + (first && i < 2 ? 2.5 : 0);
  }
  return query;
}

}  // namespace tightrope::ccd::test
