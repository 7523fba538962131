#pragma once
/// The decision tables of Bernstein sign classification: pure functions of three-valued signs.
///
/// After "TightCCD: Efficient and Robust Continuous Collision Detection using Tight Error Bounds" (Wang, Tang, Tong,
/// Manocha 2015), repaired and closed as in MATH 2. `uncertain` means that a sign is not known, never that a number is
/// zero; a definite result is a proof for every exact situation that the arguments leave open.

#include <span>

#include "tightrope/sign.h"

namespace tightrope::ccd {

/// Two signs as one value, so that a switch without default covers every combination: n(egative), u(ncertain),
/// p(ositive).
enum class SignPair : unsigned char { nn, nu, np, un, uu, up, pn, pu, pp };

constexpr SignPair pair(Sign a, Sign b) {
  return static_cast<SignPair>(3 * (static_cast<int>(a) + 1) + static_cast<int>(b) + 1);
}

/// The sign that both have, or `uncertain`.
constexpr Sign common(Sign a, Sign b) {
  switch (pair(a, b)) {
    case SignPair::nn:
      return Sign::negative;
    case SignPair::pp:
      return Sign::positive;
    case SignPair::nu:
    case SignPair::np:
    case SignPair::un:
    case SignPair::uu:
    case SignPair::up:
    case SignPair::pn:
    case SignPair::pu:
      return Sign::uncertain;
  }
  return Sign::uncertain;
}

/// The sign that all have, or `uncertain`: by the hull property, of a polynomial on all of [0, 1].
constexpr Sign common(std::span<const Sign> signs) {
  Sign all = signs.front();
  for (const Sign s : signs.subspan(1)) all = common(all, s);
  return all;
}

constexpr bool opposite(Sign a, Sign b) {
  switch (pair(a, b)) {
    case SignPair::np:
    case SignPair::pn:
      return true;
    case SignPair::nn:
    case SignPair::nu:
    case SignPair::un:
    case SignPair::uu:
    case SignPair::up:
    case SignPair::pu:
    case SignPair::pp:
      return false;
  }
  return false;
}

constexpr Sign product(Sign a, Sign b) {
  switch (pair(a, b)) {
    case SignPair::nn:
    case SignPair::pp:
      return Sign::positive;
    case SignPair::np:
    case SignPair::pn:
      return Sign::negative;
    case SignPair::nu:
    case SignPair::un:
    case SignPair::uu:
    case SignPair::up:
    case SignPair::pu:
      return Sign::uncertain;
  }
  return Sign::uncertain;
}

/// Does the sequence -, a, b, + have exactly one sign change, whatever the uncertain ones are? Only (+, -) has more.
constexpr bool changes_once_between_negative_and_positive(Sign a, Sign b) {
  switch (pair(a, b)) {
    case SignPair::nn:
    case SignPair::nu:
    case SignPair::np:
    case SignPair::up:
    case SignPair::pp:
      return true;
    case SignPair::un:  // may be +, -
    case SignPair::uu:
    case SignPair::pn:
    case SignPair::pu:
      return false;
  }
  return false;
}

/// Descartes' rule (MATH 2.1, step 2): a cubic whose coefficients change sign exactly once has one root in (0, 1),
/// where it goes up (positive) or down (negative); else `uncertain`.
constexpr Sign single_crossing(Sign k0, Sign k1, Sign k2, Sign k3) {
  switch (pair(k0, k3)) {
    case SignPair::np:
      return changes_once_between_negative_and_positive(k1, k2) ? Sign::positive : Sign::uncertain;
    case SignPair::pn:
      return changes_once_between_negative_and_positive(-k1, -k2) ? Sign::negative : Sign::uncertain;
    case SignPair::nn:
    case SignPair::nu:
    case SignPair::un:
    case SignPair::uu:
    case SignPair::up:
    case SignPair::pu:
    case SignPair::pp:
      return Sign::uncertain;
  }
  return Sign::uncertain;
}

/// What a cubic Y does on a piece of [0, 1], as far as its roots are concerned. Each but `unknown` includes its
/// degenerate forms: a valley may lack its descending or its ascending branch.
enum class Course : unsigned char {
  rising,   ///< one root at most, where Y goes from - to +
  falling,  ///< one root at most, where Y goes from + to -
  valley,   ///< Y' never goes from + to -: a root on the descending branch, one on the ascending branch
  hill,     ///< the mirror image, - Y is a valley
  unknown,  ///< nothing is known; all roots are treated as one anonymous root
};

/// Table A (MATH 2.2): the course from the signs of the slope's end coefficients and of the bend, given that Y' is
/// exactly monotone on the piece.
constexpr Course course_of_monotone_slope(Sign q0, Sign q2, Sign bend) {
  switch (pair(q0, q2)) {
    case SignPair::pp:
      return Course::rising;
    case SignPair::nn:
      return Course::falling;
    case SignPair::up:
    case SignPair::nu:
    case SignPair::np:
      return Course::valley;
    case SignPair::un:
    case SignPair::pu:
    case SignPair::pn:
      return Course::hill;
    case SignPair::uu:
      switch (bend) {
        case Sign::positive:
          return Course::valley;
        case Sign::negative:
          return Course::hill;
        case Sign::uncertain:
          return Course::unknown;
      }
  }
  return Course::unknown;
}

/// For each of the two branches of a valley or hill something; the single root of the other courses is on `second`.
template <class T>
struct Branches {
  T first;
  T second;
  constexpr bool operator==(const Branches&) const = default;
};

/// Can Y have a root on the branch (MATH 2.2)? k0 and k3: signs of Y at the ends.
constexpr Branches<bool> possible_roots(Course course, Sign k0, Sign k3) {
  switch (course) {
    case Course::rising:
      return {false, k0 != Sign::positive && k3 != Sign::negative};
    case Course::falling:
      return {false, k0 != Sign::negative && k3 != Sign::positive};
    case Course::valley:
      return {k0 != Sign::negative, k3 != Sign::negative};
    case Course::hill:
      return {k0 != Sign::positive, k3 != Sign::positive};
    case Course::unknown:
      return {false, true};
  }
  return {true, true};
}

/// Root-Finding Lemma (MATH 2.3): the sign of Y at the extremum of a valley or hill, where Y has the sign of
/// delta * rest. rest0, rest1: end coefficients of the linear `rest`; fall: of rest0 - rest1; g: of the slope at its
/// root.
constexpr Sign sign_at_extremum(Course course, Sign delta, Sign rest0, Sign rest1, Sign fall, Sign g) {
  const Sign everywhere = common(rest0, rest1);
  if (everywhere != Sign::uncertain) return product(everywhere, delta);
  if (fall == Sign::uncertain || course == Course::rising || course == Course::falling || course == Course::unknown) {
    return Sign::uncertain;
  }
  switch (course == Course::hill ? -g : g) {
    case Sign::negative:
      return product(rest1, delta);  // the root of `rest` is left of the extremum
    case Sign::positive:
      return product(rest0, delta);  // right of it
    case Sign::uncertain:
      return Sign::uncertain;
  }
  return Sign::uncertain;
}

/// May a valley whose extremum is above 0 (a hill: below) be dropped? Only if the extremum is in the piece, or the ends
/// are on that side too (MATH 2.3): `rest` decides at the extremum of the whole cubic.
constexpr bool extremum_decides(Course course, Sign q0, Sign q2, Sign k0, Sign k3) {
  switch (course) {
    case Course::valley:
      return pair(q0, q2) == SignPair::np || pair(k0, k3) == SignPair::pp;
    case Course::hill:
      return pair(q0, q2) == SignPair::pn || pair(k0, k3) == SignPair::nn;
    case Course::rising:
    case Course::falling:
    case Course::unknown:
      return false;
  }
  return false;
}

namespace detail {

/// Table B for a valley whose linear function is a before its root and b after it.
constexpr Branches<Sign> linear_at_roots_of_valley(Sign a, Sign b, Sign y, Sign g) {
  switch (pair(y, g)) {
    case SignPair::nn:
    case SignPair::nu:
    case SignPair::np:
      return {a, b};  // Y < 0 there: between the roots
    case SignPair::pn:
      return {b, b};  // left of both
    case SignPair::pp:
      return {a, a};  // right of both
    case SignPair::un:
      return {Sign::uncertain, b};
    case SignPair::up:
      return {a, Sign::uncertain};
    case SignPair::uu:
    case SignPair::pu:
      return {Sign::uncertain, Sign::uncertain};
  }
  return {Sign::uncertain, Sign::uncertain};
}

/// Table B for a rising cubic: y < 0 means that the root of Y comes after that of the linear function.
constexpr Sign linear_at_root_of_rising(Sign a, Sign b, Sign y) {
  switch (y) {
    case Sign::negative:
      return b;
    case Sign::positive:
      return a;
    case Sign::uncertain:
      return Sign::uncertain;
  }
  return Sign::uncertain;
}

}  // namespace detail

/// Table B (MATH 2.4): the signs of the linear function a (1 - t) + b t at the roots of Y. fall: sign of a - b;
/// y, g: signs of (a - b)^3 Y and (a - b)^2 Y' at its root.
constexpr Branches<Sign> linear_at_roots(Course course, Sign a, Sign b, Sign fall, Sign y, Sign g) {
  constexpr Branches<Sign> none{Sign::uncertain, Sign::uncertain};
  const Sign everywhere = common(a, b);
  if (everywhere != Sign::uncertain) return {everywhere, everywhere};
  const Sign at_root = product(y, fall);
  switch (course) {
    case Course::rising:
      return {Sign::uncertain, detail::linear_at_root_of_rising(a, b, at_root)};
    case Course::falling:
      return {Sign::uncertain, detail::linear_at_root_of_rising(a, b, -at_root)};
    case Course::valley:
      return fall == Sign::uncertain ? none : detail::linear_at_roots_of_valley(a, b, at_root, g);
    case Course::hill:
      return fall == Sign::uncertain ? none : detail::linear_at_roots_of_valley(a, b, -at_root, -g);
    case Course::unknown:
      return none;
  }
  return none;
}

/// Table C (MATH 2.5): square * Y = j m + n, so that j has the sign of - m n at a root of Y.
constexpr Sign quadratic_at_root(Sign m, Sign n) { return -product(m, n); }

}  // namespace tightrope::ccd
