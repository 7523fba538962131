#include "ccd/impact/separation.h"

#include "ccd/impact/separation_search.h"
#include "separation.tight.double.h"

namespace tightrope::ccd {
namespace {

/// Along an axis, is the one feature beyond the other by more than `separation` at t = 0 and at t = 1? Rounding is
/// monotone: no difference that is at most the separation becomes larger than it (nor does overflow harm).
bool apart_on_an_axis(Pair pair, const double* points, double separation) {
  const std::size_t count = number_of_points(pair), first = points_of_first(pair);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    bool below = true, above = true;
    for (std::size_t end = 0; end < 2; ++end) {
      const double* const x = points + 3 * count * end + axis;
      for (std::size_t i = 0; i < first; ++i) {
        for (std::size_t j = first; j < count; ++j) {
          below &= x[3 * i] - x[3 * j] > separation;
          above &= x[3 * j] - x[3 * i] > separation;
        }
      }
    }
    if (below || above) return true;
  }
  return false;
}

template <std::size_t Count>
std::optional<Impact> first_approach(Pair pair, const double* points, double separation, double tolerance,
                                     double t_max) {
  const auto search = [&](const double* moderate_points, double moderate_separation) -> std::optional<Impact> {
    const Approach<bound::tight> approach(pair, moderate_points, moderate_separation);
    const std::optional<double> time = approach.first_time(tolerance, t_max);
    if (!time) return std::nullopt;
    return Impact{*time, nearest_weights(pair, approach.positions_at(*time))};
  };
  if (is_moderate<Count>(points) && separation <= 0x1p57) {
    if (apart_on_an_axis(pair, points, separation)) return std::nullopt;
    return search(points, separation);
  }
  using Status = typename ScaledPoints<Count>::Status;
  const ScaledPoints<Count> query = scaled_to_one<Count>(points);
  if (query.status == Status::scaled && apart_on_an_axis(pair, points, separation)) return std::nullopt;
  const double scaled_separation = separation * query.factor;
  // No two points of the scaled query are 2 apart at t = 0.
  if (query.status != Status::scaled || !(scaled_separation < 2)) return Impact{0, nearest_weights(pair, Positions{})};
  return search(query.x.data(), scaled_separation);
}

}  // namespace

std::optional<Impact> first_approach(Pair pair, const double* points, double separation, double tolerance,
                                     double t_max) {
  if (t_max < 0) return std::nullopt;
  if (!(t_max < 1)) t_max = 1;
  if (separation < 0) separation = 0;
  switch (pair) {
    case Pair::vertex_vertex:
      return first_approach<2>(pair, points, separation, tolerance, t_max);
    case Pair::vertex_edge:
      return first_approach<3>(pair, points, separation, tolerance, t_max);
    case Pair::vertex_face:
    case Pair::edge_edge:
      return first_approach<4>(pair, points, separation, tolerance, t_max);
  }
  return std::nullopt;
}

}  // namespace tightrope::ccd
