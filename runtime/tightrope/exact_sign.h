#pragma once
/// What predicates in modes `exact` and `staged` are made of: the four-valued sign, inputs scaled to integers, and one
/// set of operations on the two kinds of exact numbers, integers of fixed width (integer.h) and Dyadic (dyadic.h). Host
/// only.

#include <tightrope/exact.h>
#include <tightrope/integer.h>
#include <tightrope/sign.h>

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>

#if defined(__GNUC__)
#define TIGHTROPE_OUT_OF_LINE __attribute__((noinline))
#else
#define TIGHTROPE_OUT_OF_LINE
#endif

TIGHTROPE_PRECISE_BEGIN
namespace tightrope {

/// The sign of an exact quantity. `invalid`: there is none, because an input is infinite or NaN, a divisor is zero or a
/// radicand negative. It converts neither to the three-valued Sign nor to a number without a cast.
enum class ExactSign : signed char { negative = -1, zero = 0, positive = 1, invalid = 2 };

/// The sign of the negative of the quantity.
constexpr ExactSign operator-(ExactSign s) {
  return s == ExactSign::invalid ? s : static_cast<ExactSign>(-static_cast<signed char>(s));
}

/// A filter's sign as a sign that is final unless it is zero.
TIGHTROPE_FUNCTION ExactSign filtered(Sign s) { return static_cast<ExactSign>(s); }
template <class Real>
TIGHTROPE_FUNCTION ExactSign filtered(const Bounded<Real>& x) {
  return filtered(sign(x));
}

namespace exact_arithmetic {

inline int sign_of(const Dyadic& a) { return a.sign(); }
template <class R>
R converted(const Dyadic& a) {
  return a;
}
template <class R>
R sum(const Dyadic& a, const Dyadic& b) {
  return a + b;
}
template <class R>
R difference(const Dyadic& a, const Dyadic& b) {
  return a - b;
}
template <class R>
R negated(const Dyadic& a) {
  return -a;
}
template <class R>
R product(const Dyadic& a, const Dyadic& b) {
  return a * b;
}
template <class R>
R multiple(const Dyadic& a, std::int64_t factor) {
  return a * Dyadic(factor);
}
template <class R>
R shifted(const Dyadic& a, int bits) {
  return mul_pow2(a, bits);
}
template <class R>
R negated_if(const Dyadic& a, bool condition) {
  return condition ? -a : a;
}

/// The integer 0 or +-1 as a number.
template <class R>
TIGHTROPE_FUNCTION R unit(int value) {
  if constexpr (std::is_same_v<R, Dyadic>) {
    return Dyadic(value);
  } else {
    return converted<R>(Integer<1>{{static_cast<std::uint64_t>(static_cast<std::int64_t>(value))}});
  }
}

template <class R, class A>
TIGHTROPE_FUNCTION R magnitude(const A& a) {
  return negated_if<R>(a, sign_of(a) < 0);
}

/// a * sign(b)
template <class R, class A, class B>
TIGHTROPE_FUNCTION R signed_by(const A& a, const B& b) {
  const int s = sign_of(b);
  return s == 0 ? unit<R>(0) : negated_if<R>(a, s < 0);
}

/// a if condition < 0, else b.
template <class R, class C, class A, class B>
TIGHTROPE_FUNCTION R selected(const C& condition, const A& a, const B& b) {
  return sign_of(condition) < 0 ? converted<R>(a) : converted<R>(b);
}

/// The sign of a + b sqrt(c), as a number: test = a^2 - b^2 c; b must be zero if c is. Where a and the root's term have
/// opposite signs, the one with the larger square wins.
template <class R, class A, class B, class C>
TIGHTROPE_FUNCTION R root_sign(const A& a, const B& b, const C& test) {
  const int sa = sign_of(a), sb = sign_of(b);
  return unit<R>(sa == 0 || sa == sb ? sb : sb == 0 ? sa : sa * sign_of(test));
}

template <class A>
TIGHTROPE_FUNCTION ExactSign exact_sign(const A& a) {
  return static_cast<ExactSign>(sign_of(a));
}

/// `x` exactly; if it is not finite, 0 and bit `slot` of `broken`.
template <std::floating_point Real>
Dyadic dyadic_of(Real x, std::uint64_t* broken, int slot) {
  if (x - x == 0) return Dyadic(static_cast<double>(x));
  broken[slot / 64] |= std::uint64_t{1} << (slot % 64);
  return {};
}
inline const Dyadic& dyadic_of(const Dyadic& x, const std::uint64_t*, int) { return x; }

/// high * 2^64 + low
inline Dyadic whole(std::uint64_t high, std::uint64_t low) { return mul_pow2(Dyadic(high), 64) + Dyadic(low); }

/// Whether a and b have a bit in common.
template <std::size_t N>
bool intersect(const std::uint64_t (&a)[N], const std::uint64_t (&b)[N]) {
  std::uint64_t common = 0;
  for (std::size_t i = 0; i < N; ++i) common |= a[i] & b[i];
  return common != 0;
}

/// All inputs as integers X[i] with x[i] = X[i] 2^e for one e <= 0 or any; 2^-e = 2^unit.
///
/// Returns whether they are: every x[i] finite and, with e such that the largest is just below 2^(L + e), a multiple of
/// 2^e. Only then X and unit mean anything.
///
/// L <= 62: x 2^-e is exact, unless it underflows, and below 2^62; truncation to an integer is exact if that is one; so
/// the integer times 2^e (exact: 2^e is a normal number) equals x if and only if x is a multiple of 2^e. Where 2^-e is
/// beyond the format, the largest power of two whose inverse is a normal number serves.
template <int L, class Real, std::size_t N>
TIGHTROPE_FUNCTION bool scale_inputs(const Real (&x)[N], Integer<1> (&X)[N], int& unit) {
  static_assert(L >= 53 && L <= 62);
  std::uint64_t largest = 0;
  for (std::size_t i = 0; i < N; ++i) {
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(static_cast<double>(x[i])) << 1;  // without the sign
    largest = bits > largest ? bits : largest;
  }
  const int biased = static_cast<int>(largest >> 53);
  if (biased == 0x7ff) return false;
  const int exponent = L - 1 - (biased - 1023);  // of 2^-e: >= 52 - 1023
  unit = exponent < 1022 ? exponent : 1022;
  const double scale = std::bit_cast<double>(static_cast<std::uint64_t>(unit + 1023) << 52);
  const double inverse = std::bit_cast<double>(static_cast<std::uint64_t>(1023 - unit) << 52);
  std::uint64_t lost = 0;
  for (std::size_t i = 0; i < N; ++i) {
    const auto value = static_cast<double>(x[i]);
    const auto whole = static_cast<std::int64_t>(value * scale);
    lost |= std::bit_cast<std::uint64_t>(static_cast<double>(whole) * inverse - value);  // equals differ by +0
    X[i].word[0] = static_cast<std::uint64_t>(whole);
  }
  return lost == 0;
}

/// The same for 64 <= L <= 126, by shifting significands.
template <int L, class Real, std::size_t N>
inline bool scale_inputs(const Real (&x)[N], Integer<2> (&X)[N], int& unit) {
  static_assert(L >= 64 && L <= 126);
  std::uint64_t largest = 0;
  for (std::size_t i = 0; i < N; ++i) {
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(static_cast<double>(x[i])) << 1;
    largest = bits > largest ? bits : largest;
  }
  const int top = static_cast<int>(largest >> 53);
  if (top == 0x7ff) return false;
  unit = L - 1 - (top - 1023);
  for (std::size_t i = 0; i < N; ++i) {
    const auto bits = std::bit_cast<std::uint64_t>(static_cast<double>(x[i]));
    const int biased = static_cast<int>(bits >> 52 & 0x7ff);
    std::uint64_t significand = bits & ((std::uint64_t{1} << 52) - 1);
    if (biased != 0) significand |= std::uint64_t{1} << 52;
    // |x| = significand 2^(max(biased, 1) - 1075), e = -unit: X = significand 2^shift.
    const int shift = (biased == 0 ? 1 : biased) - 1075 + unit;
    UnsignedWide magnitude = 0;
    if (shift >= 0) {
      magnitude = static_cast<UnsignedWide>(significand) << shift;
    } else if (significand != 0) {
      if (shift < -52 || (significand & ((std::uint64_t{1} << -shift) - 1)) != 0) return false;
      magnitude = significand >> -shift;
    }
    const UnsignedWide value = bits >> 63 != 0 ? 0 - magnitude : magnitude;
    X[i].word[0] = static_cast<std::uint64_t>(value);
    X[i].word[1] = static_cast<std::uint64_t>(value >> 64);
  }
  return true;
}

}  // namespace exact_arithmetic

/// The operations of generated exact code, each to a number<D, G> of `Numbers`.
template <class Numbers>
struct ExactOperations {
  template <int D, int G, class... Operands>
  TIGHTROPE_FUNCTION static auto unit(const Operands&... operands) {
    return exact_arithmetic::unit<typename Numbers::template number<D, G>>(operands...);
  }
  template <int D, int G, class... Operands>
  TIGHTROPE_FUNCTION static auto sum(const Operands&... operands) {
    return exact_arithmetic::sum<typename Numbers::template number<D, G>>(operands...);
  }
  template <int D, int G, class... Operands>
  TIGHTROPE_FUNCTION static auto difference(const Operands&... operands) {
    return exact_arithmetic::difference<typename Numbers::template number<D, G>>(operands...);
  }
  template <int D, int G, class... Operands>
  TIGHTROPE_FUNCTION static auto negated(const Operands&... operands) {
    return exact_arithmetic::negated<typename Numbers::template number<D, G>>(operands...);
  }
  template <int D, int G, class... Operands>
  TIGHTROPE_FUNCTION static auto product(const Operands&... operands) {
    return exact_arithmetic::product<typename Numbers::template number<D, G>>(operands...);
  }
  template <int D, int G, class... Operands>
  TIGHTROPE_FUNCTION static auto multiple(const Operands&... operands) {
    return exact_arithmetic::multiple<typename Numbers::template number<D, G>>(operands...);
  }
  template <int D, int G, class... Operands>
  TIGHTROPE_FUNCTION static auto shifted(const Operands&... operands) {
    return exact_arithmetic::shifted<typename Numbers::template number<D, G>>(operands...);
  }
  template <int D, int G, class... Operands>
  TIGHTROPE_FUNCTION static auto magnitude(const Operands&... operands) {
    return exact_arithmetic::magnitude<typename Numbers::template number<D, G>>(operands...);
  }
  template <int D, int G, class... Operands>
  TIGHTROPE_FUNCTION static auto signed_by(const Operands&... operands) {
    return exact_arithmetic::signed_by<typename Numbers::template number<D, G>>(operands...);
  }
  template <int D, int G, class... Operands>
  TIGHTROPE_FUNCTION static auto selected(const Operands&... operands) {
    return exact_arithmetic::selected<typename Numbers::template number<D, G>>(operands...);
  }
  template <int D, int G, class... Operands>
  TIGHTROPE_FUNCTION static auto root_sign(const Operands&... operands) {
    return exact_arithmetic::root_sign<typename Numbers::template number<D, G>>(operands...);
  }
};

/// The numbers of exact code for inputs that are integers below 2^L in magnitude: number<D, G> holds what is below
/// 2^(D L + G), a polynomial of degree D.
template <int L>
struct FixedNumbers : ExactOperations<FixedNumbers<L>> {
  using input = Integer<L / 64 + 1>;
  template <int D, int G>
  using number = Integer<(D * L + G) / 64 + 1>;
};

/// The same without limits.
struct DyadicNumbers : ExactOperations<DyadicNumbers> {
  using input = Dyadic;
  template <int D, int G>
  using number = Dyadic;
};

}  // namespace tightrope
TIGHTROPE_PRECISE_END
