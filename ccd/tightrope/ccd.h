#pragma once
/// Continuous collision detection between linearly moving primitives: vertex against face, edge against edge. When and
/// where they touch first, and other pairs of features: impact.h.
///
/// A query asks: does the closed vertex touch the closed triangle (the closed segments each other) at some time t in
/// [0, 1], each of the four points moving linearly from its position at t = 0 to that at t = 1? Degenerate triangles
/// and segments included. `false` is a guarantee from every method but `bsc_float`; `true` may be a false positive,
/// except from `tightrope` and `bsc_exact`.

#include <Eigen/Core>
#include <array>
#include <cstddef>
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

/// Does the vertex touch the triangle? Units are the caller's; non-finite coordinates give true. In single precision
/// the same question about the coordinates as they are given, decided in single precision (by `tightrope` and
/// `bsc_exact`: exactly).
bool vertex_face_collides(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& f0_t0, const Eigen::Vector3d& f1_t0,
                          const Eigen::Vector3d& f2_t0, const Eigen::Vector3d& v_t1, const Eigen::Vector3d& f0_t1,
                          const Eigen::Vector3d& f1_t1, const Eigen::Vector3d& f2_t1,
                          Method method = Method::tightrope);
bool vertex_face_collides(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& f0_t0, const Eigen::Vector3f& f1_t0,
                          const Eigen::Vector3f& f2_t0, const Eigen::Vector3f& v_t1, const Eigen::Vector3f& f0_t1,
                          const Eigen::Vector3f& f1_t1, const Eigen::Vector3f& f2_t1,
                          Method method = Method::tightrope);

/// Do the edges touch?
bool edge_edge_collides(const Eigen::Vector3d& ea0_t0, const Eigen::Vector3d& ea1_t0, const Eigen::Vector3d& eb0_t0,
                        const Eigen::Vector3d& eb1_t0, const Eigen::Vector3d& ea0_t1, const Eigen::Vector3d& ea1_t1,
                        const Eigen::Vector3d& eb0_t1, const Eigen::Vector3d& eb1_t1,
                        Method method = Method::tightrope);
bool edge_edge_collides(const Eigen::Vector3f& ea0_t0, const Eigen::Vector3f& ea1_t0, const Eigen::Vector3f& eb0_t0,
                        const Eigen::Vector3f& eb1_t0, const Eigen::Vector3f& ea0_t1, const Eigen::Vector3f& ea1_t1,
                        const Eigen::Vector3f& eb0_t1, const Eigen::Vector3f& eb1_t1,
                        Method method = Method::tightrope);

/// The same on plain memory: `points` holds 8 points of 3 coordinates in the order of `Kind`.
bool collides(Kind kind, const double* points, Method method = Method::tightrope);
bool collides(Kind kind, const float* points, Method method = Method::tightrope);

/// `count` queries, `points` holding 24 * count numbers; `results` must hold `count` bytes and gets 0 or 1.
void collides(Kind kind, const double* points, std::size_t count, unsigned char* results,
              Method method = Method::tightrope);
void collides(Kind kind, const float* points, std::size_t count, unsigned char* results,
              Method method = Method::tightrope);

}  // namespace tightrope::ccd
