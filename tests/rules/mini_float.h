#pragma once
/// A binary floating-point format with so few numbers that all of them can be tried: subnormals, infinities, NaN, round
/// to nearest even, as IEEE 754 has them. For the exhaustive check of bound rules (rule_check.h).

#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "codegen/precision.h"

namespace tightrope::rules {

/// `ExponentBits` of exponent, `SignificandBits` of significand, the leading one included (double would be <11, 53>).
///
/// A number is a code as in IEEE 754: a sign bit, then the magnitude's code, whose order is that of the magnitudes.
/// Every finite number is a whole multiple of eta, the smallest subnormal, which makes exact arithmetic one on
/// integers.
template <int ExponentBits, int SignificandBits>
class MiniFloat {
  static_assert(ExponentBits >= 2 && ExponentBits <= 4 && SignificandBits >= 2 && SignificandBits <= 7);

 public:
  using Code = std::uint16_t;
  static constexpr int digits = SignificandBits;
  static constexpr int magnitude_bits = ExponentBits + SignificandBits - 1;
  static constexpr Code sign_bit = Code{1} << magnitude_bits;
  static constexpr Code infinite = ((1 << ExponentBits) - 1) << (SignificandBits - 1);  ///< its magnitude's code
  static constexpr Code not_a_number = infinite + 1;
  static constexpr int codes = 2 * sign_bit;
  static constexpr int max_exponent = (1 << (ExponentBits - 1)) - 1;
  static constexpr int min_exponent = 1 - max_exponent;
  static constexpr int eta_exponent = min_exponent - SignificandBits + 1;  ///< eta = 2^eta_exponent
  static constexpr std::int64_t units_of_one = std::int64_t{1} << -eta_exponent;

  MiniFloat() = default;
  /// `value` rounded to nearest even.
  explicit MiniFloat(double value) : code_(rounded(value)) {}
  static MiniFloat from_code(int code) {
    MiniFloat x;
    x.code_ = static_cast<Code>(code);
    return x;
  }
  static MiniFloat infinity() { return from_code(infinite); }
  static MiniFloat quiet_NaN() { return from_code(not_a_number); }
  static MiniFloat largest() { return from_code(infinite - 1); }

  int code() const { return code_; }
  bool negative() const { return (code_ & sign_bit) != 0; }
  int magnitude() const { return code_ & (sign_bit - 1); }
  bool is_nan() const { return magnitude() > infinite; }
  bool is_infinite() const { return magnitude() == infinite; }
  bool is_finite() const { return magnitude() < infinite; }

  /// The number as a multiple of eta; finite numbers only.
  std::int64_t units() const { return negative() ? -units_of(magnitude()) : units_of(magnitude()); }
  /// Exactly this number.
  double to_double() const { return doubles()[code_]; }

  friend MiniFloat operator-(MiniFloat x) { return from_code(x.code_ ^ sign_bit); }
  friend MiniFloat abs(MiniFloat x) { return from_code(x.magnitude()); }
  friend MiniFloat operator+(MiniFloat x, MiniFloat y) { return from_code(tables().sum[pair(x, y)]); }
  friend MiniFloat operator-(MiniFloat x, MiniFloat y) { return x + -y; }
  friend MiniFloat operator*(MiniFloat x, MiniFloat y) { return from_code(tables().product[pair(x, y)]); }
  friend MiniFloat operator/(MiniFloat x, MiniFloat y) { return from_code(tables().quotient[pair(x, y)]); }
  friend MiniFloat sqrt(MiniFloat x) { return root(x); }

  friend MiniFloat fma(MiniFloat x, MiniFloat y, MiniFloat z) {
    if (!x.is_finite() || !y.is_finite()) return x * y + z;
    if (!z.is_finite()) return z;
    const std::int64_t exact = x.units() * y.units() + z.units() * units_of_one;
    if (exact == 0) return MiniFloat::exact_zero(x.negative() != y.negative(), z.negative());
    return from_ratio(exact, units_of_one);
  }

  friend MiniFloat mul_pow2(MiniFloat x, int exponent) {
    if (!x.is_finite() || x.magnitude() == 0) return x;
    if (exponent > 2 * magnitude_bits + (1 << ExponentBits)) exponent = 2 * magnitude_bits + (1 << ExponentBits);
    if (exponent < -60) exponent = -60;
    const MiniFloat scaled = exponent >= 0 ? from_ratio(std::abs(x.units()) << exponent, 1)
                                           : from_ratio(std::abs(x.units()), std::int64_t{1} << -exponent);
    return x.negative() ? -scaled : scaled;
  }

