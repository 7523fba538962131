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

namespace tightrope::ccd {

struct Filtered {
  Stage stage;  ///< exact: the finding is open
  Finding finding;
};

/// Not inlined: what comes before it settles nearly every query, with few registers and no frame.
template <class Signs>
[[gnu::noinline]] Filtered filtered_by_polynomials(Kind kind, const double* points, bool scaled, Question question,
                                                   double t_max, Signs& signs) {
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

/// `points` holds 24 numbers; not finite ones leave the query open.
template <class Signs>
Filtered filtered(Kind kind, const double* points, Question question, double t_max, Signs& signs) {
  if (has_moderate_coordinates(points)) {
    if (never_coplanar<bound::safe>(kind, points, signs)) return {Stage::first_look, {Verdict::no_contact}};
    if (separated(kind, points, signs)) return {Stage::separation, {Verdict::no_contact}};
    if (spread(points) >= least_spread<double>) {
      return filtered_by_polynomials(kind, points, false, question, t_max, signs);
    }
  }
  const NormalizedQuery<double> query = normalize(points);
  if (query.kind != NormalizedQuery<double>::Kind::scaled) return {Stage::exact, {Verdict::open}};
  if (separated(kind, points, signs)) return {Stage::separation, {Verdict::no_contact}};
  return filtered_by_polynomials(kind, query.points.data(), true, question, t_max, signs);
}

/// Single precision is part of double precision; the first look is taken in single precision.
template <class Signs>
Filtered filtered(Kind kind, const float* points, Question question, double t_max, Signs& signs) {
  if (has_moderate_coordinates(points) && never_coplanar<bound::safe>(kind, points, signs)) {
    return {Stage::first_look, {Verdict::no_contact}};
  }
  return filtered(kind, in_double_precision(points).data(), question, t_max, signs);
}

}  // namespace tightrope::ccd
