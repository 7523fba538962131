#pragma once
/// Continuous collision detection between linearly moving primitives: vertex against face, edge against edge. What is
/// asked, and the methods: method.h; on plain memory: plain.h; when and where they touch first: impact.h.

#include <Eigen/Core>

#include "tightrope/method.h"
#include "tightrope/plain.h"

namespace tightrope::ccd {

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

}  // namespace tightrope::ccd
