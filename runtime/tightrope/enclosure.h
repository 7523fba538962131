#pragma once
/// Real numbers that need not be rational, for judging floating-point code: each is known exactly or lies between two
/// dyadic numbers that agree in more than 200 bits. Host only, standard library only.

#include <tightrope/exact.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace tightrope {

/// A real number x with lower() <= x <= upper(), exact where no root has been taken; or no number at all: x / 0, or the
/// root of a negative number; or one of which it is not known whether it is a number (a divisor that may be 0).
///
/// Every operation contains the exact result for all numbers in its operands. Ends that are no doubles of a few hundred
/// bits are rounded outwards, so enclosures stay small; exact numbers stay exact.
class Enclosure {
 public:
  Enclosure() = default;  ///< zero
  explicit Enclosure(double value) : Enclosure(DyadicRatio(value)) {}
  /// Exact numbers are enclosures: implicit. Of one with very many bits (nested quotients) only the first are kept.
  Enclosure(DyadicRatio value) : lower_(std::move(value)) {
    if (bits(lower_.numerator()) + bits(lower_.denominator()) > most_bits) *this = rounded(lower_, lower_);
  }

  static Enclosure undefined() { return Enclosure(State::undefined); }
  static Enclosure unknown() { return Enclosure(State::unknown); }

  bool is_number() const { return state_ == State::number; }
  bool is_undefined() const { return state_ == State::undefined; }
  bool is_exact() const { return is_number() && exact_; }
  const DyadicRatio& lower() const { return lower_; }
  const DyadicRatio& upper() const { return exact_ ? lower_ : upper_; }
  /// The sign if it is known, else 0 (also of an exact 0).
  int sign() const { return lower_.sign() > 0 ? 1 : upper().sign() < 0 ? -1 : 0; }
  double to_double() const { return lower_.to_double(); }

  Enclosure operator-() const {
    if (!is_number()) return *this;
    return exact_ ? Enclosure(-lower_) : Enclosure(-upper_, -lower_);
  }
  friend Enclosure operator+(const Enclosure& a, const Enclosure& b) {
    if (!both(a, b)) return neither(a, b);
    if (a.exact_ && b.exact_) return a.lower_ + b.lower_;
    return {a.lower_ + b.lower_, a.upper() + b.upper()};
  }
  friend Enclosure operator-(const Enclosure& a, const Enclosure& b) { return a + -b; }
  friend Enclosure operator*(const Enclosure& a, const Enclosure& b);
  friend Enclosure operator/(const Enclosure& a, const Enclosure& b);

  friend Enclosure abs(const Enclosure& a) {
    if (!a.is_number() || a.lower_.sign() >= 0) return a;
    if (a.upper().sign() <= 0) return -a;
    return {DyadicRatio(), tightrope::max(-a.lower_, a.upper())};
  }
  friend Enclosure min(const Enclosure& a, const Enclosure& b) {
    if (!both(a, b)) return neither(a, b);
    if (a.exact_ && b.exact_) return tightrope::min(a.lower_, b.lower_);
    return {tightrope::min(a.lower_, b.lower_), tightrope::min(a.upper(), b.upper())};
  }
  friend Enclosure max(const Enclosure& a, const Enclosure& b) { return -min(-a, -b); }
  friend Enclosure mul_pow2(const Enclosure& a, std::int64_t exponent) {
    if (!a.is_number()) return a;
    if (a.exact_) return mul_pow2(a.lower_, exponent);
    return {mul_pow2(a.lower_, exponent), mul_pow2(a.upper_, exponent)};
  }
  friend Enclosure fma(const Enclosure& a, const Enclosure& b, const Enclosure& c) { return a * b + c; }
  friend Enclosure sqrt(const Enclosure& a);

 private:
  enum class State : unsigned char { number, undefined, unknown };

  explicit Enclosure(State state) : state_(state) {}
  Enclosure(const DyadicRatio& lower, const DyadicRatio& upper) {
    if (lower == upper) {
      lower_ = lower;
    } else {
      *this = rounded(lower, upper);
    }
  }
  static Enclosure rounded(const DyadicRatio& lower, const DyadicRatio& upper) {
    Enclosure e;
    e.lower_ = rounded_down(lower);
    e.upper_ = -rounded_down(-upper);
    e.exact_ = false;
    return e;
  }
  static bool both(const Enclosure& a, const Enclosure& b) { return a.is_number() && b.is_number(); }
  static Enclosure neither(const Enclosure& a, const Enclosure& b) {
    return a.is_undefined() || b.is_undefined() ? undefined() : unknown();
  }
  static std::int64_t bits(const Dyadic& x) { return x.sign() == 0 ? 0 : x.high_exponent() - x.low_exponent(); }
  static DyadicRatio rounded_down(const DyadicRatio& x);
  static DyadicRatio root(const DyadicRatio& x, bool up);

