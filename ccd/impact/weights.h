#pragma once
/// Where features touch, as barycentric weights.

#include <array>

#include "tightrope/method.h"

namespace tightrope::ccd {

/// The weights of one vertex of each feature: 1 for the first of each.
constexpr std::array<double, 4> weights_of_first_vertices(Kind kind) {
  return kind == Kind::vertex_face ? std::array<double, 4>{1, 1, 0, 0} : std::array<double, 4>{1, 0, 1, 0};
}

/// Barycentric weights of the query's four points where the features are nearest at time t, about: those of each
/// feature are in [0, 1] and sum to 1, whatever the points. Coordinates must be finite. Meant for features that touch
/// then.
std::array<double, 4> contact_weights(Kind kind, const double* points, double t);

}  // namespace tightrope::ccd
