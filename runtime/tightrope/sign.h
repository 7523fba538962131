#pragma once
/// Three-valued signs and values with error bounds: the types that generated predicates take and return.

#include <tightrope/arithmetic.h>

TIGHTROPE_PRECISE_BEGIN
namespace tightrope {

/// The sign of an exact quantity as far as floating point can tell.
enum class Sign : signed char { negative = -1, uncertain = 0, positive = 1 };

TIGHTROPE_FUNCTION constexpr Sign operator-(Sign s) { return static_cast<Sign>(-static_cast<signed char>(s)); }

/// A computed value and a bound of its error: |value - exact| <= bound, wherever both are finite.
/// In mode `float` the bound is 0 and means nothing.
template <class Real>
struct Bounded {
  Real value;
  Real bound;
};

/// The sign of the exact quantity: definite only if |value| > bound (strictly: an exact 0 has no sign). A NaN or an
/// infinity in either number gives `uncertain`: the comparisons are false, and generated code turns the bound of a
/// non-finite value into a NaN or an infinity.
template <class Real>
TIGHTROPE_FUNCTION constexpr Sign sign(const Bounded<Real>& x) {
  require_ieee_device<Real>();
  return x.value > x.bound ? Sign::positive : x.value < -x.bound ? Sign::negative : Sign::uncertain;
}

/// What generated code answers where the declared range of an input is broken: no value, no bound, no sign.
template <class Real>
TIGHTROPE_FUNCTION constexpr void make_uncertain(Bounded<Real>& x) {
  x = {static_cast<Real>(__builtin_nan("")), static_cast<Real>(__builtin_inf())};
}
template <class Element, decltype(sizeof(0)) N>
TIGHTROPE_FUNCTION constexpr void make_uncertain(Element (&array)[N]) {
  for (Element& element : array) make_uncertain(element);
}

/// Tags that select a generated predicate's bound mode.
namespace bound {
struct none {};      ///< mode `float`: no bound, the unsafe baseline
struct safe {};      ///< SafeBound [Wang 2014]
struct tight {};     ///< TightBound [Wang et al. 2015]
struct fixed {};     ///< mode `static`: a constant, from the declared ranges
struct interval {};  ///< interval arithmetic
struct exact {};     ///< exact arithmetic
struct staged {};    ///< the cheapest of these that settles the sign; always exact
}  // namespace bound

}  // namespace tightrope
TIGHTROPE_PRECISE_END
