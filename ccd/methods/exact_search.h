#pragma once
/// Bernstein sign classification with every sign exact: one template, decided in exact arithmetic or, as a filter, in
/// floating point with bounds, which gives up where a bound does not tell (MATH 2.7). The answer is then contact or no
/// contact, in every degenerate case.
///
/// `Arithmetic` has
///   Number                       of which `sign` is the DefiniteSign
///   evaluate<Predicate>(args..)  the outputs of a generated predicate
///   gave_up()                    a sign was not known: all answers since then mean nothing
///   knows_zero                   whether a sign may be zero; if not, the degenerate cases are left out
///   rescale(tuple), axes(z)      exact scaling for range; the order in which coordinates are looked at
///
/// Who includes this includes the generated headers first.

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>

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
template <class Bound, class Real>
struct parabola;
template <class Bound, class Real>
struct quadratic_bend;
template <class Bound, class Real>
struct elevated_quadratic;
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

template <class Arithmetic, std::size_t Functions, class Separators>
class Search {
 public:
  using Number = typename Arithmetic::Number;

  /// z: the projected quadratics of theorem 1.4. `separators`: a function that gives linear functions, as quadratics
  /// [axis][pair of points], all positive or all negative in an axis where that axis separates the points (1.4 c).
  Search(Arithmetic& arithmetic, const Quadratics<Number, Functions>& z, const Separators& separators)
      : arithmetic_(arithmetic), z_(z), separators_(separators), axes_(arithmetic.axes(z)) {}

  /// Is there contact at some t in [0, 1]? k: coefficients of the cubic Y, zero where the points are coplanar.
  bool contact(const std::array<Number, 4>& k) {
    if (const auto signs = signs_of(k); signs != std::array<DefiniteSign, 4>{}) return contact_at_roots(k, signs);
    if constexpr (Arithmetic::knows_zero) return contact_in_a_plane();
    return true;
  }

 private:
  template <std::size_t N>
  std::array<DefiniteSign, N> signs_of(const std::array<Number, N>& numbers) {
    std::array<DefiniteSign, N> signs;
    for (std::size_t i = 0; i < N; ++i) signs[i] = arithmetic_.sign(numbers[i]);
    return signs;
  }

  /// Y = 0 all the time. The set of times of contact is closed; its first one is 0 or a time at which a sign changes
  /// that theorem 1.4 asks for: a root of one of the quadratics or, if these are all zero all the time, of one of the
  /// separators (else the times at which all are zero are among the roots).
  bool contact_in_a_plane() {
    if (contact_at_end(0)) return true;
    bool on_a_line = true;
    for (const auto& axis : z_) {
      for (const auto& j : axis) {
        const auto k = values(arithmetic_.template evaluate<generated::elevated_quadratic>(j.data()).k);
        const auto signs = signs_of(k);
        if (signs == std::array<DefiniteSign, 4>{}) continue;
        on_a_line = false;
        if (contact_at_roots(k, signs)) return true;
      }
    }
    if (!on_a_line) return false;
    for (const auto& axis : separators_()) {
      for (const auto& j : axis) {
        const auto k = values(arithmetic_.template evaluate<generated::elevated_quadratic>(j.data()).k);
        const auto signs = signs_of(k);
        if (signs != std::array<DefiniteSign, 4>{} && contact_at_roots(k, signs)) return true;
      }
    }
    return false;
  }

  /// Is there contact at a root in [0, 1] of the cubic with coefficients k, not all zero, at whose roots the four
  /// points are coplanar?
  bool contact_at_roots(const std::array<Number, 4>& k, const std::array<DefiniteSign, 4>& signs) {
    if (signs[0] == DefiniteSign::zero && contact_at_end(0)) return true;
    if (signs[3] == DefiniteSign::zero && contact_at_end(2)) return true;
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
    if (extremum == DefiniteSign::zero) piece.exists.second = false;  // one double root, on both branches
  }

