#pragma once
/// Time of impact: when and where two moving features touch first, exactly decided.

#include <array>
#include <optional>

#include "tightrope/ccd.h"

namespace tightrope::ccd {

/// The pairs of features. Order of points: vertex-vertex: v w; vertex-edge: v e0 e1; the others as `Kind` has them; all
/// of them at t = 0, then at t = 1.
enum class Pair { vertex_vertex, vertex_edge, vertex_face, edge_edge };

/// Where and when the features touch first.
struct Impact {
  /// In steps, in [0, 1]: time <= first contact <= time + tolerance. 0 only if there is contact at 0, or before the
  /// smallest positive double.
  double time;
  /// Barycentric weights of the pair's points, in their order, where the features touch, about: those of each feature
  /// are in [0, 1] and sum to 1.
  std::array<double, 4> weights;
};

struct ImpactOptions {
  double tolerance = 1e-6;        ///< of the step; 0: `time` is the largest double not above the first contact
  double t_max = 1;               ///< in [0, 1]: contacts after it do not count
  double minimum_separation = 0;  ///< in units of length: coming as close as this counts as contact
};

}  // namespace tightrope::ccd
