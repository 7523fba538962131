#pragma once
/// When do two moving vertices first meet?

#include <optional>

#include "tightrope/plain.h"

namespace tightrope::ccd {

/// The first contact of the two vertices in [0, t_max], exactly decided; empty: none. `points`: both at t = 0, then at
/// t = 1, 3 coordinates each. `time` is as in `Impact`: with tolerance 0 the largest double not above the first
/// contact. t_max is taken to be in [0, 1] (NaN: 1). Coordinates that are not finite: time 0.
std::optional<Impact> vertex_vertex_impact(const double* points, double tolerance, double t_max);

/// Is there contact in [0, 1]?
bool vertex_vertex_collides(const double* points);

}  // namespace tightrope::ccd
