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
bool separated_by_plane(Kind kind, const Real* points, Signs& signs) {
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

template <class Signs>
Filtered filtered_by_polynomials(Kind kind, const double* points, bool scaled, Question question, double t_max,
                                 Signs& signs) {
  Filtered result{Stage::hull, {Verdict::no_contact}};
  const auto decide = [&](const Bounded<double>(&k)[4], const auto& compute_quadratics) {
    if (common(read_all(signs, k)) != Sign::uncertain) return false;
    const auto z = compute_quadratics();
    for (const auto& axis : hull_signs(z, signs)) {
      if (any_opposite(axis)) return false;
    }
    constexpr std::size_t functions = std::tuple_size_v<std::remove_cvref_t<decltype(z[0])>>;
    Subdivision<functions, Signs> subdivision(question, t_max, signs);
    result.finding = subdivision({k[0], k[1], k[2], k[3]}, z);
    result.stage = result.finding.verdict == Verdict::open ? Stage::exact : Stage::subdivision;
    return true;
  };
  with_polynomials<bound::tight>(kind, points, scaled, decide);
  return result;
}

/// The stages after the separations.
template <class Signs>
Filtered filtered_unseparated(Kind kind, const double* points, Question question, double t_max, Signs& signs) {
  if (has_moderate_coordinates(points) && spread(points) >= least_spread<double>) {
    return filtered_by_polynomials(kind, points, false, question, t_max, signs);
  }
  const NormalizedQuery<double> query = normalize(points);
  if (query.kind != NormalizedQuery<double>::Kind::scaled) return {Stage::exact, {Verdict::open}};
  return filtered_by_polynomials(kind, query.points.data(), true, question, t_max, signs);
}

/// All but the first look. Not inlined: that settles nearly every query, with few registers and no frame.
template <class Signs>
[[gnu::noinline]] Filtered filtered_further(Kind kind, const double* points, Question question, double t_max,
                                            Signs& signs) {
  if (!has_moderate_coordinates(points) && !has_finite_coordinates(points)) return {Stage::exact, {Verdict::open}};
  if (separated(kind, points, signs) || separated_by_plane<false>(kind, points, signs)) {
    return {Stage::separation, {Verdict::no_contact}};
  }
  return filtered_unseparated(kind, points, question, t_max, signs);
}

/// `points` holds 24 numbers; not finite ones leave the query open.
template <class Signs>
Filtered filtered(Kind kind, const double* points, Question question, double t_max, Signs& signs) {
  if (separated_by_plane<true>(kind, points, signs)) return {Stage::first_look, {Verdict::no_contact}};
  return filtered_further(kind, points, question, t_max, signs);
}

/// Single precision is part of double precision; the first look is taken in single precision.
template <class Signs>
Filtered filtered(Kind kind, const float* points, Question question, double t_max, Signs& signs) {
  if (separated_by_plane<true>(kind, points, signs)) return {Stage::first_look, {Verdict::no_contact}};
  return filtered(kind, in_double_precision(points).data(), question, t_max, signs);
}

}  // namespace tightrope::ccd
