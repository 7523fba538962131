#pragma once
/// Time of impact where one of the two features is at rest: fewer operations, the answers of impact.h.

#include <Eigen/Core>
#include <cstddef>
#include <optional>

#include "tightrope/impact.h"

namespace tightrope::ccd {

/// Order of points: those of the moving feature at t = 0, then at t = 1, then those at rest:
///   vertex_static_face: v at t = 0 and at t = 1, f0 f1 f2                       (5 points)
///   static_vertex_face: f0 f1 f2 at t = 0, f0 f1 f2 at t = 1, v                 (7 points)
///   edge_static_edge:   ea0 ea1 at t = 0, ea0 ea1 at t = 1, eb0 eb1             (6 points)
enum class StaticPair { vertex_static_face, static_vertex_face, edge_static_edge };

/// As first_impact(Pair, ..) with the points at rest repeated at t = 1, to the last bit; the weights are those of the
/// points in the order of `Pair`. `points` holds 3 coordinates a point.
std::optional<Impact> first_impact(StaticPair pair, const double* points, const ImpactOptions& options = {});
std::optional<Impact> first_impact(StaticPair pair, const float* points, const ImpactOptions& options = {});

/// Do the features touch in [0, 1]? Exactly.
bool collides(StaticPair pair, const double* points);
bool collides(StaticPair pair, const float* points);

/// `count` queries one after another; `results` must hold `count` bytes and gets 0 or 1.
void collides(StaticPair pair, const double* points, std::size_t count, unsigned char* results);
void collides(StaticPair pair, const float* points, std::size_t count, unsigned char* results);

/// A moving vertex and a face at rest.
std::optional<Impact> vertex_static_face(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& v_t1,
                                         const Eigen::Vector3d& f0, const Eigen::Vector3d& f1,
                                         const Eigen::Vector3d& f2, const ImpactOptions& options = {});
std::optional<Impact> vertex_static_face(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& v_t1,
                                         const Eigen::Vector3f& f0, const Eigen::Vector3f& f1,
                                         const Eigen::Vector3f& f2, const ImpactOptions& options = {});
bool vertex_static_face_collides(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& v_t1, const Eigen::Vector3d& f0,
                                 const Eigen::Vector3d& f1, const Eigen::Vector3d& f2);
bool vertex_static_face_collides(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& v_t1, const Eigen::Vector3f& f0,
                                 const Eigen::Vector3f& f1, const Eigen::Vector3f& f2);

/// A vertex at rest and a moving face.
std::optional<Impact> static_vertex_face(const Eigen::Vector3d& v, const Eigen::Vector3d& f0_t0,
                                         const Eigen::Vector3d& f1_t0, const Eigen::Vector3d& f2_t0,
                                         const Eigen::Vector3d& f0_t1, const Eigen::Vector3d& f1_t1,
                                         const Eigen::Vector3d& f2_t1, const ImpactOptions& options = {});
std::optional<Impact> static_vertex_face(const Eigen::Vector3f& v, const Eigen::Vector3f& f0_t0,
                                         const Eigen::Vector3f& f1_t0, const Eigen::Vector3f& f2_t0,
                                         const Eigen::Vector3f& f0_t1, const Eigen::Vector3f& f1_t1,
                                         const Eigen::Vector3f& f2_t1, const ImpactOptions& options = {});
bool static_vertex_face_collides(const Eigen::Vector3d& v, const Eigen::Vector3d& f0_t0, const Eigen::Vector3d& f1_t0,
                                 const Eigen::Vector3d& f2_t0, const Eigen::Vector3d& f0_t1,
                                 const Eigen::Vector3d& f1_t1, const Eigen::Vector3d& f2_t1);
bool static_vertex_face_collides(const Eigen::Vector3f& v, const Eigen::Vector3f& f0_t0, const Eigen::Vector3f& f1_t0,
                                 const Eigen::Vector3f& f2_t0, const Eigen::Vector3f& f0_t1,
                                 const Eigen::Vector3f& f1_t1, const Eigen::Vector3f& f2_t1);

/// A moving edge and an edge at rest.
std::optional<Impact> edge_static_edge(const Eigen::Vector3d& ea0_t0, const Eigen::Vector3d& ea1_t0,
                                       const Eigen::Vector3d& ea0_t1, const Eigen::Vector3d& ea1_t1,
                                       const Eigen::Vector3d& eb0, const Eigen::Vector3d& eb1,
                                       const ImpactOptions& options = {});
std::optional<Impact> edge_static_edge(const Eigen::Vector3f& ea0_t0, const Eigen::Vector3f& ea1_t0,
                                       const Eigen::Vector3f& ea0_t1, const Eigen::Vector3f& ea1_t1,
                                       const Eigen::Vector3f& eb0, const Eigen::Vector3f& eb1,
                                       const ImpactOptions& options = {});
bool edge_static_edge_collides(const Eigen::Vector3d& ea0_t0, const Eigen::Vector3d& ea1_t0,
                               const Eigen::Vector3d& ea0_t1, const Eigen::Vector3d& ea1_t1, const Eigen::Vector3d& eb0,
                               const Eigen::Vector3d& eb1);
bool edge_static_edge_collides(const Eigen::Vector3f& ea0_t0, const Eigen::Vector3f& ea1_t0,
                               const Eigen::Vector3f& ea0_t1, const Eigen::Vector3f& ea1_t1, const Eigen::Vector3f& eb0,
                               const Eigen::Vector3f& eb1);

}  // namespace tightrope::ccd
