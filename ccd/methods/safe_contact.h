#pragma once
/// Where the features touch first: SafeCCD's barycentric weights, for callers that respond to collisions.
///
/// The weights are floating-point estimates of what is at the middle of the interval of the contact; the interval's
/// left end is a bound. Who includes this includes the generated headers first.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "ccd/methods/safe_query.h"
#include "tightrope/contact.h"

namespace tightrope::generated {
template <class Bound, class Real>
struct safe_face_weights;
template <class Bound, class Real>
struct safe_edge_weights;
template <class Bound, class Real>
struct safe_projection;
template <class Bound, class Real>
struct safe_distance;
template <class Bound, class Real>
struct safe_position;
}  // namespace tightrope::generated

namespace tightrope::ccd::safe {

template <class Real>
using Position = std::array<Real, 3>;

template <class Real>
Position<Real> position(const MovingPoint<Real>& p, Real t) {
  const auto at_t = generated::safe_position<bound::none, Real>::evaluate_in_range(p.t0, p.t1, t);
  return {at_t.x[0].value, at_t.x[1].value, at_t.x[2].value};
}

/// The vertex-edge test's answer: the weight r of b in the point a + r (b - a) of the edge nearest to p. A zero-length
/// edge is its vertex a.
template <class Real>
struct NearestOnEdge {
  Real r = 0;
  Real squared_distance = 0;
};

template <class Real>
NearestOnEdge<Real> nearest_on_edge(const Position<Real>& p, const Position<Real>& a, const Position<Real>& b) {
  const auto line = generated::safe_projection<bound::none, Real>::evaluate_in_range(p.data(), a.data(), b.data());
  const Real r = line.along.value / line.square.value;
  NearestOnEdge<Real> nearest;
  nearest.r = r > 0 ? std::min(r, Real(1)) : 0;  // 0 for NaN
  const auto distance =
      generated::safe_distance<bound::none, Real>::evaluate_in_range(p.data(), a.data(), b.data(), nearest.r);
  nearest.squared_distance = distance.square.value;
  return nearest;
}

/// Brings the weights of one simplex to [0, 1] and to sum 1. False if they are off by more than rounding explains
/// (sqrt(eps)): the normal is then too small, or the middle of the interval too far from the contact, to give weights.
template <class Real>
bool normalise_weights(Real* weights, std::size_t count) {
  const Real noise = std::sqrt(std::numeric_limits<Real>::epsilon());
  Real sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!(weights[i] >= -noise && weights[i] <= 1 + noise)) return false;
    weights[i] = std::clamp(weights[i], Real(0), Real(1));
    sum += weights[i];
  }
  if (!(std::abs(sum - 1) <= static_cast<Real>(count) * noise)) return false;
  for (std::size_t i = 0; i < count; ++i) weights[i] = std::min(weights[i] / sum, Real(1));
  return true;
}

/// Weights by the normal; none where it degenerates: where |n|^2 is not certainly positive, or too small to tell.
template <class Real>
std::optional<std::array<Real, 4>> weights_by_normal(Kind kind, const Moments<Real>& moments) {
  Bounded<Real> m[4][3];
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) m[i][axis] = moments[axis][i][1];
  }
  std::array<Real, 4> weights{1, 0, 0, 0};
  const auto finish = [&](const Bounded<Real>& square, const Bounded<Real>* w, std::size_t first,
                          std::size_t count) -> std::optional<std::array<Real, 4>> {
    if (sign(square) != Sign::positive) return std::nullopt;
    for (std::size_t i = 0; i < count; ++i) weights[first + i] = w[i].value / square.value;
    const bool normal = kind == Kind::vertex_face
                            ? normalise_weights(&weights[1], 3)
                            : normalise_weights(&weights[0], 2) && normalise_weights(&weights[2], 2);
    return normal ? std::optional(weights) : std::nullopt;
  };
  if (kind == Kind::vertex_face) {
    const auto n = generated::safe_face_weights<bound::tight, Real>::evaluate_in_range(m[0], m[1], m[2]);
    return finish(n.square, n.w, 1, 3);
  }
  const auto n = generated::safe_edge_weights<bound::tight, Real>::evaluate_in_range(m[0], m[1], m[2], m[3]);
  return finish(n.square, n.w, 0, 4);
}

/// Weights by the nearest of a vertex and an edge: what is left where the normal degenerates. Weights are in the order
/// of `x`.
template <class Real>
std::array<Real, 4> weights_by_vertex_edge(Kind kind, const std::array<Position<Real>, 4>& x) {
  struct Try {
    std::size_t vertex, a, b;
  };
  static constexpr std::array<Try, 3> face{{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}}};
  static constexpr std::array<Try, 4> edges{{{0, 2, 3}, {1, 2, 3}, {2, 0, 1}, {3, 0, 1}}};
  const std::span<const Try> tries =
      kind == Kind::vertex_face ? std::span<const Try>(face) : std::span<const Try>(edges);
  std::array<Real, 4> weights{};
  Real least = std::numeric_limits<Real>::infinity();
  for (const Try& t : tries) {
    const NearestOnEdge<Real> nearest = nearest_on_edge(x[t.vertex], x[t.a], x[t.b]);
    if (!(nearest.squared_distance < least)) continue;
    least = nearest.squared_distance;
    weights = {};
    weights[t.vertex] = 1;
    weights[t.a] = 1 - nearest.r;
    weights[t.b] = nearest.r;
  }
  return weights;
}

/// The first contact, or what the bounds cannot tell from one.
template <class Bound, class Real, class Signs>
std::optional<Contact<Real>> contact(Kind kind, const Real* points, Signs& signs) {
  using Result = std::optional<Contact<Real>>;
  const Result always = Contact<Real>{
      0, 1, kind == Kind::vertex_face ? std::array<Real, 4>{1, 1, 0, 0} : std::array<Real, 4>{1, 0, 1, 0}};
  if (culled(kind, points, signs)) return std::nullopt;
  return unculled(kind, points, signs, Result{}, always, [&](const Real* prepared, bool scaled) -> Result {
    Decision<Bound, Real, Signs> decision(kind, prepared, scaled, signs);
    const auto part = decision.first_contact();
    if (!part) return std::nullopt;
    auto weights = weights_by_normal(kind, decision.moments_on(*part));
    const Real middle = part->l + (part->r - part->l) / 2;
    std::array<Position<Real>, 4> x;
    for (std::size_t i = 0; i < 4; ++i) x[i] = position(decision.names().x[i], middle);
    if (!weights) weights = weights_by_vertex_edge(kind, x);
    Contact<Real> found{part->l, part->r, {}};
    for (std::size_t i = 0; i < 4; ++i) found.weights[decision.names().index[i]] = (*weights)[i];
    return found;
  });
}

}  // namespace tightrope::ccd::safe
