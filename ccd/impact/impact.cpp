/// The public form of the time of impact: options, the choice of the query, and Eigen's vectors.

#include "tightrope/impact.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "ccd/impact/options.h"
#include "ccd/impact/query.h"
#include "ccd/impact/separation.h"
#include "ccd/impact/vertex_edge.h"
#include "ccd/impact/vertex_vertex.h"
#include "ccd/query.h"

namespace tightrope::ccd {
namespace {

/// Numbers of a query: both ends of the step.
constexpr std::size_t number_of_coordinates(Pair pair) {
  switch (pair) {
    case Pair::vertex_vertex:
      return 12;
    case Pair::vertex_edge:
      return 18;
    case Pair::vertex_face:
    case Pair::edge_edge:
      return 24;
  }
  return 24;
}

/// The coordinates in double precision, which holds those of single precision exactly.
inline const double* in_double_precision(Pair, const double* points, std::array<double, 24>&) { return points; }
inline const double* in_double_precision(Pair pair, const float* points, std::array<double, 24>& converted) {
  std::copy_n(points, number_of_coordinates(pair), converted.begin());
  return converted.data();
}

template <class Real>
std::optional<Impact> impact(Pair pair, const Real* points, const ImpactOptions& wanted) {
  const ImpactOptions options = in_range(wanted);
  if (options.t_max < 0) return std::nullopt;
  std::array<double, 24> converted;
  if (options.minimum_separation != 0) {  // NaN too
    return first_approach(pair, in_double_precision(pair, points, converted), options.minimum_separation,
                          options.tolerance, options.t_max);
  }
  switch (pair) {
    case Pair::vertex_vertex:
      return vertex_vertex_impact(in_double_precision(pair, points, converted), options.tolerance, options.t_max);
    case Pair::vertex_edge:
      return vertex_edge_impact(in_double_precision(pair, points, converted), options.tolerance, options.t_max);
    case Pair::vertex_face:
      return first_touch(Kind::vertex_face, points, options.tolerance, options.t_max);
    case Pair::edge_edge:
      return first_touch(Kind::edge_edge, points, options.tolerance, options.t_max);
  }
  return std::nullopt;
}

template <class Real>
bool contact(Pair pair, const Real* points) {
  std::array<double, 24> converted;
  switch (pair) {
    case Pair::vertex_vertex:
      return vertex_vertex_collides(in_double_precision(pair, points, converted));
    case Pair::vertex_edge:
      return vertex_edge_collides(in_double_precision(pair, points, converted));
    case Pair::vertex_face:
      return tightrope_collides(Kind::vertex_face, points);
    case Pair::edge_edge:
      return tightrope_collides(Kind::edge_edge, points);
  }
  return true;
}

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
  if (options.minimum_separation != 0) return impact(Pair::vertex_edge, gather<double>(points...).data(), options);
  return vertex_edge_impact_2d(gather<double, 2>(points...).data(), options.tolerance, options.t_max);
}

}  // namespace

std::optional<Impact> first_impact(Pair pair, const double* points, const ImpactOptions& options) {
  return impact(pair, points, options);
}
std::optional<Impact> first_impact(Pair pair, const float* points, const ImpactOptions& options) {
  return impact(pair, points, options);
}

bool collides(Pair pair, const double* points) { return contact(pair, points); }
bool collides(Pair pair, const float* points) { return contact(pair, points); }

std::optional<Impact> vertex_face(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& f0_t0,
                                  const Eigen::Vector3d& f1_t0, const Eigen::Vector3d& f2_t0,
                                  const Eigen::Vector3d& v_t1, const Eigen::Vector3d& f0_t1,
                                  const Eigen::Vector3d& f1_t1, const Eigen::Vector3d& f2_t1,
                                  const ImpactOptions& options) {
  return impact(Pair::vertex_face, gather<double>(v_t0, f0_t0, f1_t0, f2_t0, v_t1, f0_t1, f1_t1, f2_t1).data(),
                options);
}
std::optional<Impact> vertex_face(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& f0_t0,
                                  const Eigen::Vector3f& f1_t0, const Eigen::Vector3f& f2_t0,
                                  const Eigen::Vector3f& v_t1, const Eigen::Vector3f& f0_t1,
                                  const Eigen::Vector3f& f1_t1, const Eigen::Vector3f& f2_t1,
                                  const ImpactOptions& options) {
  return impact(Pair::vertex_face, gather<float>(v_t0, f0_t0, f1_t0, f2_t0, v_t1, f0_t1, f1_t1, f2_t1).data(), options);
}

