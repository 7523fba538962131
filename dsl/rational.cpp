#include "dsl/rational.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <limits>

namespace tightrope::dsl {
namespace {

__extension__ typedef unsigned __int128 UInt128;

constexpr std::int64_t max_exponent = 1 << 20;  // of the power of two; far beyond any floating-point format

UInt128 magnitude(Int128 a) { return a < 0 ? UInt128{0} - static_cast<UInt128>(a) : static_cast<UInt128>(a); }

int trailing_zeros(UInt128 a) {
  const auto low = static_cast<std::uint64_t>(a);
  return low != 0 ? __builtin_ctzll(low) : 64 + __builtin_ctzll(static_cast<std::uint64_t>(a >> 64));
}

int bit_length(UInt128 a) {
  const auto high = static_cast<std::uint64_t>(a >> 64);
  const auto low = static_cast<std::uint64_t>(a);
  if (high != 0) return 128 - __builtin_clzll(high);
  return low == 0 ? 0 : 64 - __builtin_clzll(low);
}

UInt128 gcd_of_odd(UInt128 a, UInt128 b) {
  if (a == 1 || b == 1) return 1;
  while (a != b) {  // binary: the difference of odd numbers is even
    if (a < b) std::swap(a, b);
    a -= b;
    a >>= trailing_zeros(a);
  }
  return a | 1;  // it is odd; this says so to static analysis, which fears a division by 0
}

/// a << shift, or false if it does not fit 126 bits.
bool shift_left(Int128& a, std::int64_t shift) {
  if (a == 0) return true;
  if (shift + bit_length(magnitude(a)) > 126) return false;
  a *= Int128{1} << shift;
  return true;
}

bool multiply(Int128 a, Int128 b, Int128& product) { return !__builtin_mul_overflow(a, b, &product); }

std::string decimal(Int128 value) {
  UInt128 rest = magnitude(value);
  std::string digits;
  do {
    digits += static_cast<char>('0' + static_cast<int>(rest % 10));
    rest /= 10;
  } while (rest != 0);
  if (value < 0) digits += '-';
  std::reverse(digits.begin(), digits.end());
  return digits;
}

/// The square root of a non-negative odd number, if it is whole.
std::optional<Int128> whole_root(Int128 a) {
  Int128 low = 0;
  Int128 high = Int128{1} << 63;
  while (low < high) {  // bisection: the largest root with root^2 <= a
    const Int128 middle = (low + high + 1) / 2;
    if (middle <= a / middle) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  if (low * low != a) return std::nullopt;
  return low;
}

}  // namespace

Rational Rational::invalid() {
  Rational result;
  result.denominator_ = 0;
  return result;
}

Rational Rational::reduced(Int128 numerator, Int128 denominator, std::int64_t exponent) {
  if (denominator == 0) return invalid();
  Rational result;
  if (numerator == 0) return result;
  const bool negative = (numerator < 0) != (denominator < 0);
  UInt128 n = magnitude(numerator);
  UInt128 d = magnitude(denominator);
  const int n_zeros = trailing_zeros(n);
  const int d_zeros = trailing_zeros(d);
  n >>= n_zeros;
  d >>= d_zeros;
  exponent += n_zeros - d_zeros;
  const UInt128 divisor = gcd_of_odd(n, d);
  n /= divisor;
  d /= divisor;
  if (bit_length(n) > 126 || bit_length(d) > 126 || exponent > max_exponent || exponent < -max_exponent) {
    return invalid();
  }
  result.numerator_ = negative ? -static_cast<Int128>(n) : static_cast<Int128>(n);
  result.denominator_ = static_cast<Int128>(d);
  result.exponent_ = static_cast<std::int32_t>(exponent);
  return result;
}

std::optional<Rational> Rational::parse(std::string_view literal) {
  Rational mantissa;
  std::int64_t scale = 0;  // the value is mantissa * 10^scale
  std::int64_t zeros = 0;  // zeros read but not yet taken in: trailing ones cost nothing
  bool any_digit = false;
  bool fraction = false;
  std::size_t i = 0;
  for (; i < literal.size(); ++i) {
    const char c = literal[i];
    if (c == '.' && !fraction) {
      fraction = true;
      continue;
    }
    if (std::isdigit(static_cast<unsigned char>(c)) == 0) break;
    any_digit = true;
    if (fraction) --scale;
    if (c == '0') {
      ++zeros;
    } else if (mantissa.valid()) {
      mantissa = mantissa * (mantissa.is_zero() ? Rational(1) : Rational(10).power(zeros + 1)) + Rational(c - '0');
      zeros = 0;
    }
  }
  if (!any_digit) return std::nullopt;
  scale += zeros;
  if (i < literal.size() && (literal[i] == 'e' || literal[i] == 'E')) {
    ++i;
    const bool negative = i < literal.size() && literal[i] == '-';
    if (i < literal.size() && (literal[i] == '-' || literal[i] == '+')) ++i;
    if (i == literal.size()) return std::nullopt;
    std::int64_t exponent = 0;
    for (; i < literal.size() && std::isdigit(static_cast<unsigned char>(literal[i])) != 0; ++i) {
      exponent = std::min<std::int64_t>(exponent * 10 + (literal[i] - '0'), 100 * max_exponent);
    }
    scale += negative ? -exponent : exponent;
  }
  if (i != literal.size()) return std::nullopt;
  if (mantissa.is_zero()) return mantissa;
  return mantissa * Rational(10).power(scale);
}

std::optional<std::int64_t> Rational::to_integer() const {
  if (!valid() || denominator_ != 1 || exponent_ < 0) return std::nullopt;
  if (exponent_ + bit_length(magnitude(numerator_)) > 63) return std::nullopt;
  return static_cast<std::int64_t>(numerator_ * (Int128{1} << exponent_));
}

std::optional<double> Rational::to_double() const {
  if (!valid() || denominator_ != 1) return std::nullopt;
  const int bits = bit_length(magnitude(numerator_));
  if (bits > 53 || (numerator_ != 0 && exponent_ < -1074) || bits + exponent_ > 1024) return std::nullopt;
  return std::ldexp(static_cast<double>(static_cast<std::int64_t>(numerator_)), exponent_);
}

double Rational::round_down() const {
  if (!valid() || numerator_ <= 0) return 0;
  // Long division to 53 bits or more, the rest cut off: quotient * 2^e <= *this < (quotient + 1) * 2^e.
  const auto d = static_cast<UInt128>(denominator_);
  UInt128 quotient = magnitude(numerator_) / d;
  UInt128 remainder = magnitude(numerator_) % d;
  std::int64_t e = exponent_;
  while (bit_length(quotient) < 53) {
    remainder <<= 1;
    quotient = (quotient << 1) | UInt128{remainder >= d};
    if (remainder >= d) remainder -= d;
    --e;
  }
  const std::int64_t excess = std::max<std::int64_t>(bit_length(quotient) - 53, -1074 - e);
  if (excess >= 128) return 0;
  if (excess > 0) {
    quotient >>= excess;
    e += excess;
  }
  if (bit_length(quotient) + e > 1024) return std::numeric_limits<double>::max();
  return std::ldexp(static_cast<double>(static_cast<std::uint64_t>(quotient)), static_cast<int>(e));
}

std::optional<Rational> Rational::square_root() const {
  if (!valid() || numerator_ < 0 || exponent_ % 2 != 0) return std::nullopt;
  if (numerator_ == 0) return Rational();
  const auto n = whole_root(numerator_);
  const auto d = whole_root(denominator_);
  if (!n || !d) return std::nullopt;
  return reduced(*n, *d, exponent_ / 2);
}

Rational Rational::power(std::int64_t n) const {
  Rational base = n < 0 ? reciprocal() : *this;
  Rational result = 1;
  for (std::uint64_t rest = n < 0 ? 0 - static_cast<std::uint64_t>(n) : static_cast<std::uint64_t>(n); rest != 0;) {
    if ((rest & 1) != 0) result = result * base;
    rest >>= 1;
    if (rest != 0) base = base * base;
    if (!result.valid()) break;
  }
  return result;
}

std::string Rational::to_string() const {
  if (!valid()) return "invalid";
  Int128 n = numerator_;
  Int128 d = denominator_;
  const auto power = [](std::int64_t exponent) { return "*2^" + std::to_string(exponent); };
  std::string numerator;
  std::string denominator;
  if (exponent_ > 0 && !shift_left(n, exponent_)) numerator = power(exponent_);
  if (exponent_ < 0 && !shift_left(d, -std::int64_t{exponent_})) denominator = power(-std::int64_t{exponent_});
  numerator = decimal(n) + numerator;
  if (!denominator.empty()) return numerator + "/(" + decimal(d) + denominator + ")";
  return d == 1 ? numerator : numerator + "/" + decimal(d);
}

Rational Rational::operator-() const {
  Rational result = *this;
  result.numerator_ = -result.numerator_;
  return result;
}

Rational Rational::reciprocal() const {
  if (!valid() || numerator_ == 0) return invalid();
  return reduced(denominator_, numerator_, -std::int64_t{exponent_});
}

Rational operator*(const Rational& a, const Rational& b) {
  if (a.is_one()) return b;
  if (b.is_one()) return a;
  if (!a.valid() || !b.valid()) return Rational::invalid();
  if (a.numerator_ == 0 || b.numerator_ == 0) return {};
  // Reducing crosswise first keeps the products as small as the result.
  const auto g = static_cast<Int128>(gcd_of_odd(magnitude(a.numerator_), magnitude(b.denominator_)));
  const auto h = static_cast<Int128>(gcd_of_odd(magnitude(b.numerator_), magnitude(a.denominator_)));
  Int128 n = 0;
  Int128 d = 0;
  if (!multiply(a.numerator_ / g, b.numerator_ / h, n)) return Rational::invalid();
  if (!multiply(a.denominator_ / h, b.denominator_ / g, d)) return Rational::invalid();
  return Rational::reduced(n, d, std::int64_t{a.exponent_} + b.exponent_);
}

Rational operator+(const Rational& a, const Rational& b) {
  if (!a.valid() || !b.valid()) return Rational::invalid();
  if (a.numerator_ == 0) return b;
  if (b.numerator_ == 0) return a;
  const Rational& high = a.exponent_ >= b.exponent_ ? a : b;
  const Rational& low = a.exponent_ >= b.exponent_ ? b : a;
  const auto g = static_cast<Int128>(gcd_of_odd(magnitude(a.denominator_), magnitude(b.denominator_)));
  Int128 first = 0;
  Int128 second = 0;
  Int128 sum = 0;
  Int128 denominator = 0;
  const bool fits = multiply(high.numerator_, low.denominator_ / g, first) &&
                    shift_left(first, std::int64_t{high.exponent_} - low.exponent_) &&
                    multiply(low.numerator_, high.denominator_ / g, second) &&
                    !__builtin_add_overflow(first, second, &sum) &&
                    multiply(high.denominator_ / g, low.denominator_, denominator);
  return fits ? Rational::reduced(sum, denominator, low.exponent_) : Rational::invalid();
}

Rational abs(const Rational& a) { return a.sign() < 0 ? -a : a; }

Rational common_divisor(const Rational& a, const Rational& b) {
  // gcd of the numerators over the lcm of the denominators; the lower power of two.
  const auto n = static_cast<Int128>(gcd_of_odd(magnitude(a.odd_numerator()), magnitude(b.odd_numerator())));
  const auto g = static_cast<Int128>(gcd_of_odd(magnitude(a.odd_denominator()), magnitude(b.odd_denominator())));
  Int128 d = 0;
  if (!multiply(a.odd_denominator() / g, b.odd_denominator(), d)) return Rational::invalid();
  return Rational::quotient(n, d) * Rational::power_of_two(std::min(a.exponent(), b.exponent()));
}

Rational binomial(int n, int k) {
  Rational result = 1;
  for (int i = 1; i <= k && result.valid(); ++i) result = result * Rational::quotient(n - k + i, i);
  return result;
}

std::vector<double> double_factors(Int128 p) {
  constexpr Int128 limit = Int128{1} << 53;
  if (p < limit) return {static_cast<double>(static_cast<std::int64_t>(p))};
  std::vector<double> factors;
  Int128 group = 1;
  for (Int128 prime = 3; prime < 1000 && p >= limit; prime += 2) {
    for (; p % prime == 0 && p >= limit; p /= prime) {
      if (group * prime >= limit) {
        factors.push_back(static_cast<double>(static_cast<std::int64_t>(group)));
        group = 1;
      }
      group *= prime;
    }
  }
  if (p >= limit) return {};
  factors.push_back(static_cast<double>(static_cast<std::int64_t>(group)));
  factors.push_back(static_cast<double>(static_cast<std::int64_t>(p)));
  return factors;
}

}  // namespace tightrope::dsl
