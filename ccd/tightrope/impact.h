#pragma once
/// Time of impact: when and where two moving features touch first, exactly decided (method `tightrope`).
/// What a time of impact is, its options, and plain memory: plain.h.

#include <Eigen/Core>
#include <optional>

#include "tightrope/ccd.h"

namespace tightrope::ccd {

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
