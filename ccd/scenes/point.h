#pragma once
/// Points and queries while they are made.

#include <array>
#include <cmath>

namespace tightrope::ccd {

struct Point {
  double x = 0;
  double y = 0;
  double z = 0;
};

inline Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Point operator*(double s, const Point& a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Of length 1, or 0 for 0.
inline Point normalized(const Point& a) {
  const double length = std::sqrt(dot(a, a));
  return length > 0 ? 1 / length * a : Point{};
}

/// The eight points of a query: `start` at t = 0, `end` at t = 1, each in the order of Kind.
struct Query {
  std::array<Point, 4> start;
  std::array<Point, 4> end;

  Point at(int point, double t) const {
    const auto i = static_cast<std::size_t>(point);
    return (1 - t) * start[i] + t * end[i];
  }
  /// Moves a point's whole trajectory.
  void translate(int point, const Point& by) {
    const auto i = static_cast<std::size_t>(point);
    start[i] = start[i] + by;
    end[i] = end[i] + by;
  }
};

/// Replaces each coordinate x by change(x).
template <class Change>
void for_each_coordinate(Query& query, Change change) {
  for (auto* points : {&query.start, &query.end}) {
    for (Point& point : *points) {
      point.x = change(point.x);
      point.y = change(point.y);
      point.z = change(point.z);
    }
  }
}

}  // namespace tightrope::ccd
