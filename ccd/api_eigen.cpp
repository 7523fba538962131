#include <algorithm>
#include <array>

#include "ccd/geometry.h"
#include "tightrope/ccd.h"

namespace tightrope::ccd {
namespace {

template <class Real, class... Points>
std::array<Real, numbers_per_query> gather(const Points&... points) {
  std::array<Real, numbers_per_query> query;
  Real* next = query.data();
  ((next = std::copy_n(points.data(), 3, next)), ...);
  return query;
}

}  // namespace

bool vertex_face_collides(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& f0_t0, const Eigen::Vector3d& f1_t0,
                          const Eigen::Vector3d& f2_t0, const Eigen::Vector3d& v_t1, const Eigen::Vector3d& f0_t1,
                          const Eigen::Vector3d& f1_t1, const Eigen::Vector3d& f2_t1, Method method) {
  const auto query = gather<double>(v_t0, f0_t0, f1_t0, f2_t0, v_t1, f0_t1, f1_t1, f2_t1);
  return collides(Kind::vertex_face, query.data(), method);
}

bool vertex_face_collides(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& f0_t0, const Eigen::Vector3f& f1_t0,
                          const Eigen::Vector3f& f2_t0, const Eigen::Vector3f& v_t1, const Eigen::Vector3f& f0_t1,
                          const Eigen::Vector3f& f1_t1, const Eigen::Vector3f& f2_t1, Method method) {
  const auto query = gather<float>(v_t0, f0_t0, f1_t0, f2_t0, v_t1, f0_t1, f1_t1, f2_t1);
  return collides(Kind::vertex_face, query.data(), method);
}

bool edge_edge_collides(const Eigen::Vector3d& ea0_t0, const Eigen::Vector3d& ea1_t0, const Eigen::Vector3d& eb0_t0,
                        const Eigen::Vector3d& eb1_t0, const Eigen::Vector3d& ea0_t1, const Eigen::Vector3d& ea1_t1,
                        const Eigen::Vector3d& eb0_t1, const Eigen::Vector3d& eb1_t1, Method method) {
  const auto query = gather<double>(ea0_t0, ea1_t0, eb0_t0, eb1_t0, ea0_t1, ea1_t1, eb0_t1, eb1_t1);
  return collides(Kind::edge_edge, query.data(), method);
}

bool edge_edge_collides(const Eigen::Vector3f& ea0_t0, const Eigen::Vector3f& ea1_t0, const Eigen::Vector3f& eb0_t0,
                        const Eigen::Vector3f& eb1_t0, const Eigen::Vector3f& ea0_t1, const Eigen::Vector3f& ea1_t1,
                        const Eigen::Vector3f& eb0_t1, const Eigen::Vector3f& eb1_t1, Method method) {
  const auto query = gather<float>(ea0_t0, ea1_t0, eb0_t0, eb1_t0, ea0_t1, ea1_t1, eb0_t1, eb1_t1);
  return collides(Kind::edge_edge, query.data(), method);
}

}  // namespace tightrope::ccd