  static constexpr std::int64_t most_bits = 20000;

  State state_ = State::number;
  bool exact_ = true;
  DyadicRatio lower_;
  DyadicRatio upper_;  ///< unless exact
};

inline Enclosure operator*(const Enclosure& a, const Enclosure& b) {
  if (!Enclosure::both(a, b)) return Enclosure::neither(a, b);
  if (a.is_exact() && b.is_exact()) return a.lower_ * b.lower_;
  const DyadicRatio ends[] = {a.lower_ * b.lower_, a.lower_ * b.upper(), a.upper() * b.lower_, a.upper() * b.upper()};
  const auto [least, most] = std::minmax_element(std::begin(ends), std::end(ends));
  return {*least, *most};
}

inline Enclosure operator/(const Enclosure& a, const Enclosure& b) {
  if (!Enclosure::both(a, b)) return Enclosure::neither(a, b);
  if (b.is_exact() && b.lower_.sign() == 0) return Enclosure::undefined();
  if (b.sign() == 0) return Enclosure::unknown();
  if (a.is_exact() && b.is_exact()) return a.lower_ / b.lower_;
  const DyadicRatio ends[] = {a.lower_ / b.lower_, a.lower_ / b.upper(), a.upper() / b.lower_, a.upper() / b.upper()};
  const auto [least, most] = std::minmax_element(std::begin(ends), std::end(ends));
  return {*least, *most};
}

/// A dyadic number below `x` by at most 2^-250 |x|, or x itself if it has so few bits: x 2^-e = d1 + d2 + ... + rest,
/// each d the rest's floor to 53 bits or more.
inline DyadicRatio Enclosure::rounded_down(const DyadicRatio& x) {
  constexpr int steps = 6;
  if (x.sign() == 0) return x;
  const std::int64_t e = x.numerator().high_exponent() - x.denominator().high_exponent();
  DyadicRatio rest = mul_pow2(x, -e);
  Dyadic sum;
  for (int i = 0; i < steps; ++i) {
    // Within 2 ulp of the quotient (or it underflows); the last one is moved below it.
    const double d = rest.to_double();
    const double term = i + 1 < steps ? d : d - std::abs(d) * 0x1p-50 - 0x1p-1000;
    sum += Dyadic(term);
    rest -= DyadicRatio(Dyadic(term));
    if (rest.sign() == 0) break;
  }
  if (rest.sign() < 0) detail::exact_precondition_violated("an enclosure's end is rounded outwards");
  return mul_pow2(DyadicRatio(sum), e);
}

/// An end of an enclosure of sqrt(x), x >= 0: Newton's steps with the slope in double gain 50 bits each. Whether the
/// end lies on the right side is then tested exactly, and a root that is a dyadic number is found exactly.
inline DyadicRatio Enclosure::root(const DyadicRatio& x, bool up) {
  if (x.sign() == 0) return x;
  const std::int64_t e = (x.numerator().high_exponent() - x.denominator().high_exponent()) / 2;
  const DyadicRatio y = mul_pow2(x, -2 * e);
  Dyadic s(std::sqrt(y.to_double()));
  const double slope = 2 * s.to_double();
  DyadicRatio rest = y - s * s;
  for (int i = 0; i < 5 && rest.sign() != 0; ++i) {
    s += Dyadic(rest.to_double() / slope);
    rest = y - s * s;
  }
  if (rest.sign() != 0) {
    // > |rest| / (s + sqrt(y)), the two being at least 1/2 each
    const double error = 2 * std::abs(rest.to_double()) + 0x1p-1000;
    s += Dyadic(up ? error : -error);
    rest = y - s * s;
    if (s.sign() <= 0 || (up ? rest.sign() > 0 : rest.sign() < 0)) {
      detail::exact_precondition_violated("an enclosure of a root contains it");
    }
  }
  return mul_pow2(DyadicRatio(s), e);
}

inline Enclosure sqrt(const Enclosure& a) {
  if (!a.is_number()) return a;
  if (a.upper().sign() < 0) return Enclosure::undefined();
  if (a.lower_.sign() < 0) return Enclosure::unknown();
  return {Enclosure::root(a.lower_, false), Enclosure::root(a.upper(), true)};
}

}  // namespace tightrope
