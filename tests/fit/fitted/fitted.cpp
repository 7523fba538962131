#include "fitted.h"

#include <tightrope/fitted.h>

#include <limits>

#include "fitted_vertex_face.static.double.h"
#include "fitted_edge_edge.static.double.h"

namespace {

namespace fitted = tightrope::ccd::fitted;
using tightrope::ccd::Kind;
using tightrope::ccd::Method;

struct VertexFace {
  using Real = double;
  using Plane = tightrope::generated::fitted_plane_of_face<tightrope::bound::fixed, double>;
  using AtRest = tightrope::generated::fitted_face_at_rest<tightrope::bound::fixed, double>;
  static constexpr Real range = 0x1p-6;  // as in fitted_vertex_face.pred
  static constexpr bool both_ends = false;
};

struct EdgeEdge {
  using Real = double;
  using Plane = tightrope::generated::fitted_plane_of_edges<tightrope::bound::fixed, double>;
  using AtRest = tightrope::generated::fitted_edge_at_rest<tightrope::bound::fixed, double>;
  static constexpr Real range = 0x1p-6;  // as in fitted_edge_edge.pred
  static constexpr bool both_ends = false;
};

}  // namespace

bool fitted_vertex_face(const double* points) {
  return fitted::contact<Kind::vertex_face, VertexFace>(points, Method::tightrope);
}
void fitted_vertex_face(const double* points, std::size_t count, unsigned char* results) {
  fitted::contacts<Kind::vertex_face, VertexFace>(points, count, results, Method::tightrope);
}
std::optional<tightrope::ccd::Impact> fitted_vertex_face_impact(const double* points,
    const tightrope::ccd::ImpactOptions& options) {
  // The look tells of contact alone, not of distances.
  if (options.minimum_separation <= 0 && fitted::apart<Kind::vertex_face, VertexFace>(points)) return std::nullopt;
  return tightrope::ccd::first_impact(tightrope::ccd::Pair::vertex_face, points, options);
}

bool fitted_edge_edge(const double* points) {
  return fitted::contact<Kind::edge_edge, EdgeEdge>(points, Method::tightrope);
}
void fitted_edge_edge(const double* points, std::size_t count, unsigned char* results) {
  fitted::contacts<Kind::edge_edge, EdgeEdge>(points, count, results, Method::tightrope);
}
std::optional<tightrope::ccd::Impact> fitted_edge_edge_impact(const double* points,
    const tightrope::ccd::ImpactOptions& options) {
  // The look tells of contact alone, not of distances.
  if (options.minimum_separation <= 0 && fitted::apart<Kind::edge_edge, EdgeEdge>(points)) return std::nullopt;
  return tightrope::ccd::first_impact(tightrope::ccd::Pair::edge_edge, points, options);
}
