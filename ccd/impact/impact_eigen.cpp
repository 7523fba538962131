/// The time of impact of Eigen's vectors.

#include <algorithm>
#include <array>
#include <cstddef>

#include "ccd/impact/options.h"
#include "ccd/impact/vertex_edge.h"
#include "tightrope/impact.h"

namespace tightrope::ccd {
namespace {

/// `Dimension` coordinates a point; beyond those of the points 0.
template <class Real, std::size_t Dimension = 3, class... Points>
std::array<Real, Dimension * sizeof...(Points)> gather(const Points&... points) {
  std::array<Real, Dimension * sizeof...(Points)> query{};
  Real* next = query.data();
  ((std::copy_n(points.data(), points.size(), next), next += Dimension), ...);
  return query;
}

template <class... Points>
std::optional<Impact> impact_in_plane(const ImpactOptions& wanted, const Points&... points) {
  const ImpactOptions options = in_range(wanted);
  if (options.t_max < 0) return std::nullopt;
  if (options.minimum_separation != 0)
    return first_impact(Pair::vertex_edge, gather<double>(points...).data(), options);
  return vertex_edge_impact_2d(gather<double, 2>(points...).data(), options.tolerance, options.t_max);
}

}  // namespace

std::optional<Impact> vertex_face(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& f0_t0,
                                  const Eigen::Vector3d& f1_t0, const Eigen::Vector3d& f2_t0,
                                  const Eigen::Vector3d& v_t1, const Eigen::Vector3d& f0_t1,
                                  const Eigen::Vector3d& f1_t1, const Eigen::Vector3d& f2_t1,
                                  const ImpactOptions& options) {
  return first_impact(Pair::vertex_face, gather<double>(v_t0, f0_t0, f1_t0, f2_t0, v_t1, f0_t1, f1_t1, f2_t1).data(),
                      options);
}
std::optional<Impact> vertex_face(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& f0_t0,
                                  const Eigen::Vector3f& f1_t0, const Eigen::Vector3f& f2_t0,
                                  const Eigen::Vector3f& v_t1, const Eigen::Vector3f& f0_t1,
                                  const Eigen::Vector3f& f1_t1, const Eigen::Vector3f& f2_t1,
                                  const ImpactOptions& options) {
  return first_impact(Pair::vertex_face, gather<float>(v_t0, f0_t0, f1_t0, f2_t0, v_t1, f0_t1, f1_t1, f2_t1).data(),
                      options);
}

std::optional<Impact> edge_edge(const Eigen::Vector3d& ea0_t0, const Eigen::Vector3d& ea1_t0,
                                const Eigen::Vector3d& eb0_t0, const Eigen::Vector3d& eb1_t0,
                                const Eigen::Vector3d& ea0_t1, const Eigen::Vector3d& ea1_t1,
                                const Eigen::Vector3d& eb0_t1, const Eigen::Vector3d& eb1_t1,
                                const ImpactOptions& options) {
  return first_impact(Pair::edge_edge,
                      gather<double>(ea0_t0, ea1_t0, eb0_t0, eb1_t0, ea0_t1, ea1_t1, eb0_t1, eb1_t1).data(), options);
}
std::optional<Impact> edge_edge(const Eigen::Vector3f& ea0_t0, const Eigen::Vector3f& ea1_t0,
                                const Eigen::Vector3f& eb0_t0, const Eigen::Vector3f& eb1_t0,
                                const Eigen::Vector3f& ea0_t1, const Eigen::Vector3f& ea1_t1,
                                const Eigen::Vector3f& eb0_t1, const Eigen::Vector3f& eb1_t1,
                                const ImpactOptions& options) {
  return first_impact(Pair::edge_edge,
                      gather<float>(ea0_t0, ea1_t0, eb0_t0, eb1_t0, ea0_t1, ea1_t1, eb0_t1, eb1_t1).data(), options);
}

std::optional<Impact> vertex_edge(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& e0_t0,
                                  const Eigen::Vector3d& e1_t0, const Eigen::Vector3d& v_t1,
                                  const Eigen::Vector3d& e0_t1, const Eigen::Vector3d& e1_t1,
                                  const ImpactOptions& options) {
  return first_impact(Pair::vertex_edge, gather<double>(v_t0, e0_t0, e1_t0, v_t1, e0_t1, e1_t1).data(), options);
}
std::optional<Impact> vertex_edge(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& e0_t0,
                                  const Eigen::Vector3f& e1_t0, const Eigen::Vector3f& v_t1,
                                  const Eigen::Vector3f& e0_t1, const Eigen::Vector3f& e1_t1,
                                  const ImpactOptions& options) {
  return first_impact(Pair::vertex_edge, gather<float>(v_t0, e0_t0, e1_t0, v_t1, e0_t1, e1_t1).data(), options);
}
std::optional<Impact> vertex_edge(const Eigen::Vector2d& v_t0, const Eigen::Vector2d& e0_t0,
                                  const Eigen::Vector2d& e1_t0, const Eigen::Vector2d& v_t1,
                                  const Eigen::Vector2d& e0_t1, const Eigen::Vector2d& e1_t1,
                                  const ImpactOptions& options) {
  return impact_in_plane(options, v_t0, e0_t0, e1_t0, v_t1, e0_t1, e1_t1);
}
std::optional<Impact> vertex_edge(const Eigen::Vector2f& v_t0, const Eigen::Vector2f& e0_t0,
                                  const Eigen::Vector2f& e1_t0, const Eigen::Vector2f& v_t1,
                                  const Eigen::Vector2f& e0_t1, const Eigen::Vector2f& e1_t1,
                                  const ImpactOptions& options) {
  return impact_in_plane(options, v_t0, e0_t0, e1_t0, v_t1, e0_t1, e1_t1);
}
bool vertex_edge_collides(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& e0_t0, const Eigen::Vector3d& e1_t0,
                          const Eigen::Vector3d& v_t1, const Eigen::Vector3d& e0_t1, const Eigen::Vector3d& e1_t1) {
  return collides(Pair::vertex_edge, gather<double>(v_t0, e0_t0, e1_t0, v_t1, e0_t1, e1_t1).data());
}
bool vertex_edge_collides(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& e0_t0, const Eigen::Vector3f& e1_t0,
                          const Eigen::Vector3f& v_t1, const Eigen::Vector3f& e0_t1, const Eigen::Vector3f& e1_t1) {
  return collides(Pair::vertex_edge, gather<float>(v_t0, e0_t0, e1_t0, v_t1, e0_t1, e1_t1).data());
}
bool vertex_edge_collides(const Eigen::Vector2d& v_t0, const Eigen::Vector2d& e0_t0, const Eigen::Vector2d& e1_t0,
                          const Eigen::Vector2d& v_t1, const Eigen::Vector2d& e0_t1, const Eigen::Vector2d& e1_t1) {
  return vertex_edge_collides_2d(gather<double, 2>(v_t0, e0_t0, e1_t0, v_t1, e0_t1, e1_t1).data());
}
bool vertex_edge_collides(const Eigen::Vector2f& v_t0, const Eigen::Vector2f& e0_t0, const Eigen::Vector2f& e1_t0,
                          const Eigen::Vector2f& v_t1, const Eigen::Vector2f& e0_t1, const Eigen::Vector2f& e1_t1) {
  return vertex_edge_collides_2d(gather<double, 2>(v_t0, e0_t0, e1_t0, v_t1, e0_t1, e1_t1).data());
}

std::optional<Impact> vertex_vertex(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& w_t0,
                                    const Eigen::Vector3d& v_t1, const Eigen::Vector3d& w_t1,
                                    const ImpactOptions& options) {
  return first_impact(Pair::vertex_vertex, gather<double>(v_t0, w_t0, v_t1, w_t1).data(), options);
}
std::optional<Impact> vertex_vertex(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& w_t0,
                                    const Eigen::Vector3f& v_t1, const Eigen::Vector3f& w_t1,
                                    const ImpactOptions& options) {
  return first_impact(Pair::vertex_vertex, gather<float>(v_t0, w_t0, v_t1, w_t1).data(), options);
}
bool vertex_vertex_collides(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& w_t0, const Eigen::Vector3d& v_t1,
                            const Eigen::Vector3d& w_t1) {
  return collides(Pair::vertex_vertex, gather<double>(v_t0, w_t0, v_t1, w_t1).data());
}
bool vertex_vertex_collides(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& w_t0, const Eigen::Vector3f& v_t1,
                            const Eigen::Vector3f& w_t1) {
  return collides(Pair::vertex_vertex, gather<float>(v_t0, w_t0, v_t1, w_t1).data());
}

}  // namespace tightrope::ccd
