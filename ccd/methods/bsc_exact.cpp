/// Bernstein sign classification with every sign exact (MATH 2.7): a filter in floating point, then exact arithmetic.
/// The query's answer is exact, in every degenerate case.

#include <cmath>

#include "classification.tight.double.h"
#include "edge_edge.tight.double.h"
#include "vertex_face.tight.double.h"

// After the generated headers:
#include "ccd/classification.h"
#include "ccd/impact/exact_time.h"
#include "ccd/methods/bsc_exact.h"
#include "ccd/methods/exact_arithmetic.h"
#include "ccd/methods/exact_search.h"
#include "ccd/query.h"

namespace tightrope::ccd {
namespace {

using exact::FilterArithmetic;

/// Contact or not, in floating point, where every sign that this needs is known.
template <class Signs>
std::optional<bool> filtered(Kind kind, const double* points, Signs& signs) {
  const bool plain = has_moderate_coordinates(points) && spread(points) >= least_spread<double>;
  const auto normalized = plain ? NormalizedQuery<double>{} : normalize(points);
  FilterArithmetic<Signs> arithmetic(signs);
  const bool contact = with_polynomials<bound::tight>(kind, plain ? points : normalized.points.data(), !plain,
                                                      [&](const auto& k, const auto& compute_quadratics) {
                                                        const auto z = compute_quadratics();
                                                        return exact::Search(arithmetic, z).contact(exact::values(k));
                                                      });
  return arithmetic.gave_up() ? std::nullopt : std::optional(contact);
}

}  // namespace

bool exact::contact(Kind kind, const double* points) { return exact_contact(pair_of(kind), points); }

std::optional<bool> exact::filtered_contact(Kind kind, const double* points) {
  SignReader signs;
  return filtered(kind, points, signs);
}

namespace {

bool may_touch(Kind kind, const double* points, SignReader&) { return tight_collides(kind, points); }
bool may_touch(Kind kind, const double* points, CountingSignReader& signs) {
  return tight_collides(kind, points, signs);
}

template <class Signs>
bool decide(Kind kind, const double* points, Signs& signs) {
  if (!may_touch(kind, points, signs)) return false;
  if (!std::all_of(points, points + numbers_per_query, [](double x) { return std::isfinite(x); })) return true;
  if (const auto answer = filtered(kind, points, signs)) return *answer;
  return exact::contact(kind, points);
}

/// Single precision is part of double precision.
template <class Signs>
bool decide(Kind kind, const float* points, Signs& signs) {
  std::array<double, numbers_per_query> exact_points;
  std::copy_n(points, numbers_per_query, exact_points.begin());
  return decide(kind, exact_points.data(), signs);
}

}  // namespace

template <class Real>
bool bsc_exact_collides(Kind kind, const Real* points) {
  SignReader signs;
  return decide(kind, points, signs);
}

template <class Real>
bool bsc_exact_collides(Kind kind, const Real* points, CountingSignReader& signs) {
  return decide(kind, points, signs);
}

template bool bsc_exact_collides(Kind, const double*);
template bool bsc_exact_collides(Kind, const double*, CountingSignReader&);
template bool bsc_exact_collides(Kind, const float*);
template bool bsc_exact_collides(Kind, const float*, CountingSignReader&);

}  // namespace tightrope::ccd
