#pragma once
/// When does a moving vertex first touch a moving edge, in space and in the plane?

#include <optional>

#include "tightrope/plain.h"

namespace tightrope::ccd {

/// The first contact of the vertex with the closed edge in [0, t_max], exactly decided; empty: none. `points`: vertex
/// and edge's ends at t = 0, then at t = 1, 3 coordinates each. `time` is as in `Impact`: with tolerance 0 the largest
/// double not above the first contact. t_max is taken to be in [0, 1] (NaN: 1). Coordinates that are not finite: time
/// 0.
std::optional<Impact> vertex_edge_impact(const double* points, double tolerance, double t_max);

/// The same in the plane: 2 coordinates a point.
std::optional<Impact> vertex_edge_impact_2d(const double* points, double tolerance, double t_max);

/// Is there contact in [0, 1]?
bool vertex_edge_collides(const double* points);
bool vertex_edge_collides_2d(const double* points);

}  // namespace tightrope::ccd
