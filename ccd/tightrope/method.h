#pragma once
/// Continuous collision detection between linearly moving primitives: the kinds of queries and the methods that answer
/// them. The functions: plain.h on plain memory, ccd.h on Eigen's vectors, batch.h of many queries at once.
///
/// A query asks: does the closed vertex touch the closed triangle (the closed segments each other) at some time t in
/// [0, 1], each of the four points moving linearly from its position at t = 0 to that at t = 1? Degenerate triangles
/// and segments included. `false` is a guarantee from every method but `bsc_float`; `true` may be a false positive,
/// except from `tightrope` and `bsc_exact`.

#include <optional>
#include <span>
#include <string_view>

namespace tightrope::ccd {

/// Order of points everywhere, the public benchmark's: vertex-face: v f0 f1 f2 at t = 0, then at t = 1;
/// edge-edge: ea0 ea1 eb0 eb1 at t = 0, then at t = 1.
enum class Kind { vertex_face, edge_edge };

enum class Method {
  bsc_float,   ///< Bernstein sign classification in plain floating point: no bound, may miss collisions
  bsc_safe,    ///< with SafeBound [Wang 2014]
  tight,       ///< with TightBound: TightCCD [Wang et al. 2015], repaired
  bsc_exact,   ///< with every sign exact: no false positives
  safe,        ///< root finding and inside tests with SafeBound: SafeCCD [Wang 2014], repaired
  safe_tight,  ///< the same with TightBound
  tightrope,   ///< ours: subdivision on the exact contact criterion, then exact arithmetic; no false positives
};

struct MethodInfo {
  Method method;
  std::string_view name;   ///< "bsc-float", as the commands spell it
  std::string_view bound;  ///< "none", "SafeBound", "TightBound", "exact"
  bool conservative;       ///< never misses a collision
  std::string_view source;
  bool exact = false;  ///< reports no false positive either
};

/// Every method, in the order of the tables.
std::span<const MethodInfo> methods();
std::optional<Method> method_by_name(std::string_view name);
std::string_view name(Method method);
std::string_view name(Kind kind);  ///< "vertex-face", "edge-edge"

}  // namespace tightrope::ccd
