#pragma once
/// Compile-time numbers: exact rationals. Literals, loop counters and binomial coefficients are these, until one of
/// them has to become a floating-point constant of the graph.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tightrope::dsl {

__extension__ typedef __int128 Int128;

/// num / den * 2^exponent with num and den odd and coprime, den > 0 (zero: num = 0, den = 1, exponent = 0).
///
/// Arithmetic is exact or, where num or den would need more than 126 bits (or on division by zero), gives a number that
/// is not `valid()`; that state sticks, so a computation needs only one check at its end.
class Rational {
 public:
  Rational() = default;  ///< zero
  // Implicit on purpose: whole numbers are rationals.
  Rational(std::int64_t whole) : Rational(reduced(whole, 1, 0)) {}  // NOLINT(google-explicit-constructor)
  static Rational quotient(Int128 numerator, Int128 denominator) { return reduced(numerator, denominator, 0); }
  static Rational power_of_two(std::int64_t exponent) { return reduced(1, 1, exponent); }
  static Rational invalid();
  /// The value of a decimal literal, "12", "0.1", "2.5e-3", exactly; empty if it is not one.
  static std::optional<Rational> parse(std::string_view literal);

  bool valid() const { return denominator_ != 0; }
  bool is_zero() const { return valid() && numerator_ == 0; }
  bool is_one() const { return numerator_ == 1 && denominator_ == 1 && exponent_ == 0; }
  bool is_power_of_two() const { return numerator_ == 1 && denominator_ == 1; }  ///< 2^e, positive
  int sign() const { return numerator_ > 0 ? 1 : numerator_ < 0 ? -1 : 0; }

  Int128 odd_numerator() const { return numerator_; }      ///< signed
  Int128 odd_denominator() const { return denominator_; }  ///< positive
  std::int32_t exponent() const { return exponent_; }

  std::optional<std::int64_t> to_integer() const;  ///< if it is a whole number of that type
  std::optional<double> to_double() const;         ///< if it is a double (0 included), exactly
  double round_down() const;                       ///< the largest double <= a non-negative *this
  std::optional<Rational> square_root() const;     ///< if it is a square
  Rational power(std::int64_t n) const;            ///< *this^n; 0^0 = 1, 0^negative is invalid
  std::string to_string() const;                   ///< "3", "-1/10", "3*2^200", "1/(5*2^90)"

  Rational operator-() const;
  friend Rational operator+(const Rational& a, const Rational& b);
  friend Rational operator-(const Rational& a, const Rational& b) { return a + -b; }
  friend Rational operator*(const Rational& a, const Rational& b);
  friend Rational operator/(const Rational& a, const Rational& b) { return a * b.reciprocal(); }
  /// Equality of value; two invalid numbers are equal.
  friend bool operator==(const Rational& a, const Rational& b) = default;

 private:
  static Rational reduced(Int128 numerator, Int128 denominator, std::int64_t exponent);
  Rational reciprocal() const;

  Int128 numerator_ = 0;
  Int128 denominator_ = 1;  // 0: invalid
  std::int32_t exponent_ = 0;
};

Rational abs(const Rational& a);
/// The largest rational of which both (valid, not zero) are whole multiples; invalid on overflow.
Rational common_divisor(const Rational& a, const Rational& b);
/// n over k; invalid where it overflows.
Rational binomial(int n, int k);
/// Odd p > 0 as a product of doubles, as few as prime factors below 1000 allow; empty if they do not suffice.
std::vector<double> double_factors(Int128 p);

}  // namespace tightrope::dsl