  DefiniteSign sign_at_extremum_of(const Piece<Number>& piece) {
    const auto lemma = arithmetic_.template evaluate<generated::extremum>(piece.k.data());
    const DefiniteSign delta = arithmetic_.sign(value(lemma.delta));
    if constexpr (Arithmetic::knows_zero) {
      if (delta == DefiniteSign::zero) {  // a parabola, open upwards if it is a valley
        const auto parabola = arithmetic_.template evaluate<generated::parabola>(piece.k.data());
        const DefiniteSign extreme = arithmetic_.sign(value(parabola.extreme));
        return piece.course == Course::valley ? extreme : -extreme;
      }
    }
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
    if constexpr (Arithmetic::knows_zero) {
      const auto signs = signs_of(j);
      if (signs[0] == signs[1] && signs[1] == signs[2]) return {signs[0], signs[0]};
      const auto shape = arithmetic_.template evaluate<generated::quadratic_bend>(j.data());
      if (arithmetic_.sign(value(shape.bend)) == DefiniteSign::zero) return linear_signs(piece, {j[0], j[2]});
    } else if (const auto hull = arithmetic_.hull_sign(j); hull != DefiniteSign::zero) {
      return {hull, hull};
    }
    arithmetic_.rescale(j);
    const auto division = arithmetic_.division(piece.k, j);
    const Branches<DefiniteSign> ms = linear_signs(piece, division.m), ns = linear_signs(piece, division.n);
    const auto at_root = [&](DefiniteSign on_m, DefiniteSign on_n) {
      const auto sign = quadratic_at_root(on_m, on_n);
      return sign ? *sign : sign_at_rational_root(piece, division.m, j);
    };
    return {piece.exists.first ? at_root(ms.first, ns.first) : DefiniteSign::zero,
            piece.exists.second ? at_root(ms.second, ns.second) : DefiniteSign::zero};
  }

  /// The sign of the quadratic at a root of the cubic that is the root of m, too. If m is identically zero the cubic is
  /// linear (its division by a true quadratic has no quotient), and its root is that of the line from k0 to k3.
  DefiniteSign sign_at_rational_root(const Piece<Number>& piece, const std::array<Number, 2>& m,
                                     const Quadratic<Number>& j) {
    const bool no_quotient = signs_of(m) == std::array<DefiniteSign, 2>{};
    return sign_at_root_of(j, no_quotient ? std::array<Number, 2>{piece.k[0], piece.k[3]} : m);
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
    if constexpr (Arithmetic::knows_zero) {  // all zero: the points are on one line
      return (open.first && !separated_at(piece, part, false)) || (open.second && !separated_at(piece, part, true));
    }
    return true;
  }

  /// Does an axis separate the points at a root of the piece (MATH 1.4 c)?
  bool separated_at(const Piece<Number>& piece, const Part<Number>& part, bool second) {
    for (const auto& axis : separators_()) {
      bool above = true, below = true;
      for (const auto& line : axis) {
        const auto at_roots = quadratic_signs(piece, localized(line, part));
        const DefiniteSign side = second ? at_roots.second : at_roots.first;
        above = above && side == DefiniteSign::positive;
        below = below && side == DefiniteSign::negative;
        if (!above && !below) break;
      }
      if (above || below) return true;
    }
    return false;
  }

  /// Is there contact at t = 0 (coefficient 0) or t = 1 (coefficient 2), where the points are coplanar?
  bool contact_at_end(std::size_t coefficient) {
    const auto signs_at_end = [&](const auto& functions) {
      std::array<DefiniteSign, std::tuple_size_v<std::remove_cvref_t<decltype(functions)>>> signs;
      for (std::size_t f = 0; f < signs.size(); ++f) signs[f] = arithmetic_.sign(functions[f][coefficient]);
      return signs;
    };
    for (const auto& axis : z_) {
      switch (verdict(signs_at_end(axis))) {
        case Verdict::contact:
          return true;
        case Verdict::no_contact:
          return false;
        case Verdict::open:
          break;
      }
    }
    for (const auto& axis : separators_()) {
      const auto signs = signs_at_end(axis);
      const bool equal = std::all_of(signs.begin(), signs.end(), [&](DefiniteSign s) { return s == signs[0]; });
      if (equal && signs[0] != DefiniteSign::zero) return false;
    }
    return true;
  }

  Arithmetic& arithmetic_;
  const Quadratics<Number, Functions>& z_;
  const Separators& separators_;
  std::array<std::size_t, 3> axes_;
};

}  // namespace tightrope::ccd::exact
