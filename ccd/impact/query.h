#pragma once
/// Method `tightrope` for vertex-face and edge-edge: the stages, and the time of impact.

#include <array>
#include <cstddef>
#include <optional>

#include "ccd/impact/stage.h"
#include "tightrope/plain.h"

namespace tightrope::ccd {

/// Where and when the features touch first in [0, t_max]; none: they do not. Both are exact, up to `tolerance` >= 0
/// (see Impact). Coordinates that are not finite: contact at 0.
template <class Real>
std::optional<Impact> first_touch(Kind kind, const Real* points, double tolerance, double t_max);

/// tightrope_collides, without the first look and the separations: they have been asked, or would be in vain.
bool tightrope_collides_unseparated(Kind kind, const double* points);

/// The stage that decides the query.
template <class Real>
Stage deciding_stage(Kind kind, const Real* points, Question question);

}  // namespace tightrope::ccd