  friend bool operator<(MiniFloat x, MiniFloat y) { return x.to_double() < y.to_double(); }
  friend bool operator>(MiniFloat x, MiniFloat y) { return y < x; }
  friend bool operator<=(MiniFloat x, MiniFloat y) { return x.to_double() <= y.to_double(); }
  friend bool operator>=(MiniFloat x, MiniFloat y) { return y <= x; }
  friend bool operator==(MiniFloat x, MiniFloat y) { return x.to_double() == y.to_double(); }

  /// What the bounds must know of this format; `slack` as FloatFormat says. Compile-time floors are always used.
  static codegen::FloatFormat format(double slack) {
    return {SignificandBits,
            min_exponent,
            max_exponent,
            std::ldexp(1.0, -SignificandBits),
            std::ldexp(1.0, eta_exponent),
            slack,
            largest().to_double(),
            largest().to_double()};
  }

  /// All numbers from 0 to the largest one.
  static std::vector<MiniFloat> magnitudes() {
    std::vector<MiniFloat> all;
    for (int code = 0; code < infinite; ++code) all.push_back(from_code(code));
    return all;
  }

  /// The non-zero exact number numerator / denominator * eta, denominator > 0, rounded to nearest even.
  ///
  /// With t the quotient in units of the last place of its binade, rounded, the magnitude's code is t plus the binade's
  /// number times 2^(SignificandBits - 1): a carry out of t goes into the exponent by itself, up to infinity.
  static MiniFloat from_ratio(std::int64_t numerator, std::int64_t denominator) {
    const bool negative = numerator < 0;
    const std::int64_t n = negative ? -numerator : numerator;
    int binade = 0;
    while ((n / denominator) >> binade >= std::int64_t{1} << SignificandBits) ++binade;
    if (binade >= 1 << ExponentBits) return negative ? -infinity() : infinity();
    const std::int64_t unit = denominator << binade;
    std::int64_t t = n / unit;
    const std::int64_t rest = n - t * unit;
    if (2 * rest > unit || (2 * rest == unit && t % 2 == 1)) ++t;
    const std::int64_t code = t + (static_cast<std::int64_t>(binade) << (SignificandBits - 1));
    const MiniFloat magnitude = from_code(static_cast<int>(code < infinite ? code : infinite));
    return negative ? -magnitude : magnitude;
  }

 private:
  struct Tables {
    std::vector<Code> sum, product, quotient;
  };

  static std::int64_t units_of(int magnitude) {
    const int field = magnitude >> (SignificandBits - 1);
    const std::int64_t rest = magnitude & ((1 << (SignificandBits - 1)) - 1);
    return field == 0 ? rest : (rest + (1 << (SignificandBits - 1))) << (field - 1);
  }
  static std::size_t pair(MiniFloat x, MiniFloat y) {
    return (static_cast<std::size_t>(x.code_) << (magnitude_bits + 1)) | y.code_;
  }
  static MiniFloat signed_zero(bool negative) { return from_code(negative ? sign_bit : 0); }
  /// A sum that is exactly 0 is +0, unless both of its summands are -0.
  static MiniFloat exact_zero(bool x_negative, bool y_negative) { return signed_zero(x_negative && y_negative); }

  static Code rounded(double value) {
    if (std::isnan(value)) return not_a_number;
    const Code sign = std::signbit(value) ? sign_bit : 0;
    const double magnitude = std::abs(value);
    if (magnitude == 0) return sign;
    if (magnitude >= std::ldexp(2.0, max_exponent)) return sign | infinite;
    if (magnitude < std::ldexp(1.0, eta_exponent - 2)) return sign;
    // 30 bits below eta hold everything that a constant can have in a format this small, all but exactly: what is
    // below them decides a tie at most, and constants are rounded by round_up() before.
    const double units = std::ldexp(magnitude, 30 - eta_exponent);
    assert(units < 0x1p62);
    return sign | from_ratio(static_cast<std::int64_t>(units), std::int64_t{1} << 30).code_;
  }

