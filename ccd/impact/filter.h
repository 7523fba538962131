#pragma once
/// The filter of method `tightrope`: floating point with bounds, as far as it goes. Every answer is a proof.
///
/// Who includes this includes the generated headers first.

#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>

#include "ccd/classification.h"
#include "ccd/impact/stage.h"
#include "ccd/impact/subdivision.h"

namespace tightrope::generated {
template <class Bound, class Real>
struct plane_of_face;
template <class Bound, class Real>
struct plane_of_edges;
}  // namespace tightrope::generated

namespace tightrope::ccd {

/// Does a plane of fixed direction separate the features all the time: one along the face, or along both edges, as they
/// are at t = 0 (`Start`) or at t = 1 (MATH 3.4a)?
template <bool Start, class Real, class Signs>
TIGHTROPE_HOST_DEVICE bool separated_by_plane(Kind kind, const Real* points, Signs& signs) {
  const Real *x = points + (Start ? 0 : 12), *y = points + (Start ? 12 : 0);
  const auto one_side = [&](const auto& sides) {
    return common(signs(sides.near), common(read_all(signs, sides.far))) != Sign::uncertain;
  };
  switch (kind) {
    case Kind::vertex_face:
      return one_side(
          generated::plane_of_face<bound::safe, Real>::evaluate(x, x + 3, x + 6, x + 9, y, y + 3, y + 6, y + 9));
    case Kind::edge_edge:
      return one_side(
          generated::plane_of_edges<bound::safe, Real>::evaluate(x, x + 3, x + 6, x + 9, y, y + 3, y + 6, y + 9));
  }
  return false;
}

struct Filtered {
  Stage stage;  ///< exact: the finding is open
  Finding finding;
};

/// By the polynomials, in the best geometry and with TightBound; with or without subdivision.
template <bool Subdivide, class Signs>
TIGHTROPE_HOST_DEVICE Filtered filtered_by_polynomials(Kind kind, const double* points, bool scaled, Question question,
                                                       double t_max, Signs& signs) {
  Filtered result{Stage::hull, {Verdict::no_contact}};
  const auto decide = [&](const Bounded<double>(&k)[4], const auto& compute_quadratics) {
    if (common(read_all(signs, k)) != Sign::uncertain) return false;
    const auto z = compute_quadratics();
    for (const auto& axis : hull_signs(z, signs)) {
      if (any_opposite(axis)) return false;
    }
    if constexpr (Subdivide) {
      constexpr std::size_t functions = std::tuple_size_v<std::remove_cvref_t<decltype(z[0])>>;
      Subdivision<functions, Signs> subdivision(question, t_max, signs);
      result.finding = subdivision({k[0], k[1], k[2], k[3]}, z);
    } else {
      result.finding = {Verdict::open};
    }
    result.stage = result.finding.verdict == Verdict::open ? Stage::exact : Stage::subdivision;
    return true;
  };
  with_polynomials<bound::tight>(kind, points, scaled, decide);
  return result;
}

/// The stages after the separations; coordinates are finite.
template <bool Subdivide = true, class Signs>
TIGHTROPE_HOST_DEVICE Filtered filtered_unseparated(Kind kind, const double* points, Question question, double t_max,
                                                    Signs& signs) {
  if (has_moderate_coordinates(points) && spread(points) >= least_spread<double>) {
    return filtered_by_polynomials<Subdivide>(kind, points, false, question, t_max, signs);
  }
  const NormalizedQuery<double> query = normalize(points);
  if (query.kind != NormalizedQuery<double>::Kind::scaled) return {Stage::exact, {Verdict::open}};
  return filtered_by_polynomials<Subdivide>(kind, query.points.data(), true, question, t_max, signs);
}

/// The stage `separation`.
template <class Signs>
TIGHTROPE_HOST_DEVICE bool separated_by_axis_or_plane(Kind kind, const double* points, Signs& signs) {
  return separated(kind, points, signs) || separated_by_plane<false>(kind, points, signs);
}

/// All but the first look.
template <class Signs>
TIGHTROPE_RARE Filtered filtered_further(Kind kind, const double* points, Question question, double t_max,
                                         Signs& signs) {
  if (!has_moderate_coordinates(points) && !has_finite_coordinates(points)) return {Stage::exact, {Verdict::open}};
  if (separated_by_axis_or_plane(kind, points, signs)) return {Stage::separation, {Verdict::no_contact}};
  return filtered_unseparated(kind, points, question, t_max, signs);
}

/// `points` holds 24 numbers; not finite ones leave the query open.
template <class Signs>
TIGHTROPE_HOST_DEVICE Filtered filtered(Kind kind, const double* points, Question question, double t_max,
                                        Signs& signs) {
  if (separated_by_plane<true>(kind, points, signs)) return {Stage::first_look, {Verdict::no_contact}};
  return filtered_further(kind, points, question, t_max, signs);
}

/// Single precision is part of double precision; the first look is taken in single precision.
template <class Signs>
TIGHTROPE_HOST_DEVICE Filtered filtered(Kind kind, const float* points, Question question, double t_max, Signs& signs) {
  if (separated_by_plane<true>(kind, points, signs)) return {Stage::first_look, {Verdict::no_contact}};
  return filtered(kind, in_double_precision(points).data(), question, t_max, signs);
}

}  // namespace tightrope::ccd
