#pragma once
/// Bernstein sign classification with every sign definite: decided in floating point with bounds, which gives up where
/// a bound does not tell a sign (MATH 2.7). The answer is then contact or no contact. A filter: zeros are never known,
/// so degenerate cases are left to the exact stage (ccd/impact/exact_time.h).
///
/// `Arithmetic`: FilterArithmetic of exact_arithmetic.h. Who includes this includes the generated headers first.

#include <algorithm>
#include <array>
#include <cstddef>

#include "ccd/methods/exact_tables.h"

namespace tightrope::generated {
template <class Bound, class Real>
struct differences;
template <class Bound, class Real>
struct split_cubic;
template <class Bound, class Real>
struct split_quadratic;
template <class Bound, class Real>
struct extremum;
template <class Bound, class Real>
struct cubic_at_root;
template <class Bound, class Real>
struct slope_at_root;
}  // namespace tightrope::generated

namespace tightrope::ccd::exact {

template <class Number>
using Quadratic = std::array<Number, 3>;

/// Coefficients of functions of the points that are quadratic in t, [axis][function].
template <class Number, std::size_t Functions>
using Quadratics = std::array<std::array<Quadratic<Number>, Functions>, 3>;

/// The part of [0, 1] that a piece of a cubic stands for: all of it, or before or after the inflection at t / (s + t).
template <class Number>
struct Part {
  enum class Place { whole, before, after } place = Place::whole;
  Number s{}, t{};
};

/// A cubic on a part of [0, 1] where it has one of the four courses, and its roots there.
template <class Number>
struct Piece {
  std::array<Number, 4> k;
  std::array<Number, 3> q;  ///< of the slope; may carry another positive factor than k
  Course course;
  Branches<bool> exists;
};

template <class Arithmetic, std::size_t Functions>
class Search {
 public:
  using Number = typename Arithmetic::Number;

  /// z: the projected quadratics of theorem 1.4.
  Search(Arithmetic& arithmetic, const Quadratics<Number, Functions>& z)
      : arithmetic_(arithmetic), z_(z), axes_(arithmetic.axes(z)) {}

  /// Is there contact at some t in [0, 1]? k: coefficients of the cubic Y, zero where the points are coplanar. If the
  /// arithmetic gave up the answer means nothing.
  bool contact(const std::array<Number, 4>& k) {
    const auto signs = signs_of(k);
    return !arithmetic_.gave_up() && contact_at_roots(k, signs);
  }

 private:
  template <std::size_t N>
  std::array<DefiniteSign, N> signs_of(const std::array<Number, N>& numbers) {
    std::array<DefiniteSign, N> signs;
    for (std::size_t i = 0; i < N; ++i) signs[i] = arithmetic_.sign(numbers[i]);
    return signs;
  }

  /// Is there contact at a root of the cubic with the coefficients k in (0, 1)?
  bool contact_at_roots(const std::array<Number, 4>& k, const std::array<DefiniteSign, 4>& signs) {
    const int changes = sign_changes(signs);
    if (changes == 0) return false;  // none in (0, 1)
    Piece<Number> whole{k, {}, Course::rising, {false, true}};
    arithmetic_.rescale(whole.k);
    if (changes == 1 && opposite(signs[0], signs[3])) {
      if (signs[0] == DefiniteSign::positive) whole.course = Course::falling;
      return contact_on(whole, {});
    }
    const auto slopes = arithmetic_.template evaluate<generated::differences>(whole.k.data());
    const auto c = values(slopes.c);
    const auto bends = signs_of(c);
    whole.q = values(slopes.q);
    arithmetic_.rescale(whole.q);
    if (opposite(bends[0], bends[1])) return contact_on_parts(whole, c, bends[0]);
    find_roots(whole);
    return contact_on(whole, {});
  }

  /// Splits at the inflection, where Y'' = 0: Y' is exactly monotone on both sides (MATH 3.1). The weights (s, t) are
  /// (-c1, c0) sg(c0), both positive.
  bool contact_on_parts(const Piece<Number>& whole, const std::array<Number, 2>& c, DefiniteSign bend) {
    std::array<Number, 2> weights{arithmetic_.negated(c[1]), c[0]};
    if (bend == DefiniteSign::negative) weights = {c[1], arithmetic_.negated(c[0])};
    arithmetic_.rescale(weights);
    const auto& [s, t] = weights;
    const auto parts = arithmetic_.template evaluate<generated::split_cubic>(whole.k.data(), whole.q.data(), s, t);
    Piece<Number> before{values(parts.k_before), values(parts.q_before), {}, {}};
    Piece<Number> after{values(parts.k_after), values(parts.q_after), {}, {}};
    for (Piece<Number>* piece : {&before, &after}) {
      arithmetic_.rescale(piece->k);
      arithmetic_.rescale(piece->q);
      find_roots(*piece);
    }
    return contact_on(before, {Part<Number>::Place::before, s, t}) ||
           contact_on(after, {Part<Number>::Place::after, s, t});
  }

