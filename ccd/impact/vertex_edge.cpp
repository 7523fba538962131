#include "ccd/impact/vertex_edge.h"

#include "vertex_edge.safe.double.h"
#include "vertex_edge.tight.double.h"

// After the generated headers:
#include "ccd/impact/exact_time.h"
#include "ccd/impact/scaled_points.h"
#include "ccd/impact/separation_plane.h"
#include "ccd/impact/vertex_edge_search.h"

namespace tightrope::ccd {
namespace {

using vertex_edge_query::Answer;
using vertex_edge_query::Finding;

/// A query's points, prepared for the filter.
template <std::size_t Dimension>
struct Prepared {
  explicit Prepared(const double* original) : points(original) {
    if (is_moderate<3, Dimension>(original)) return;
    scaled = scaled_to_one<3, Dimension>(original);
    points = scaled.x.data();
    was_scaled = true;
  }
  Prepared(const Prepared&) = delete;
  Prepared& operator=(const Prepared&) = delete;

  using Status = typename ScaledPoints<3, Dimension>::Status;
  ScaledPoints<3, Dimension> scaled;
  const double* points;
  bool was_scaled = false;
};

/// By the filter; `points` are finite and not one point all the time.
template <std::size_t Dimension>
Finding filtered(const Prepared<Dimension>& query, double t_max) {
  return vertex_edge_query::Search<bound::tight, Dimension>(query.points, query.was_scaled).first_contact(t_max);
}

/// In space.
template <std::size_t Dimension>
std::array<double, 18> in_space(const double* points) {
  std::array<double, 18> result{};
  for (std::size_t i = 0; i < 6; ++i) std::copy_n(points + Dimension * i, Dimension, result.data() + 3 * i);
  return result;
}

template <std::size_t Dimension>
std::array<double, 4> weights_at(const Prepared<Dimension>& query, double t) {
  const std::array<double, 18> x = in_space<Dimension>(query.points);
  Positions positions{};
  for (std::size_t i = 0; i < 9; ++i) {
    positions[i / 3][i % 3] = (1 - t) * (x[i] - x[i % 3]) + t * (x[9 + i] - x[9 + i % 3]);
  }
  return nearest_weights(Pair::vertex_edge, positions);
}

template <std::size_t Dimension>
std::optional<Impact> first_impact(const double* points, double tolerance, double t_max) {
  if (t_max < 0) return std::nullopt;
  if (!(t_max < 1)) t_max = 1;
  const Prepared<Dimension> query(points);
  using Status = typename Prepared<Dimension>::Status;
  if (query.scaled.status == Status::not_finite || query.scaled.status == Status::coincident) {
    return Impact{0, {1, 1, 0, 0}};
  }
  if (vertex_edge_query::separated_on_an_axis<Dimension>(points)) return std::nullopt;
  const Finding finding = filtered(query, t_max);
  if (finding.answer == Answer::never) return std::nullopt;
  if (finding.answer == Answer::touches && finding.from > 0 && finding.to - finding.from <= tolerance) {
    return Impact{finding.from, weights_at(query, finding.from + (finding.to - finding.from) / 2)};
  }
  const auto time = exact_first_contact(Pair::vertex_edge, in_space<Dimension>(points).data(), tolerance, t_max);
  if (!time) return std::nullopt;
  return Impact{time->lower, weights_at(query, time->lower + (time->upper - time->lower) / 2)};
}

template <std::size_t Dimension>
bool touches(const double* points) {
  const Prepared<Dimension> query(points);
  if (query.scaled.status != Prepared<Dimension>::Status::scaled) return true;
  if (vertex_edge_query::separated_on_an_axis<Dimension>(points)) return false;
  const Finding finding = filtered(query, 1);
  if (finding.answer != Answer::open) return finding.answer == Answer::touches;
  return exact_contact(Pair::vertex_edge, in_space<Dimension>(points).data());
}

}  // namespace

std::optional<Impact> vertex_edge_impact(const double* points, double tolerance, double t_max) {
  return first_impact<3>(points, tolerance, t_max);
}
std::optional<Impact> vertex_edge_impact_2d(const double* points, double tolerance, double t_max) {
  return first_impact<2>(points, tolerance, t_max);
}
bool vertex_edge_collides(const double* points) { return touches<3>(points); }
bool vertex_edge_collides_2d(const double* points) { return touches<2>(points); }

}  // namespace tightrope::ccd
