#pragma once
/// When and where the features of a query touch first, by SafeCCD (methods `safe` and `safe_tight`).

#include <array>
#include <optional>

#include "tightrope/method.h"

namespace tightrope::ccd {

/// A contact, or what error bounds cannot tell from one.
template <class Real>
struct Contact {
  Real earliest;  ///< no contact before this time, in steps: in [0, 1], a guarantee
  Real latest;    ///< end of the part of the step that starts there and could not be proved free
  /// Barycentric weights of the query's four points, about, where the features touch. Vertex-face: 1, then those of f0,
  /// f1, f2, with sum 1; edge-edge: those of ea0 and ea1, then of eb0 and eb1, each pair with sum 1.
  std::array<Real, 4> weights;
};

/// The first contact; none: no contact in [0, 1], a guarantee. `points` holds 8 points of 3 coordinates in the order of
/// `Kind`; method: `safe` or `safe_tight` (any other stands for the latter). Answers as `collides` does. Coordinates
/// that are not finite and four points that stay one point all the time give [0, 1] and the weights of a vertex each.
std::optional<Contact<double>> first_contact(Kind kind, const double* points, Method method = Method::safe_tight);
std::optional<Contact<float>> first_contact(Kind kind, const float* points, Method method = Method::safe_tight);

/// One B of SafeBound for a whole scene. Most queries are settled by the first test, whose error bound is then one
/// number for all of them; the others get bounds of their own, so that nothing is lost.
template <class Real>
class SceneBound {
 public:
  /// No two of a query's points differ by more than `largest_difference` in a coordinate, at the same end of the step.
  /// A query that breaks this gets its own bound.
  explicit SceneBound(Real largest_difference);

  /// Are the four points never in one plane, by the scene's bound?
  bool never_coplanar(Kind kind, const Real* points) const;

 private:
  Real largest_difference_;
  Real vertex_face_;  ///< bounds of the coefficients of F
  Real edge_edge_;
};

/// Method `safe` with the scene's B: answers as collides(kind, points, Method::safe) does.
bool collides(Kind kind, const double* points, const SceneBound<double>& scene);
bool collides(Kind kind, const float* points, const SceneBound<float>& scene);

}  // namespace tightrope::ccd
