#pragma once
/// The decision tables of Bernstein sign classification for signs that are known exactly (MATH 2.7): zero is a sign
/// like the others, and every answer is definite. tables.h has the tables for signs that may be uncertain.
///
/// After "TightCCD: Efficient and Robust Continuous Collision Detection using Tight Error Bounds" (Wang, Tang, Tong,
/// Manocha 2015), whose tables leave these cases open.

#include <array>
#include <optional>

#include "ccd/tables.h"

namespace tightrope::ccd::exact {

/// The sign of a number that is known exactly; unlike Sign, it has no `uncertain`, and it does not convert to one.
enum class DefiniteSign : signed char { negative = -1, zero = 0, positive = 1 };

constexpr DefiniteSign operator-(DefiniteSign s) { return static_cast<DefiniteSign>(-static_cast<signed char>(s)); }

constexpr DefiniteSign operator*(DefiniteSign a, DefiniteSign b) {
  return static_cast<DefiniteSign>(static_cast<signed char>(a) * static_cast<signed char>(b));
}

constexpr bool opposite(DefiniteSign a, DefiniteSign b) { return a * b == DefiniteSign::negative; }

/// Sign changes in a sequence, zeros left out: by Descartes' rule as many roots as the polynomial with these Bernstein
/// coefficients has in (0, 1), counted with multiplicity, or an even number more.
template <std::size_t N>
constexpr int sign_changes(const std::array<DefiniteSign, N>& signs) {
  int changes = 0;
  DefiniteSign last = DefiniteSign::zero;
  for (const DefiniteSign s : signs) {
    if (s == DefiniteSign::zero) continue;
    changes += opposite(s, last) ? 1 : 0;
    last = s;
  }
  return changes;
}

/// The course of a cubic whose slope is monotone and not identically zero, from the slope's signs at the ends.
///
/// If neither is negative, the slope is positive but at one point at most: strictly rising; likewise falling. Else the
/// slope changes its sign once, strictly inside.
constexpr Course course_of_monotone_slope(DefiniteSign q0, DefiniteSign q2) {
  if (q0 != DefiniteSign::negative && q2 != DefiniteSign::negative) return Course::rising;
  if (q0 != DefiniteSign::positive && q2 != DefiniteSign::positive) return Course::falling;
  return q0 == DefiniteSign::negative ? Course::valley : Course::hill;
}

/// Must the sign of a valley or hill at its extremum be asked for? Else it is below (above) zero: so is an end, or an
/// end is zero and the slope leads away from it.
constexpr bool extremum_is_open(Course course, DefiniteSign k0, DefiniteSign k3) {
  const DefiniteSign outside = course == Course::valley ? DefiniteSign::positive : DefiniteSign::negative;
  return (course == Course::valley || course == Course::hill) && k0 == outside && k3 == outside;
}

/// On which branches the cubic has a root; k0, k3: its signs at the ends, `extremum`: at the extremum of a valley or
/// hill. Both branches have the same root if the extremum is zero.
constexpr Branches<bool> existing_roots(Course course, DefiniteSign k0, DefiniteSign k3, DefiniteSign extremum) {
  const bool inverted = course == Course::falling || course == Course::hill;
  const DefiniteSign a = inverted ? -k0 : k0, b = inverted ? -k3 : k3;
  const bool dips = (inverted ? -extremum : extremum) != DefiniteSign::positive;
  switch (course) {
    case Course::rising:
    case Course::falling:
      return {false, a != DefiniteSign::positive && b != DefiniteSign::negative};
    case Course::valley:
    case Course::hill:
      return {a != DefiniteSign::negative && dips, b != DefiniteSign::negative && dips};
    case Course::unknown:
      return {false, false};
  }
  return {false, false};
}

/// The signs that a linear function with the end signs a, b (not both zero, not equal) has before and after its root.
constexpr Branches<DefiniteSign> sides(DefiniteSign a, DefiniteSign b) {
  return {a != DefiniteSign::zero ? a : -b, b != DefiniteSign::zero ? b : -a};
}

/// Is the first end of a linear function above the second? Of unequal signs, the signs tell.
constexpr DefiniteSign fall(DefiniteSign a, DefiniteSign b) {
  return a > b ? DefiniteSign::positive : a < b ? DefiniteSign::negative : DefiniteSign::zero;
}

/// Root-Finding Lemma: the sign of a valley or hill at its extremum, where it has the sign of delta * rest. rest0,
/// rest1: end signs of the linear `rest`; g: sign of the slope at the root of `rest` (asked for if they differ); the
/// extremum is right of it where the slope still goes down (of a hill: up).
constexpr DefiniteSign sign_at_extremum(Course course, DefiniteSign delta, DefiniteSign rest0, DefiniteSign rest1,
                                        DefiniteSign g) {
  if (rest0 == rest1) return rest0 * delta;
  switch (course == Course::hill ? -g : g) {
    case DefiniteSign::negative:
      return sides(rest0, rest1).second * delta;
    case DefiniteSign::zero:
      return DefiniteSign::zero;
    case DefiniteSign::positive:
      return sides(rest0, rest1).first * delta;
  }
  return DefiniteSign::zero;
}

/// Table B: the signs at the existing roots of Y of a linear function with the end signs a and b. y, g: signs of Y and
/// Y' at the linear function's root (asked for if a and b differ, g of valleys and hills).
///
/// A rising Y is below zero before its root and above it after; so is a cubic with one sign change. A valley is below
/// zero between its roots; where it is above, the slope tells on which side of both; where it is zero, the slope tells
/// which of the two roots this is, the double one if the slope is zero.
constexpr Branches<DefiniteSign> linear_at_roots(Course course, DefiniteSign a, DefiniteSign b, DefiniteSign y,
                                                 DefiniteSign g) {
  if (a == b) return {a, a};
  const auto [before, after] = sides(a, b);
  const bool inverted = course == Course::falling || course == Course::hill;
  const DefiniteSign height = inverted ? -y : y, slope = inverted ? -g : g;
  const bool one_root = course == Course::rising || course == Course::falling;
  switch (height) {
    case DefiniteSign::negative:
      return {one_root ? after : before, after};
    case DefiniteSign::positive:
      if (one_root || slope == DefiniteSign::positive) return {before, before};
      return {after, after};
    case DefiniteSign::zero:
      if (one_root || slope == DefiniteSign::zero) return {DefiniteSign::zero, DefiniteSign::zero};
      if (slope == DefiniteSign::negative) return {DefiniteSign::zero, after};
      return {before, DefiniteSign::zero};
  }
  return {DefiniteSign::zero, DefiniteSign::zero};
}

/// Table C: square * Y = j m + n, so that j has the sign of -m n at a root of Y; empty where m, and so n, vanishes.
constexpr std::optional<DefiniteSign> quadratic_at_root(DefiniteSign m, DefiniteSign n) {
  if (m == DefiniteSign::zero) return std::nullopt;
  return -(m * n);
}

/// What functions of which no two have opposite signs at a contact say about a point where the four points are
/// coplanar.
enum class Verdict : unsigned char {
  contact,     ///< no two opposite, not all zero (MATH 1.4 b)
  no_contact,  ///< two opposite (MATH 1.4 a)
  open,        ///< all zero
};

template <std::size_t N>
constexpr Verdict verdict(const std::array<DefiniteSign, N>& signs) {
  DefiniteSign seen = DefiniteSign::zero;
  for (const DefiniteSign s : signs) {
    if (opposite(s, seen)) return Verdict::no_contact;
    if (s != DefiniteSign::zero) seen = s;
  }
  return seen == DefiniteSign::zero ? Verdict::open : Verdict::contact;
}

}  // namespace tightrope::ccd::exact
