#pragma once
/// Directions in which two features are farthest apart: what a proof of separation tries. Nothing here is a proof.

#include <array>

#include "tightrope/plain.h"

namespace tightrope::ccd {

using Vector = std::array<double, 3>;

/// The pair's points at one time, relative to the first of them.
using Positions = std::array<Vector, 4>;

/// A plane between the features, about as far from both as it can be.
struct SeparatingPlane {
  Vector normal{0, 0, 0};  ///< of length 1, about, from the first feature to the second; 0 where they touch
  double distance = 0;     ///< of the features: about the width of the slab between them, orthogonal to `normal`
  unsigned edges = 0;      ///< the edges to which the plane is parallel, a bit each (see separation_plane.cpp)
};

SeparatingPlane best_plane(Pair pair, const Positions& points);

/// A normal that turns: Bernstein coefficients of a quadratic vector, none longer than 1, about.
using TurningNormal = std::array<Vector, 3>;

/// From the one plane's normal to the other's. An edge to which both are parallel stays parallel to the plane on the
/// way.
TurningNormal turning_normal(Pair pair, const Positions& from, const SeparatingPlane& from_plane, const Positions& to,
                             const SeparatingPlane& to_plane);

/// The normal of the face, or the common normal of the edges, from the first feature to the second at first;
/// vertex-face and edge-edge.
TurningNormal common_normal(Pair pair, const Positions& from, const Positions& to);

/// Barycentric weights, as in `Impact`, of the points of the features that are nearest to each other, about.
std::array<double, 4> nearest_weights(Pair pair, const Positions& points);

}  // namespace tightrope::ccd
