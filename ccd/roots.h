#pragma once
/// The roots of a cubic on a piece of [0, 1] and the signs of other functions there (MATH 2.2 - 2.5). Generated
/// predicates evaluate the polynomials; here are the order of the questions and the exact rescaling between them.
///
/// `Bound` selects the bound mode. `Signs` reads the sign of a bounded number: `SignReader`, or in tests a source that
/// forgets some of them (MATH 6.4). Definite signs are proofs; where a number is not finite, nothing is known.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "ccd/rescale.h"
#include "ccd/sign_reader.h"
#include "ccd/tables.h"
#include "tightrope/sign.h"

namespace tightrope::generated {
template <class Bound, class Real>
struct extremum;
template <class Bound, class Real>
struct tangent;
template <class Bound, class Real>
struct cubic_at_root;
template <class Bound, class Real>
struct slope_at_root;
template <class Bound, class Real>
struct quadratic_at_roots;
}  // namespace tightrope::generated

namespace tightrope::ccd {

template <class Signs, class Real, std::size_t N>
TIGHTROPE_HOST_DEVICE std::array<Sign, N> read_all(Signs& signs, const Bounded<Real> (&numbers)[N]) {
  std::array<Sign, N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = signs(numbers[i]);
  return result;
}

/// A piece of [0, 1] on which the course of the cubic is known. k and q may carry different positive factors.
template <class Real>
struct Piece {
  std::array<Bounded<Real>, 4> k;  ///< Bernstein coefficients, rescaled
  std::array<Bounded<Real>, 3> q;  ///< of the slope, rescaled
  Course course = Course::unknown;
  Branches<bool> possible{false, true};  ///< branches on which there may be a root
  TIGHTROPE_HOST_DEVICE bool any() const { return possible.first || possible.second; }
};

/// Which roots are possible, from the signs alone; the piece's course is set. k, q: signs of the coefficients; bend: of
/// Y'' on the piece; slope_is_monotone: Y' is known to be exactly monotone on the piece.
template <class Real>
TIGHTROPE_HOST_DEVICE void classify_piece(Piece<Real>& piece, const std::array<Sign, 4>& k,
                                          const std::array<Sign, 3>& q, Sign bend, bool slope_is_monotone) {
  if (common(k) != Sign::uncertain) {
    piece.possible = {false, false};
    return;
  }
  Sign direction = single_crossing(k[0], k[1], k[2], k[3]);
  if (direction == Sign::uncertain) direction = common(q);
  switch (direction) {
    case Sign::positive:
      piece.course = Course::rising;
      break;
    case Sign::negative:
      piece.course = Course::falling;
      break;
    case Sign::uncertain:
      piece.course = slope_is_monotone ? course_of_monotone_slope(q[0], q[2], bend) : Course::unknown;
  }
  piece.possible = possible_roots(piece.course, k[0], k[3]);
}

/// The signs of the linear function with coefficients l at the roots of the piece: table B.
template <class Bound, class Real, class Signs>
TIGHTROPE_HOST_DEVICE Branches<Sign> linear_signs(const Piece<Real>& piece, const Bounded<Real> (&l)[2], Signs& signs) {
  const Branches<Sign> unknown{Sign::uncertain, Sign::uncertain};
  const Sign a = signs(l[0]);
  const Sign b = signs(l[1]);
  const Sign everywhere = common(a, b);
  if (everywhere != Sign::uncertain) return {everywhere, everywhere};
  if (piece.course == Course::unknown) return unknown;
  Bounded<Real> line[2] = {l[0], l[1]};
  if (!rescale(line)) return unknown;
  const auto cubic = generated::cubic_at_root<Bound, Real>::evaluate_in_range(piece.k.data(), line);
  const Sign fall = signs(cubic.fall);
  const Sign y = signs(cubic.y);
  if (fall == Sign::uncertain) return unknown;
  Sign g = Sign::uncertain;
  if (piece.course == Course::valley || piece.course == Course::hill) {
    g = signs(generated::slope_at_root<Bound, Real>::evaluate_in_range(piece.q.data(), line).g);
  }
  return linear_at_roots(piece.course, a, b, fall, y, g);
}

/// The signs of the quadratic with coefficients j (rescaled) at the roots of the piece: table C.
template <class Bound, class Real, class Signs>
TIGHTROPE_HOST_DEVICE Branches<Sign> quadratic_signs(const Piece<Real>& piece, const std::array<Bounded<Real>, 3>& j,
                                                     Signs& signs) {
  using predicate = generated::quadratic_at_roots<Bound, Real>;
  const Branches<Sign> unknown{Sign::uncertain, Sign::uncertain};
  if (piece.course == Course::unknown) return unknown;
  typename predicate::State state;
  const auto cofactor = predicate::cofactor_in_range(piece.k.data(), j.data(), state);
  const Branches<Sign> m = linear_signs<Bound>(piece, cofactor.m, signs);
  if (m == unknown) return unknown;
  const auto remainder = predicate::remainder_in_range(piece.k.data(), j.data(), state);
  const Branches<Sign> n = linear_signs<Bound>(piece, remainder.n, signs);
  return {quadratic_at_root(m.first, n.first), quadratic_at_root(m.second, n.second)};
}

/// A guess of the parameter in [0, 1] where the slope with Bernstein coefficients q vanishes; any value will do.
template <class Real>
TIGHTROPE_HOST_DEVICE Real guess_extremum(const std::array<Bounded<Real>, 3>& q) {
  // q0 (1-t)^2 + 2 q1 t (1-t) + q2 t^2 = 0 for s = t / (1 - t): q2 s^2 + 2 q1 s + q0 = 0. Of a valley q0 <= 0 <= q2, of
  // a hill q0 >= 0 >= q2, so that s = (-q1 +- root) / q2 with the sign of q2, written without cancellation.
  const Real q0 = q[0].value, q1 = q[1].value, q2 = q[2].value;
  const Real root = std::sqrt(std::max(tightrope::product(q1, q1) - tightrope::product(q0, q2), Real{0}));
  const Real numerator = std::fabs(q0), denominator = (q2 < 0 ? -q1 : q1) + root;
  const Real t = numerator / (numerator + denominator);
  return t >= 0 && t <= 1 ? t : Real{0.5};
}

/// Is the piece, a valley or hill with possible roots on both branches, without roots? Proved by the tangent at a guess
/// of the extremum or by the Root-Finding Lemma; k, q: signs of the coefficients.
template <class Bound, class Real, class Signs>
TIGHTROPE_HOST_DEVICE bool misses_zero(const Piece<Real>& piece, const std::array<Sign, 4>& k,
                                       const std::array<Sign, 3>& q, Signs& signs) {
  // Without this both proofs have a hole: where q0 is uncertain a "valley" may be a rising concave curve, whose tangent
  // lies above it, and whose extremum lies outside the piece.
  if (!extremum_decides(piece.course, q[0], q[2], k[0], k[3])) return false;
  const Sign outside = piece.course == Course::valley ? Sign::positive : Sign::negative;
  const auto tangent = generated::tangent<Bound, Real>::evaluate_in_range(piece.k.data(), guess_extremum(piece.q));
  if (signs(outside == Sign::positive ? tangent.above : tangent.below) == outside) return true;
  const auto lemma = generated::extremum<Bound, Real>::evaluate_in_range(piece.k.data());
  const Sign delta = signs(lemma.delta);
  const auto rest = read_all(signs, lemma.rest);
  Bounded<Real> line[2] = {lemma.rest[0], lemma.rest[1]};
  if (delta == Sign::uncertain || !rescale(line)) return false;
  const auto slope = generated::slope_at_root<Bound, Real>::evaluate_in_range(piece.q.data(), line);
  return sign_at_extremum(piece.course, delta, rest[0], rest[1], signs(slope.fall), signs(slope.g)) == outside;
}

}  // namespace tightrope::ccd
