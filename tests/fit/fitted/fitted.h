#pragma once
/// Collision queries fitted to a scene by `tightrope-ccd fit`: a first look that takes for granted what holds in
/// the scene, and tests it; the full query behind it. Queries unlike those of the scene get the full query, so
/// that no contact is missed wherever they come from. `points` as in <tightrope/ccd.h>.

#include <tightrope/ccd.h>
#include <tightrope/impact.h>

#include <cstddef>
#include <optional>

/// First look: double, range 2^-6, face at rest. Behind it: method tightrope.
bool fitted_vertex_face(const double* points);
void fitted_vertex_face(const double* points, std::size_t count, unsigned char* results);
/// As first_impact of <tightrope/impact.h>.
std::optional<tightrope::ccd::Impact> fitted_vertex_face_impact(const double* points,
    const tightrope::ccd::ImpactOptions& options = {});

/// First look: double, range 2^-6, edge at rest. Behind it: method tightrope.
bool fitted_edge_edge(const double* points);
void fitted_edge_edge(const double* points, std::size_t count, unsigned char* results);
/// As first_impact of <tightrope/impact.h>.
std::optional<tightrope::ccd::Impact> fitted_edge_edge_impact(const double* points,
    const tightrope::ccd::ImpactOptions& options = {});
