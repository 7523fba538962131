/// The distance of two convex features is the largest width of a slab between them, and the best slab belongs to a
/// vertex against a segment or a triangle, or to two segments: the candidates. All are tried, and the widest wins, so
/// that no decision of the kind "is the projection inside?" has to be right where rounding blurs it.

#include "ccd/impact/separation_plane.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "ccd/impact/scaled_points.h"

namespace tightrope::ccd {
namespace {

Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector operator-(const Vector& a) { return {-a[0], -a[1], -a[2]}; }
Vector operator*(double s, const Vector& a) { return {s * a[0], s * a[1], s * a[2]}; }
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The vector with length 1; 0 stays 0. Small vectors are first made larger, so that their squares do not underflow.
Vector unit(Vector v) {
  double square = dot(v, v);
  if (square < 0x1p-900) {
    v = 0x1p600 * v;
    square = dot(v, v);
    if (square == 0) return {0, 0, 0};
  }
  return (1 / std::sqrt(square)) * v;
}

/// What is left of `v` when its part along the unit vector `q` is taken away.
Vector without(const Vector& v, const Vector& q) { return v - dot(v, q) * q; }

/// Where on the segment from a to a + e, as a fraction, is the point nearest to p?
double nearest_on_segment(const Vector& p, const Vector& a, const Vector& e) {
  const double square = dot(e, e);
  return square > 0 ? std::clamp(dot(p - a, e) / square, 0.0, 1.0) : 0;
}

/// A vertex against an edge: the vertex, the edge's ends, the edge's bit in `SeparatingPlane::edges`.
struct VertexEdge {
  std::size_t vertex, first, second;
  unsigned edge;
};
constexpr std::array<VertexEdge, 3> face_edges{{{0, 1, 2, 1}, {0, 2, 3, 2}, {0, 3, 1, 4}}};
constexpr std::array<VertexEdge, 4> edge_ends{{{0, 2, 3, 2}, {1, 2, 3, 2}, {2, 0, 1, 1}, {3, 0, 1, 1}}};
constexpr unsigned both_edges = 1 | 2, all_edges = 1 | 2 | 4;

struct Normal {
  Vector n{0, 0, 0};
  unsigned edges = 0;
};

/// From the vertex to the edge. A vector to the edge's inside is made orthogonal to it once more after it got length 1:
/// the error is relative to its length then, not to the edge's.
Normal from_vertex(const Positions& x, const VertexEdge& f) {
  const Vector a = x[f.first] - x[f.vertex], e = x[f.second] - x[f.first];
  const double r = nearest_on_segment(x[f.vertex], x[f.first], e);
  if (r == 0) return {unit(a), 0};
  if (r == 1) return {unit(x[f.second] - x[f.vertex]), 0};
  return {unit(without(unit(a - (-r) * e), unit(e))), f.edge};
}

/// Orthogonal to both, towards `side`. An orthonormal basis of the plane first: the cross product of nearly parallel
/// vectors has a large relative error.
Vector across(const Vector& u, const Vector& v, const Vector& side) {
  const Vector q = unit(u);
  const Vector rest = without(v, q);
  if (dot(rest, rest) <= 0x1p-100 * dot(v, v)) return {0, 0, 0};
  const Vector n = unit(cross(q, unit(without(unit(rest), q))));
  return dot(n, side) < 0 ? -n : n;
}

/// Number of candidates: vertex-vertex 1; vertex-edge 1; vertex-face: the three edges, the face; edge-edge: an end of
/// one against the other (4), both edges.
constexpr std::size_t candidates(Pair pair) {
  switch (pair) {
    case Pair::vertex_vertex:
    case Pair::vertex_edge:
      return 1;
    case Pair::vertex_face:
      return 4;
    case Pair::edge_edge:
      return 5;
  }
  return 0;
}

Normal candidate(Pair pair, const Positions& x, std::size_t i) {
  switch (pair) {
    case Pair::vertex_vertex:
      return {unit(x[1] - x[0]), 0};
    case Pair::vertex_edge:
      return from_vertex(x, face_edges[0]);
    case Pair::vertex_face:
      if (i == 3) return {across(x[2] - x[1], x[3] - x[1], x[1] - x[0]), all_edges};
      return from_vertex(x, face_edges[i]);
    case Pair::edge_edge: {
      if (i == 4) return {across(x[1] - x[0], x[3] - x[2], x[2] - x[0]), both_edges};
      const Normal normal = from_vertex(x, edge_ends[i]);
      return i < 2 ? normal : Normal{-normal.n, normal.edges};
    }
  }
  return {};
}

/// How far the second feature is beyond the first along n.
double width(Pair pair, const Positions& x, const Vector& n) {
  switch (pair) {
    case Pair::vertex_vertex:
      return dot(n, x[1] - x[0]);
    case Pair::vertex_edge:
      return std::min(dot(n, x[1] - x[0]), dot(n, x[2] - x[0]));
    case Pair::vertex_face:
      return std::min({dot(n, x[1] - x[0]), dot(n, x[2] - x[0]), dot(n, x[3] - x[0])});
    case Pair::edge_edge:
      return std::min({dot(n, x[2] - x[0]), dot(n, x[3] - x[0]), dot(n, x[2] - x[1]), dot(n, x[3] - x[1])});
  }
  return 0;
}

/// Bernstein coefficients of the cross product of two vectors that are linear.
TurningNormal cross(const Vector& u0, const Vector& u1, const Vector& v0, const Vector& v1) {
  return {cross(u0, v0), 0.5 * (cross(u0, v1) - cross(v0, u1)), cross(u1, v1)};
}

/// Multiplied by a common factor such that the longest has length 1.
TurningNormal scaled(const TurningNormal& w) {
  double square = 0;
  for (const Vector& c : w) square = std::max(square, dot(c, c));
  if (!(square > 0x1p-900 && square < 0x1p900)) return {};
  const double factor = 1 / std::sqrt(square);
  return {factor * w[0], factor * w[1], factor * w[2]};
}

/// The ends of the pair's edges, in the order of their bits.
struct Edge {
  std::size_t first, second;
  Vector at(const Positions& x) const { return x[second] - x[first]; }
};
Edge edge(Pair pair, std::size_t bit) {
  if (pair != Pair::edge_edge) return {face_edges[bit].first, face_edges[bit].second};
  return bit == 0 ? Edge{0, 1} : Edge{2, 3};
}

using Weights = std::array<double, 4>;

/// Weights of the point of the triangle's plane nearest to p; of a point of the triangle if that is outside.
Weights on_face(const Positions& x) {
  const Vector u = x[2] - x[1], v = x[3] - x[1], n = cross(u, v), p = x[0] - x[1];
  const double b = std::max(dot(n, cross(p, v)), 0.0), c = std::max(dot(n, cross(u, p)), 0.0);
  const double a = std::max(dot(n, n) - b - c, 0.0), sum = a + b + c;
  return sum > 0 ? Weights{1, a / sum, b / sum, c / sum} : Weights{1, 1, 0, 0};
}

/// Weights of the points of the lines nearest to each other, moved to the ends of the edges where they are beyond.
Weights on_edges(const Positions& x) {
  const Vector u = x[1] - x[0], v = x[3] - x[2], side = x[2] - x[0], n = cross(u, v);
  const double square = dot(n, n);
  const double s = square > 0 ? std::clamp(dot(n, cross(side, v)) / square, 0.0, 1.0) : 0;
  const double r = square > 0 ? std::clamp(dot(n, cross(side, u)) / square, 0.0, 1.0) : 0;
  return {1 - s, s, 1 - r, r};
}

Weights on_vertex_and_edge(const Positions& x, const VertexEdge& f) {
  const double r = nearest_on_segment(x[f.vertex], x[f.first], x[f.second] - x[f.first]);
  Weights weights{0, 0, 0, 0};
  weights[f.vertex] = 1;
  weights[f.first] = 1 - r;
  weights[f.second] = r;
  return weights;
}

/// The square of the distance of the two points.
double square_distance(Pair pair, const Positions& x, const Weights& weights) {
  Vector difference{0, 0, 0};
  for (std::size_t i = 0; i < number_of_points(pair); ++i) {
    difference = difference - (i < points_of_first(pair) ? weights[i] : -weights[i]) * x[i];
  }
  return dot(difference, difference);
}

}  // namespace

SeparatingPlane best_plane(Pair pair, const Positions& points) {
  SeparatingPlane best;
  for (std::size_t i = 0; i < candidates(pair); ++i) {
    const Normal normal = candidate(pair, points, i);
    const double distance = width(pair, points, normal.n);
    if (distance > best.distance) best = {normal.n, distance, normal.edges};
  }
  return best;
}

TurningNormal common_normal(Pair pair, const Positions& from, const Positions& to) {
  const bool face = pair == Pair::vertex_face;
  const Edge u = edge(pair, 0), v = edge(pair, 1);
  TurningNormal w = scaled(cross(u.at(from), u.at(to), v.at(from), v.at(to)));
  if (dot(w[0], from[face ? 1 : 2]) < 0) w = {-w[0], -w[1], -w[2]};
  return w;
}

TurningNormal turning_normal(Pair pair, const Positions& from, const SeparatingPlane& from_plane, const Positions& to,
                             const SeparatingPlane& to_plane) {
  const unsigned common = from_plane.edges & to_plane.edges;
  if (common == (pair == Pair::edge_edge ? both_edges : all_edges)) return common_normal(pair, from, to);
  if (common != 0) {
    // e x c with c linear, from one end's normal x e / |e|^2 to the other's: e x (w x e) = |e|^2 w where w . e = 0.
    const Edge shared = edge(pair, static_cast<std::size_t>(std::countr_zero(common)));
    const Vector e0 = shared.at(from), e1 = shared.at(to);
    return scaled(cross(e0, e1, (1 / dot(e0, e0)) * cross(from_plane.normal, e0),
                        (1 / dot(e1, e1)) * cross(to_plane.normal, e1)));
  }
  const Vector middle = 0.5 * (from_plane.normal - (-to_plane.normal));
  return {from_plane.normal, middle, to_plane.normal};
}

std::array<double, 4> nearest_weights(Pair pair, const Positions& points) {
  switch (pair) {
    case Pair::vertex_vertex:
      return {1, 1, 0, 0};
    case Pair::vertex_edge:
      return on_vertex_and_edge(points, face_edges[0]);
    case Pair::vertex_face:
    case Pair::edge_edge:
      break;
  }
  const bool face = pair == Pair::vertex_face;
  Weights nearest = face ? on_face(points) : on_edges(points);
  for (const VertexEdge& f : face ? std::span<const VertexEdge>(face_edges) : std::span<const VertexEdge>(edge_ends)) {
    const Weights weights = on_vertex_and_edge(points, f);
    if (square_distance(pair, points, weights) < square_distance(pair, points, nearest)) nearest = weights;
  }
  return nearest;
}

}  // namespace tightrope::ccd
