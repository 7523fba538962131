/// The public form of the time of impact: options and the choice of the query.

#include <algorithm>
#include <array>
#include <cstddef>

#include "ccd/impact/options.h"
#include "ccd/impact/query.h"
#include "ccd/impact/separation.h"
#include "ccd/impact/vertex_edge.h"
#include "ccd/impact/vertex_vertex.h"
#include "ccd/query.h"
#include "tightrope/plain.h"

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

}  // namespace

std::optional<Impact> first_impact(Pair pair, const double* points, const ImpactOptions& options) {
  return impact(pair, points, options);
}
std::optional<Impact> first_impact(Pair pair, const float* points, const ImpactOptions& options) {
  return impact(pair, points, options);
}

bool collides(Pair pair, const double* points) { return contact(pair, points); }
bool collides(Pair pair, const float* points) { return contact(pair, points); }

}  // namespace tightrope::ccd