  /// Course and roots of a piece whose slope is monotone.
  void find_roots(Piece<Number>& piece) {
    const DefiniteSign k0 = arithmetic_.sign(piece.k[0]), k3 = arithmetic_.sign(piece.k[3]);
    piece.course = course_of_monotone_slope(arithmetic_.sign(piece.q[0]), arithmetic_.sign(piece.q[2]));
    const DefiniteSign inside = piece.course == Course::valley ? DefiniteSign::negative : DefiniteSign::positive;
    const DefiniteSign extremum = extremum_is_open(piece.course, k0, k3) ? sign_at_extremum_of(piece) : inside;
    piece.exists = existing_roots(piece.course, k0, k3, extremum);
  }

  DefiniteSign sign_at_extremum_of(const Piece<Number>& piece) {
    const auto lemma = arithmetic_.template evaluate<generated::extremum>(piece.k.data());
    const DefiniteSign delta = arithmetic_.sign(value(lemma.delta));
    auto rest = values(lemma.rest);
    const auto ends = signs_of(rest);
    DefiniteSign g = DefiniteSign::zero;
    if (ends[0] != ends[1]) {
      arithmetic_.rescale(rest);
      g = sign_at_root_of(piece.q, rest);
    }
    return sign_at_extremum(piece.course, delta, ends[0], ends[1], g);
  }

  /// Table B at the piece's roots, for the linear function with coefficients l on the piece.
  Branches<DefiniteSign> linear_signs(const Piece<Number>& piece, std::array<Number, 2> l) {
    const DefiniteSign a = arithmetic_.sign(l[0]), b = arithmetic_.sign(l[1]);
    if (a == b) return {a, a};
    arithmetic_.rescale(l);
    const auto cubic = arithmetic_.template evaluate<generated::cubic_at_root>(piece.k.data(), l.data());
    const DefiniteSign y = arithmetic_.sign(value(cubic.y)) * fall(a, b);
    DefiniteSign g = DefiniteSign::zero;
    if (piece.course == Course::valley || piece.course == Course::hill) {
      g = sign_at_root_of(piece.q, l);
    }
    return linear_at_roots(piece.course, a, b, y, g);
  }

  /// The signs at the piece's roots of the quadratic with coefficients j on the piece: table C.
  Branches<DefiniteSign> quadratic_signs(const Piece<Number>& piece, Quadratic<Number> j) {
    if (const auto hull = arithmetic_.hull_sign(j); hull != DefiniteSign::zero) return {hull, hull};
    arithmetic_.rescale(j);
    const auto division = arithmetic_.division(piece.k, j);
    const Branches<DefiniteSign> ms = linear_signs(piece, division.m), ns = linear_signs(piece, division.n);
    const auto at_root = [&](DefiniteSign on_m, DefiniteSign on_n) {
      return quadratic_at_root(on_m, on_n).value_or(DefiniteSign::zero);
    };
    return {piece.exists.first ? at_root(ms.first, ns.first) : DefiniteSign::zero,
            piece.exists.second ? at_root(ms.second, ns.second) : DefiniteSign::zero};
  }

  /// The sign of a quadratic with coefficients q at the root of a linear function l.
  DefiniteSign sign_at_root_of(const Quadratic<Number>& q, const std::array<Number, 2>& l) {
    return arithmetic_.sign(value(arithmetic_.template evaluate<generated::slope_at_root>(q.data(), l.data()).g));
  }

  /// A quadratic's coefficients on the part.
  Quadratic<Number> localized(const Quadratic<Number>& j, const Part<Number>& part) {
    if (part.place == Part<Number>::Place::whole) return j;
    Quadratic<Number> scaled = j;
    arithmetic_.rescale(scaled);
    const auto parts = arithmetic_.template evaluate<generated::split_quadratic>(scaled.data(), part.s, part.t);
    return part.place == Part<Number>::Place::before ? values(parts.before) : values(parts.after);
  }

  /// Is there contact at a root of the piece? Where the points are coplanar the quadratics of one axis are multiples of
  /// those of another, so the first axis in which not all of them are zero decides.
  bool contact_on(const Piece<Number>& piece, const Part<Number>& part) {
    Branches<bool> open = piece.exists;
    for (const std::size_t axis : axes_) {
      std::array<DefiniteSign, Functions> first{}, second{};
      for (std::size_t f = 0; f < Functions && (open.first || open.second) && !arithmetic_.gave_up(); ++f) {
        const auto at_roots = quadratic_signs(piece, localized(z_[axis][f], part));
        first[f] = at_roots.first;
        second[f] = at_roots.second;
        open.first = open.first && verdict(first) != Verdict::no_contact;
        open.second = open.second && verdict(second) != Verdict::no_contact;
      }
      if ((open.first && verdict(first) == Verdict::contact) || (open.second && verdict(second) == Verdict::contact)) {
        return true;
      }
      if (!open.first && !open.second) return false;
    }
    return true;
  }

  Arithmetic& arithmetic_;
  const Quadratics<Number, Functions>& z_;
  std::array<std::size_t, 3> axes_;
};

}  // namespace tightrope::ccd::exact