std::optional<Impact> edge_edge(const Eigen::Vector3d& ea0_t0, const Eigen::Vector3d& ea1_t0,
                                const Eigen::Vector3d& eb0_t0, const Eigen::Vector3d& eb1_t0,
                                const Eigen::Vector3d& ea0_t1, const Eigen::Vector3d& ea1_t1,
                                const Eigen::Vector3d& eb0_t1, const Eigen::Vector3d& eb1_t1,
                                const ImpactOptions& options) {
  return impact(Pair::edge_edge, gather<double>(ea0_t0, ea1_t0, eb0_t0, eb1_t0, ea0_t1, ea1_t1, eb0_t1, eb1_t1).data(),
                options);
}
std::optional<Impact> edge_edge(const Eigen::Vector3f& ea0_t0, const Eigen::Vector3f& ea1_t0,
                                const Eigen::Vector3f& eb0_t0, const Eigen::Vector3f& eb1_t0,
                                const Eigen::Vector3f& ea0_t1, const Eigen::Vector3f& ea1_t1,
                                const Eigen::Vector3f& eb0_t1, const Eigen::Vector3f& eb1_t1,
                                const ImpactOptions& options) {
  return impact(Pair::edge_edge, gather<float>(ea0_t0, ea1_t0, eb0_t0, eb1_t0, ea0_t1, ea1_t1, eb0_t1, eb1_t1).data(),
                options);
}

std::optional<Impact> vertex_edge(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& e0_t0,
                                  const Eigen::Vector3d& e1_t0, const Eigen::Vector3d& v_t1,
                                  const Eigen::Vector3d& e0_t1, const Eigen::Vector3d& e1_t1,
                                  const ImpactOptions& options) {
  return impact(Pair::vertex_edge, gather<double>(v_t0, e0_t0, e1_t0, v_t1, e0_t1, e1_t1).data(), options);
}
std::optional<Impact> vertex_edge(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& e0_t0,
                                  const Eigen::Vector3f& e1_t0, const Eigen::Vector3f& v_t1,
                                  const Eigen::Vector3f& e0_t1, const Eigen::Vector3f& e1_t1,
                                  const ImpactOptions& options) {
  return impact(Pair::vertex_edge, gather<float>(v_t0, e0_t0, e1_t0, v_t1, e0_t1, e1_t1).data(), options);
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
  return contact(Pair::vertex_edge, gather<double>(v_t0, e0_t0, e1_t0, v_t1, e0_t1, e1_t1).data());
}
bool vertex_edge_collides(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& e0_t0, const Eigen::Vector3f& e1_t0,
                          const Eigen::Vector3f& v_t1, const Eigen::Vector3f& e0_t1, const Eigen::Vector3f& e1_t1) {
  return contact(Pair::vertex_edge, gather<float>(v_t0, e0_t0, e1_t0, v_t1, e0_t1, e1_t1).data());
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
  return impact(Pair::vertex_vertex, gather<double>(v_t0, w_t0, v_t1, w_t1).data(), options);
}
std::optional<Impact> vertex_vertex(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& w_t0,
                                    const Eigen::Vector3f& v_t1, const Eigen::Vector3f& w_t1,
                                    const ImpactOptions& options) {
  return impact(Pair::vertex_vertex, gather<float>(v_t0, w_t0, v_t1, w_t1).data(), options);
}
bool vertex_vertex_collides(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& w_t0, const Eigen::Vector3d& v_t1,
                            const Eigen::Vector3d& w_t1) {
  return contact(Pair::vertex_vertex, gather<double>(v_t0, w_t0, v_t1, w_t1).data());
}
bool vertex_vertex_collides(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& w_t0, const Eigen::Vector3f& v_t1,
                            const Eigen::Vector3f& w_t1) {
  return contact(Pair::vertex_vertex, gather<float>(v_t0, w_t0, v_t1, w_t1).data());
}

}  // namespace tightrope::ccd
