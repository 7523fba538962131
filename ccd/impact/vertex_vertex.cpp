/// Two vertices meet at t if and only if d = q - p is 0 there. d is linear: an axis in which it has one sign at t = 0
/// and at t = 1 separates them; and where (1 - t) d(0) + t d(1) = 0, d(0) x d(1) = 0.

#include "ccd/impact/vertex_vertex.h"

#include <span>

#include "ccd/geometry.h"
#include "ccd/impact/exact_time.h"
#include "ccd/impact/scaled_points.h"
#include "vertex_vertex.tight.double.h"

namespace tightrope::ccd {
namespace {

constexpr std::array<double, 4> weights{1, 1, 0, 0};

/// The signs of rounded differences are exact.
bool separated_on_an_axis(const double* points) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at_0 = points[axis + 3] - points[axis], at_1 = points[axis + 9] - points[axis + 6];
    if ((at_0 > 0 && at_1 > 0) || (at_0 < 0 && at_1 < 0)) return true;
  }
  return false;
}

bool moment_excludes(const double* points, bool scaled) {
  using predicate = generated::vertex_vertex<bound::tight, double>;
  auto result = predicate::evaluate_in_range(points, points + 6, points + 3, points + 9);
  if (scaled) widen(std::span<Bounded<double>>(result.moment));
  return sign(result.moment[0]) != Sign::uncertain || sign(result.moment[1]) != Sign::uncertain ||
         sign(result.moment[2]) != Sign::uncertain;
}

/// Whether there can be contact, as far as floating point can tell.
enum class Filtered { never, perhaps, at_once };

Filtered filtered(const double* points) {
  if (is_moderate<2>(points)) {
    return separated_on_an_axis(points) || moment_excludes(points, false) ? Filtered::never : Filtered::perhaps;
  }
  const ScaledPoints<2> query = scaled_to_one<2>(points);
  if (query.status != ScaledPoints<2>::Status::scaled) return Filtered::at_once;
  return separated_on_an_axis(points) || moment_excludes(query.x.data(), true) ? Filtered::never : Filtered::perhaps;
}

}  // namespace

std::optional<Impact> vertex_vertex_impact(const double* points, double tolerance, double t_max) {
  if (t_max < 0) return std::nullopt;
  if (!(t_max < 1)) t_max = 1;
  switch (filtered(points)) {
    case Filtered::never:
      return std::nullopt;
    case Filtered::at_once:
      return Impact{0, weights};
    case Filtered::perhaps:
      break;
  }
  const auto time = exact_first_contact(Pair::vertex_vertex, points, tolerance, t_max);
  if (!time) return std::nullopt;
  return Impact{time->lower, weights};
}

bool vertex_vertex_collides(const double* points) {
  switch (filtered(points)) {
    case Filtered::never:
      return false;
    case Filtered::at_once:
      return true;
    case Filtered::perhaps:
      return exact_contact(Pair::vertex_vertex, points);
  }
  return true;
}

}  // namespace tightrope::ccd
