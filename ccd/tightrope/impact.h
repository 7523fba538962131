#pragma once
/// Time of impact: when and where two moving features touch first, exactly decided (method `tightrope`).

#include <Eigen/Core>
#include <array>
#include <optional>

#include "tightrope/ccd.h"

namespace tightrope::ccd {

/// The pairs of features. Order of points: vertex-vertex: v w; vertex-edge: v e0 e1; the others as `Kind` has them; all
/// of them at t = 0, then at t = 1.
enum class Pair { vertex_vertex, vertex_edge, vertex_face, edge_edge };

/// The pair that a query of this kind is about.
constexpr Pair pair_of(Kind kind) { return kind == Kind::vertex_face ? Pair::vertex_face : Pair::edge_edge; }

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
  /// Of the step; 0: `time` is the largest double not above the first contact. Negative or NaN: 0.
  double tolerance = 1e-6;
  /// Contacts after it do not count. Above 1 or NaN: 1; negative: no contact counts.
  double t_max = 1;
  /// In the coordinates' unit: coming within this distance counts as contact. `time` is a guarantee as before: they are
  /// farther apart until then; and they come that near by time + tolerance, but for a slack: 2^-20 of the distance and
  /// 2^-47 of the query's extent. Negative: 0, contact itself; infinity or NaN: contact at 0.
  double minimum_separation = 0;
};

/// When and where the features touch first; none: not in [0, t_max], a guarantee. `points` holds 2 * (number of points)
/// points of 3 coordinates in the order of `Pair`. Coordinates that are not finite: contact at 0. The same bits on
/// every machine. In single precision the same question about the coordinates as they are given, decided as exactly.
std::optional<Impact> first_impact(Pair pair, const double* points, const ImpactOptions& options = {});
std::optional<Impact> first_impact(Pair pair, const float* points, const ImpactOptions& options = {});

/// Do the features touch in [0, 1]? Exactly, as first_impact; faster, where the time is not wanted.
bool collides(Pair pair, const double* points);
bool collides(Pair pair, const float* points);

/// first_impact of a vertex and a face; vertex_face_collides: ccd.h.
std::optional<Impact> vertex_face(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& f0_t0,
                                  const Eigen::Vector3d& f1_t0, const Eigen::Vector3d& f2_t0,
                                  const Eigen::Vector3d& v_t1, const Eigen::Vector3d& f0_t1,
                                  const Eigen::Vector3d& f1_t1, const Eigen::Vector3d& f2_t1,
                                  const ImpactOptions& options = {});
std::optional<Impact> vertex_face(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& f0_t0,
                                  const Eigen::Vector3f& f1_t0, const Eigen::Vector3f& f2_t0,
                                  const Eigen::Vector3f& v_t1, const Eigen::Vector3f& f0_t1,
                                  const Eigen::Vector3f& f1_t1, const Eigen::Vector3f& f2_t1,
                                  const ImpactOptions& options = {});

/// first_impact of two edges; edge_edge_collides: ccd.h.
std::optional<Impact> edge_edge(const Eigen::Vector3d& ea0_t0, const Eigen::Vector3d& ea1_t0,
                                const Eigen::Vector3d& eb0_t0, const Eigen::Vector3d& eb1_t0,
                                const Eigen::Vector3d& ea0_t1, const Eigen::Vector3d& ea1_t1,
                                const Eigen::Vector3d& eb0_t1, const Eigen::Vector3d& eb1_t1,
                                const ImpactOptions& options = {});
std::optional<Impact> edge_edge(const Eigen::Vector3f& ea0_t0, const Eigen::Vector3f& ea1_t0,
                                const Eigen::Vector3f& eb0_t0, const Eigen::Vector3f& eb1_t0,
                                const Eigen::Vector3f& ea0_t1, const Eigen::Vector3f& ea1_t1,
                                const Eigen::Vector3f& eb0_t1, const Eigen::Vector3f& eb1_t1,
                                const ImpactOptions& options = {});

/// first_impact of a vertex and an edge, in space and in the plane; with _collides: do they touch in [0, 1]?
std::optional<Impact> vertex_edge(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& e0_t0,
                                  const Eigen::Vector3d& e1_t0, const Eigen::Vector3d& v_t1,
                                  const Eigen::Vector3d& e0_t1, const Eigen::Vector3d& e1_t1,
                                  const ImpactOptions& options = {});
std::optional<Impact> vertex_edge(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& e0_t0,
                                  const Eigen::Vector3f& e1_t0, const Eigen::Vector3f& v_t1,
                                  const Eigen::Vector3f& e0_t1, const Eigen::Vector3f& e1_t1,
                                  const ImpactOptions& options = {});
std::optional<Impact> vertex_edge(const Eigen::Vector2d& v_t0, const Eigen::Vector2d& e0_t0,
                                  const Eigen::Vector2d& e1_t0, const Eigen::Vector2d& v_t1,
                                  const Eigen::Vector2d& e0_t1, const Eigen::Vector2d& e1_t1,
                                  const ImpactOptions& options = {});
std::optional<Impact> vertex_edge(const Eigen::Vector2f& v_t0, const Eigen::Vector2f& e0_t0,
                                  const Eigen::Vector2f& e1_t0, const Eigen::Vector2f& v_t1,
                                  const Eigen::Vector2f& e0_t1, const Eigen::Vector2f& e1_t1,
                                  const ImpactOptions& options = {});

bool vertex_edge_collides(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& e0_t0, const Eigen::Vector3d& e1_t0,
                          const Eigen::Vector3d& v_t1, const Eigen::Vector3d& e0_t1, const Eigen::Vector3d& e1_t1);
bool vertex_edge_collides(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& e0_t0, const Eigen::Vector3f& e1_t0,
                          const Eigen::Vector3f& v_t1, const Eigen::Vector3f& e0_t1, const Eigen::Vector3f& e1_t1);
bool vertex_edge_collides(const Eigen::Vector2d& v_t0, const Eigen::Vector2d& e0_t0, const Eigen::Vector2d& e1_t0,
                          const Eigen::Vector2d& v_t1, const Eigen::Vector2d& e0_t1, const Eigen::Vector2d& e1_t1);
bool vertex_edge_collides(const Eigen::Vector2f& v_t0, const Eigen::Vector2f& e0_t0, const Eigen::Vector2f& e1_t0,
                          const Eigen::Vector2f& v_t1, const Eigen::Vector2f& e0_t1, const Eigen::Vector2f& e1_t1);

/// first_impact of two vertices; with _collides: do they meet in [0, 1]?
std::optional<Impact> vertex_vertex(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& w_t0,
                                    const Eigen::Vector3d& v_t1, const Eigen::Vector3d& w_t1,
                                    const ImpactOptions& options = {});
std::optional<Impact> vertex_vertex(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& w_t0,
                                    const Eigen::Vector3f& v_t1, const Eigen::Vector3f& w_t1,
                                    const ImpactOptions& options = {});
bool vertex_vertex_collides(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& w_t0, const Eigen::Vector3d& v_t1,
                            const Eigen::Vector3d& w_t1);
bool vertex_vertex_collides(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& w_t0, const Eigen::Vector3f& v_t1,
                            const Eigen::Vector3f& w_t1);

}  // namespace tightrope::ccd
