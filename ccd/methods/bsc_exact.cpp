/// Bernstein sign classification with every sign exact (MATH 2.7): a filter in floating point, then exact arithmetic.
/// The query's answer is exact, in every degenerate case.

#include <cmath>

#include "classification.exact.double.h"
#include "classification.tight.double.h"
#include "edge_edge.exact.double.h"
#include "edge_edge.tight.double.h"
#include "exact_classification.exact.double.h"
#include "vertex_face.exact.double.h"
#include "vertex_face.tight.double.h"

// After the generated headers:
#include "ccd/classification.h"
#include "ccd/methods/bsc_exact.h"
#include "ccd/methods/exact_arithmetic.h"
#include "ccd/methods/exact_search.h"
#include "ccd/query.h"

namespace tightrope::ccd {
namespace {

using exact::ExactArithmetic;
using exact::FilterArithmetic;

template <std::size_t Functions>
using ExactQuadratics = exact::Quadratics<Dyadic, Functions>;

/// Puts one vector-valued quadratic of a generated predicate, [coefficient][axis], into its place.
template <std::size_t Functions>
void place(ExactQuadratics<Functions>& z, std::size_t function, const std::optional<Dyadic> (&m)[3][3]) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < 3; ++i) z[axis][function][i] = exact::value(m[i][axis]);
  }
}

/// The paths of points of one feature relative to those of the other, as quadratics in t (MATH 1.4 c).
template <std::size_t Pairs>
ExactQuadratics<Pairs> separators(Kind kind, const double* points) {
  ExactQuadratics<Pairs> result;
  std::size_t pair = 0;
  for (const auto& [i, j] : pairs_of_features(kind)) {
    const auto x = moving_point(points, i), y = moving_point(points, j);
    const auto offset = ExactArithmetic::evaluate<generated::offset>(x.t0, x.t1, y.t0, y.t1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Dyadic line[2] = {exact::value(offset.path[0][axis]), exact::value(offset.path[1][axis])};
      result[axis][pair] = exact::values(ExactArithmetic::evaluate<generated::elevated_line>(line).j);
    }
    ++pair;
  }
  return result;
}

template <std::size_t Functions>
bool search(Kind kind, const double* points, const std::optional<Dyadic> (&k)[4], const ExactQuadratics<Functions>& z) {
  ExactArithmetic arithmetic;
  const auto lines = [&] { return separators<Functions>(kind, points); };
  return exact::Search(arithmetic, z, lines).contact(exact::values(k));
}

/// The same decision in floating point: contact or not where every sign that it needs is known.
template <class Signs>
std::optional<bool> filtered(Kind kind, const double* points, Signs& signs) {
  const bool plain = has_moderate_coordinates(points) && spread(points) >= least_spread<double>;
  const auto normalized = plain ? NormalizedQuery<double>{} : normalize(points);
  FilterArithmetic<Signs> arithmetic(signs);
  const bool contact = with_polynomials<bound::tight>(
      kind, plain ? points : normalized.points.data(), !plain, [&](const auto& k, const auto& compute_quadratics) {
        const auto z = compute_quadratics();
        const auto no_lines = [&] { return z; };  // a filter never asks for them
        return exact::Search(arithmetic, z, no_lines).contact(exact::values(k));
      });
  return arithmetic.gave_up() ? std::nullopt : std::optional(contact);
}

}  // namespace

bool exact::contact(Kind kind, const double* points) {
  const auto a = moving_point(points, 0), b = moving_point(points, 1);
  const auto c = moving_point(points, 2), d = moving_point(points, 3);
  switch (kind) {
    case Kind::vertex_face: {
      using predicate = generated::vertex_face<bound::exact, double>;
      const auto coplanarity = predicate::coplanarity_values(a.t0, a.t1, b.t0, b.t1, c.t0, c.t1, d.t0, d.t1);
      const auto inside = predicate::inside_values(a.t0, a.t1, b.t0, b.t1, c.t0, c.t1, d.t0, d.t1);
      ExactQuadratics<3> z;
      place(z, 0, inside.m_ab);
      place(z, 1, inside.m_bc);
      place(z, 2, inside.m_ca);
      return search(kind, points, coplanarity.k, z);
    }
    case Kind::edge_edge: {
      using predicate = generated::edge_edge<bound::exact, double>;
      const auto coplanarity =
          predicate::coplanarity_values(a.t0, a.t1, b.t0, b.t1, c.t0, c.t1, d.t0, d.t1, c.t0, c.t1, a.t0, a.t1);
      const auto inside =
          predicate::inside_values(a.t0, a.t1, b.t0, b.t1, c.t0, c.t1, d.t0, d.t1, c.t0, c.t1, a.t0, a.t1);
      ExactQuadratics<4> z;
      place(z, 0, inside.m_b);
      place(z, 1, inside.m_a);
      place(z, 2, inside.m_d);
      place(z, 3, inside.m_c);
      return search(kind, points, coplanarity.k, z);
    }
  }
  return true;
}

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