  static MiniFloat plain_sum(MiniFloat x, MiniFloat y) {
    if (x.is_nan() || y.is_nan()) return quiet_NaN();
    if (x.is_infinite()) return y.is_infinite() && x.negative() != y.negative() ? quiet_NaN() : x;
    if (y.is_infinite()) return y;
    const std::int64_t exact = x.units() + y.units();
    return exact == 0 ? exact_zero(x.negative(), y.negative()) : from_ratio(exact, 1);
  }

  static MiniFloat plain_product(MiniFloat x, MiniFloat y) {
    const bool negative = x.negative() != y.negative();
    if (x.is_nan() || y.is_nan()) return quiet_NaN();
    const bool zero = x.magnitude() == 0 || y.magnitude() == 0;
    if (x.is_infinite() || y.is_infinite()) return zero ? quiet_NaN() : negative ? -infinity() : infinity();
    return zero ? signed_zero(negative) : from_ratio(x.units() * y.units(), units_of_one);
  }

  static MiniFloat plain_quotient(MiniFloat x, MiniFloat y) {
    const bool negative = x.negative() != y.negative();
    if (x.is_nan() || y.is_nan()) return quiet_NaN();
    if (x.is_infinite()) return y.is_infinite() ? quiet_NaN() : negative ? -infinity() : infinity();
    if (y.is_infinite()) return signed_zero(negative);
    if (y.magnitude() == 0) return x.magnitude() == 0 ? quiet_NaN() : negative ? -infinity() : infinity();
    if (x.magnitude() == 0) return signed_zero(negative);
    const std::int64_t numerator = x.units() * units_of_one;
    return from_ratio(y.negative() ? -numerator : numerator, std::abs(y.units()));
  }

  /// sqrt(n eta) in units of eta is sqrt(n / eta): between the numbers m and m' it goes to the nearer one, found by
  /// comparing squares, where (m + m')/2 is never hit exactly unless that is a tie.
  static MiniFloat root(MiniFloat x) {
    if (x.is_nan() || x.magnitude() == 0) return x;
    if (x.negative()) return quiet_NaN();
    if (x.is_infinite()) return x;
    const std::int64_t square = x.units() * units_of_one;
    int low = 0;
    for (int step = 1 << magnitude_bits; step > 0; step /= 2) {
      if (low + step < infinite && units_of(low + step) * units_of(low + step) <= square) low += step;
    }
    const std::int64_t twice_middle = units_of(low) + units_of(low + 1);
    const bool up =
        twice_middle * twice_middle < 4 * square || (twice_middle * twice_middle == 4 * square && low % 2 == 1);
    return from_code(up ? low + 1 : low);
  }

  static const std::array<double, codes>& doubles() {
    static const std::array<double, codes> all = [] {
      std::array<double, codes> values{};
      for (int code = 0; code < codes; ++code) {
        const MiniFloat x = from_code(code);
        const double sign = x.negative() ? -1 : 1;
        values[static_cast<std::size_t>(code)] =
            x.is_nan()
                ? std::numeric_limits<double>::quiet_NaN()
                : sign * (x.is_infinite() ? std::numeric_limits<double>::infinity()
                                          : std::ldexp(static_cast<double>(units_of(x.magnitude())), eta_exponent));
      }
      return values;
    }();
    return all;
  }

  static const Tables& tables() {
    static const Tables all = [] {
      Tables t;
      for (int x = 0; x < codes; ++x) {
        for (int y = 0; y < codes; ++y) {
          t.sum.push_back(plain_sum(from_code(x), from_code(y)).code_);
          t.product.push_back(plain_product(from_code(x), from_code(y)).code_);
          t.quotient.push_back(plain_quotient(from_code(x), from_code(y)).code_);
        }
      }
      return t;
    }();
    return all;
  }

  Code code_ = 0;
};

}  // namespace tightrope::rules

/// dsl/evaluate.h asks this whether a number type has NaNs.
template <int E, int S>
struct std::numeric_limits<tightrope::rules::MiniFloat<E, S>> {
  static constexpr bool is_specialized = true;
  static constexpr bool has_quiet_NaN = true;
  static constexpr tightrope::rules::MiniFloat<E, S> quiet_NaN() {
    return tightrope::rules::MiniFloat<E, S>::quiet_NaN();
  }
};
