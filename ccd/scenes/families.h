#pragma once
/// The families of single queries that scene.cpp puts together. Coordinates are of size 1 unless said otherwise.

#include "scenes/point.h"
#include "scenes/random.h"
#include "tightrope/ccd.h"

namespace tightrope::ccd {

/// All coordinates uniform in [-1, 1].
Query random_query(Random& random);

/// Small integers: many contacts in degenerate position.
Query lattice_query(Random& random, int size);

// near_contact.cpp: motions through a chosen near-contact

/// Moves the vertex (the second edge) so that near time t it is at `weights` of the face (at parameter `s` of the first
/// and `q` of the second edge), plus `offset`. Exact but for rounding.
struct NearContact {
  double t = 0;
  double s = 0;  ///< vertex-face: weight of f1; edge-edge: parameter on ea0 ea1
  double q = 0;  ///< vertex-face: weight of f2; edge-edge: parameter on eb0 eb1
  Point offset{};
};
void bring_near(Kind kind, const NearContact& contact, Query& query);

/// At a random time in [0, 1] and random parameters: half of the time contact, else 2^-50 .. 2^-4 beside it.
void bring_near(Kind kind, Random& random, Query& query);

/// A vertex passes within 2^-53 .. 2^-9 of an edge or a vertex of the face, or meets the face within that of t = 0 or
/// 1; an edge passes so close to an end of the other, or to both.
Query grazing_query(Kind kind, Random& random);

/// Relative motion along the face (along both edges) at a time of near-contact: Y has an almost double root.
Query tangent_query(Kind kind, Random& random);

/// Displacements of size 2^-50 .. 2^-6, half of them near a contact.
Query slow_query(Kind kind, Random& random);

/// All points at a distance of 2^-60 .. 2^-10 from a moving plane.
Query near_coplanar_query(Kind kind, Random& random);

/// Triangles (edges) of width 2^-40 .. 2^-4 (almost parallel), near a contact.
Query needle_query(Kind kind, Random& random);

/// One of the above: what tiny, huge, far and single transform.
Query mixed_query(Kind kind, Random& random);

// degenerate.cpp

/// Coincident points, zero-length features, collinear or coplanar motion, nothing moving, contact at t = 0, 1/2, 1.
Query degenerate_query(Kind kind, Random& random);

}  // namespace tightrope::ccd
