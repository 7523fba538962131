#pragma once
/// Exact arithmetic for judging floating-point code: Dyadic (dyadic.h) and quotients of such numbers.
/// Host only, standard library only. What generated tests compute their reference values with.

#include <tightrope/dyadic.h>

#include <compare>
#include <concepts>
#include <cstdint>
#include <string>
#include <utility>

namespace tightrope {

/// An exact quotient of dyadic numbers. Never reduced, except that powers of two leave the denominator: with few
/// divisions by constants, as in predicates, denominators stay small products.
class DyadicRatio {
 public:
  DyadicRatio() = default;  ///< zero
  /// Exactly `value`, which must be finite (aborts otherwise).
  explicit DyadicRatio(double value) : numerator_(value) {}
  explicit DyadicRatio(long double value) = delete;
  template <std::integral Integer>
  requires(sizeof(Integer) <= 8) explicit DyadicRatio(Integer value) : numerator_(value) {}
  DyadicRatio(Dyadic value) : numerator_(std::move(value)) {}  // every dyadic number is a ratio: implicit
  /// numerator / denominator; the denominator must not be zero (aborts otherwise).
  DyadicRatio(Dyadic numerator, Dyadic denominator);

  const Dyadic& numerator() const { return numerator_; }
  const Dyadic& denominator() const { return denominator_; }  ///< positive; 1 if it is a power of two
  int sign() const { return numerator_.sign(); }              ///< -1, 0, +1
  /// Within 2 units in the last place of the exact value (normal range); correctly rounded if the denominator is 1.
  double to_double() const;
  std::string to_string() const { return numerator_.to_string() + " / " + denominator_.to_string(); }

  DyadicRatio operator-() const { return raw(-numerator_, denominator_); }
  friend DyadicRatio operator+(const DyadicRatio& a, const DyadicRatio& b) {
    if (a.denominator_ == b.denominator_) return raw(a.numerator_ + b.numerator_, a.denominator_);
    return {a.numerator_ * b.denominator_ + b.numerator_ * a.denominator_, a.denominator_ * b.denominator_};
  }
  friend DyadicRatio operator-(const DyadicRatio& a, const DyadicRatio& b) {
    if (a.denominator_ == b.denominator_) return raw(a.numerator_ - b.numerator_, a.denominator_);
    return {a.numerator_ * b.denominator_ - b.numerator_ * a.denominator_, a.denominator_ * b.denominator_};
  }
  friend DyadicRatio operator*(const DyadicRatio& a, const DyadicRatio& b) {
    return raw(a.numerator_ * b.numerator_, a.denominator_ * b.denominator_);
  }
  /// The divisor must not be zero (aborts otherwise).
  friend DyadicRatio operator/(const DyadicRatio& a, const DyadicRatio& b) {
    return {a.numerator_ * b.denominator_, a.denominator_ * b.numerator_};
  }
  DyadicRatio& operator+=(const DyadicRatio& b) { return *this = *this + b; }
  DyadicRatio& operator-=(const DyadicRatio& b) { return *this = *this - b; }
  DyadicRatio& operator*=(const DyadicRatio& b) { return *this = *this * b; }
  DyadicRatio& operator/=(const DyadicRatio& b) { return *this = *this / b; }
  friend std::strong_ordering operator<=>(const DyadicRatio& a, const DyadicRatio& b) {
    if (a.sign() != b.sign()) return a.sign() <=> b.sign();
    if (a.denominator_ == b.denominator_) return a.numerator_ <=> b.numerator_;
    return a.numerator_ * b.denominator_ <=> b.numerator_ * a.denominator_;
  }
  friend bool operator==(const DyadicRatio& a, const DyadicRatio& b) { return (a <=> b) == 0; }
  friend DyadicRatio mul_pow2(const DyadicRatio& a, std::int64_t exponent) {  ///< a * 2^exponent
    return raw(mul_pow2(a.numerator_, exponent), a.denominator_);
  }

 private:
  /// No normalisation: the denominator is known to be positive, and 1 if it is a power of two.
  static DyadicRatio raw(Dyadic numerator, Dyadic denominator) {
    DyadicRatio r;
    r.numerator_ = std::move(numerator);
    r.denominator_ = std::move(denominator);
    return r;
  }

  Dyadic numerator_;
  Dyadic denominator_ = Dyadic(1);
};

inline DyadicRatio::DyadicRatio(Dyadic numerator, Dyadic denominator)
    : numerator_(std::move(numerator)), denominator_(std::move(denominator)) {
  if (denominator_.sign() == 0) detail::exact_precondition_violated("a denominator is not zero");
  if (denominator_.sign() < 0) {
    numerator_ = -numerator_;
    denominator_ = -denominator_;
  }
  const std::int64_t low = denominator_.low_exponent();
  if (denominator_.high_exponent() == low) {
    numerator_ = mul_pow2(numerator_, -low);
    denominator_ = Dyadic(1);
  }
}

inline double DyadicRatio::to_double() const {
  if (numerator_.sign() == 0 || denominator_ == Dyadic(1)) return numerator_.to_double();
  // Both scaled into [1, 2) round with at most u each, the quotient once more; the scaling back rounds below 2^-1022.
  const std::int64_t en = numerator_.high_exponent(), ed = denominator_.high_exponent();
  const double quotient = mul_pow2(numerator_, -en).to_double() / mul_pow2(denominator_, -ed).to_double();
  return mul_pow2(Dyadic(quotient), en - ed).to_double();
}

inline DyadicRatio abs(const DyadicRatio& a) { return a.sign() < 0 ? -a : a; }
inline DyadicRatio min(const DyadicRatio& a, const DyadicRatio& b) { return b < a ? b : a; }
inline DyadicRatio max(const DyadicRatio& a, const DyadicRatio& b) { return a < b ? b : a; }
/// a * b + c without any rounding.
inline DyadicRatio fma(const DyadicRatio& a, const DyadicRatio& b, const DyadicRatio& c) { return a * b + c; }
/// Exact square roots do not exist among ratios: never call this. It is declared so that code written for any number
/// type compiles; it ends the program.
[[noreturn]] inline DyadicRatio sqrt(const DyadicRatio&) {
  detail::exact_precondition_violated("square roots are not taken of exact ratios");
}

}  // namespace tightrope
