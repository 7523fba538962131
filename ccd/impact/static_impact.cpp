/// Queries with a feature at rest: a first look of fewer operations; what it leaves is the general query, so that the
/// answers are the same. (Hulls of the polynomials of lower degree as a second stage cost more than they save.)

#include "tightrope/static_impact.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "ccd/geometry.h"
#include "ccd/query.h"
#include "ccd/roots.h"
#include "ccd/sign_reader.h"
#include "separating_plane.safe.double.h"
#include "separating_plane.safe.float.h"
#include "static_features.safe.double.h"
#include "static_features.safe.float.h"

namespace tightrope::ccd {
namespace {

struct Layout {
  Pair general;
  Kind kind;
  std::size_t points;
  /// The point at each place of the general query.
  std::array<std::size_t, points_per_query> places;
};

const Layout& layout(StaticPair pair) {
  static constexpr Layout vertex_static_face{Pair::vertex_face, Kind::vertex_face, 5, {0, 2, 3, 4, 1, 2, 3, 4}};
  static constexpr Layout static_vertex_face{Pair::vertex_face, Kind::vertex_face, 7, {6, 0, 1, 2, 6, 3, 4, 5}};
  static constexpr Layout edge_static_edge{Pair::edge_edge, Kind::edge_edge, 6, {0, 1, 4, 5, 2, 3, 4, 5}};
  switch (pair) {
    case StaticPair::vertex_static_face:
      return vertex_static_face;
    case StaticPair::static_vertex_face:
      return static_vertex_face;
    case StaticPair::edge_static_edge:
      return edge_static_edge;
  }
  return vertex_static_face;
}

template <class Real>
std::array<Real, numbers_per_query> general_query(const Layout& layout, const Real* points) {
  std::array<Real, numbers_per_query> query;
  for (std::size_t i = 0; i < layout.places.size(); ++i) {
    std::copy_n(points + 3 * layout.places[i], 3, query.begin() + 3 * i);
  }
  return query;
}

/// Does a plane separate the features all the time: that of the face as it is at t = 0, or one along both edges as they
/// are then (MATH 3.4a)?
template <class Real>
bool separated_by_plane(StaticPair pair, const Real* x) {
  SignReader signs;
  const auto one_side = [&](const auto& sides) {
    return common(signs(sides.near), common(read_all(signs, sides.far))) != Sign::uncertain;
  };
  switch (pair) {
    case StaticPair::vertex_static_face: {
      const auto sides = generated::side_of_static_face<bound::safe, Real>::evaluate(x, x + 3, x + 6, x + 9, x + 12);
      return common(read_all(signs, sides.side)) != Sign::uncertain;
    }
    case StaticPair::static_vertex_face: {
      const Real* v = x + 18;
      return one_side(
          generated::plane_of_face<bound::safe, Real>::evaluate(v, x, x + 3, x + 6, v, x + 9, x + 12, x + 15));
    }
    case StaticPair::edge_static_edge:
      return one_side(
          generated::plane_of_static_edge<bound::safe, Real>::evaluate(x, x + 3, x + 6, x + 9, x + 12, x + 15));
  }
  return false;
}

/// Not inlined: the first look settles nearly every query, with few registers.
template <class Real>
[[gnu::noinline]] bool contact_further(StaticPair pair, const Real* points) {
  const Layout& places = layout(pair);
  return tightrope_collides(places.kind, general_query(places, points).data());
}

template <class Real>
bool contact(StaticPair pair, const Real* points) {
  return !separated_by_plane(pair, points) && contact_further(pair, points);
}

template <class Real>
std::optional<Impact> impact(StaticPair pair, const Real* points, const ImpactOptions& options) {
  const bool contact_is_asked = options.minimum_separation <= 0;
  if (contact_is_asked && separated_by_plane(pair, points)) return std::nullopt;
  const Layout& places = layout(pair);
  return first_impact(places.general, general_query(places, points).data(), options);
}

template <class Real>
void decide_all(StaticPair pair, const Real* points, std::size_t count, unsigned char* results) {
  const std::size_t numbers = 3 * layout(pair).points;
  for (std::size_t i = 0; i < count; ++i) results[i] = contact(pair, points + numbers * i) ? 1 : 0;
}

template <class Real, class... Points>
std::array<Real, 3 * sizeof...(Points)> gather(const Points&... points) {
  std::array<Real, 3 * sizeof...(Points)> query;
  Real* next = query.data();
  ((next = std::copy_n(points.data(), 3, next)), ...);
  return query;
}

}  // namespace

std::optional<Impact> first_impact(StaticPair pair, const double* points, const ImpactOptions& options) {
  return impact(pair, points, options);
}
std::optional<Impact> first_impact(StaticPair pair, const float* points, const ImpactOptions& options) {
  return impact(pair, points, options);
}

bool collides(StaticPair pair, const double* points) { return contact(pair, points); }
bool collides(StaticPair pair, const float* points) { return contact(pair, points); }

void collides(StaticPair pair, const double* points, std::size_t count, unsigned char* results) {
  decide_all(pair, points, count, results);
}
void collides(StaticPair pair, const float* points, std::size_t count, unsigned char* results) {
  decide_all(pair, points, count, results);
}

std::optional<Impact> vertex_static_face(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& v_t1,
                                         const Eigen::Vector3d& f0, const Eigen::Vector3d& f1,
                                         const Eigen::Vector3d& f2, const ImpactOptions& options) {
  return impact(StaticPair::vertex_static_face, gather<double>(v_t0, v_t1, f0, f1, f2).data(), options);
}
std::optional<Impact> vertex_static_face(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& v_t1,
                                         const Eigen::Vector3f& f0, const Eigen::Vector3f& f1,
                                         const Eigen::Vector3f& f2, const ImpactOptions& options) {
  return impact(StaticPair::vertex_static_face, gather<float>(v_t0, v_t1, f0, f1, f2).data(), options);
}
bool vertex_static_face_collides(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& v_t1, const Eigen::Vector3d& f0,
                                 const Eigen::Vector3d& f1, const Eigen::Vector3d& f2) {
  return contact(StaticPair::vertex_static_face, gather<double>(v_t0, v_t1, f0, f1, f2).data());
}
bool vertex_static_face_collides(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& v_t1, const Eigen::Vector3f& f0,
                                 const Eigen::Vector3f& f1, const Eigen::Vector3f& f2) {
  return contact(StaticPair::vertex_static_face, gather<float>(v_t0, v_t1, f0, f1, f2).data());
}

std::optional<Impact> static_vertex_face(const Eigen::Vector3d& v, const Eigen::Vector3d& f0_t0,
                                         const Eigen::Vector3d& f1_t0, const Eigen::Vector3d& f2_t0,
                                         const Eigen::Vector3d& f0_t1, const Eigen::Vector3d& f1_t1,
                                         const Eigen::Vector3d& f2_t1, const ImpactOptions& options) {
  return impact(StaticPair::static_vertex_face, gather<double>(f0_t0, f1_t0, f2_t0, f0_t1, f1_t1, f2_t1, v).data(),
                options);
}
std::optional<Impact> static_vertex_face(const Eigen::Vector3f& v, const Eigen::Vector3f& f0_t0,
                                         const Eigen::Vector3f& f1_t0, const Eigen::Vector3f& f2_t0,
                                         const Eigen::Vector3f& f0_t1, const Eigen::Vector3f& f1_t1,
                                         const Eigen::Vector3f& f2_t1, const ImpactOptions& options) {
  return impact(StaticPair::static_vertex_face, gather<float>(f0_t0, f1_t0, f2_t0, f0_t1, f1_t1, f2_t1, v).data(),
                options);
}
bool static_vertex_face_collides(const Eigen::Vector3d& v, const Eigen::Vector3d& f0_t0, const Eigen::Vector3d& f1_t0,
                                 const Eigen::Vector3d& f2_t0, const Eigen::Vector3d& f0_t1,
                                 const Eigen::Vector3d& f1_t1, const Eigen::Vector3d& f2_t1) {
  return contact(StaticPair::static_vertex_face, gather<double>(f0_t0, f1_t0, f2_t0, f0_t1, f1_t1, f2_t1, v).data());
}
bool static_vertex_face_collides(const Eigen::Vector3f& v, const Eigen::Vector3f& f0_t0, const Eigen::Vector3f& f1_t0,
                                 const Eigen::Vector3f& f2_t0, const Eigen::Vector3f& f0_t1,
                                 const Eigen::Vector3f& f1_t1, const Eigen::Vector3f& f2_t1) {
  return contact(StaticPair::static_vertex_face, gather<float>(f0_t0, f1_t0, f2_t0, f0_t1, f1_t1, f2_t1, v).data());
}

std::optional<Impact> edge_static_edge(const Eigen::Vector3d& ea0_t0, const Eigen::Vector3d& ea1_t0,
                                       const Eigen::Vector3d& ea0_t1, const Eigen::Vector3d& ea1_t1,
                                       const Eigen::Vector3d& eb0, const Eigen::Vector3d& eb1,
                                       const ImpactOptions& options) {
  return impact(StaticPair::edge_static_edge, gather<double>(ea0_t0, ea1_t0, ea0_t1, ea1_t1, eb0, eb1).data(), options);
}
std::optional<Impact> edge_static_edge(const Eigen::Vector3f& ea0_t0, const Eigen::Vector3f& ea1_t0,
                                       const Eigen::Vector3f& ea0_t1, const Eigen::Vector3f& ea1_t1,
                                       const Eigen::Vector3f& eb0, const Eigen::Vector3f& eb1,
                                       const ImpactOptions& options) {
  return impact(StaticPair::edge_static_edge, gather<float>(ea0_t0, ea1_t0, ea0_t1, ea1_t1, eb0, eb1).data(), options);
}
bool edge_static_edge_collides(const Eigen::Vector3d& ea0_t0, const Eigen::Vector3d& ea1_t0,
                               const Eigen::Vector3d& ea0_t1, const Eigen::Vector3d& ea1_t1, const Eigen::Vector3d& eb0,
                               const Eigen::Vector3d& eb1) {
  return contact(StaticPair::edge_static_edge, gather<double>(ea0_t0, ea1_t0, ea0_t1, ea1_t1, eb0, eb1).data());
}
bool edge_static_edge_collides(const Eigen::Vector3f& ea0_t0, const Eigen::Vector3f& ea1_t0,
                               const Eigen::Vector3f& ea0_t1, const Eigen::Vector3f& ea1_t1, const Eigen::Vector3f& eb0,
                               const Eigen::Vector3f& eb1) {
  return contact(StaticPair::edge_static_edge, gather<float>(ea0_t0, ea1_t0, ea0_t1, ea1_t1, eb0, eb1).data());
}

}  // namespace tightrope::ccd
