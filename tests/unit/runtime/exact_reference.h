#pragma once
/// Exact numbers of the runtime as GMP rationals, and random doubles of every kind.

#include <gmpxx.h>
#include <tightrope/exact.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

namespace tightrope::test {

inline mpq_class rational(const Dyadic& x) {
  const std::string text = x.to_string();  // "-0x1f5p-3"
  const std::size_t digits = text.find('x') + 1, p = text.find('p');
  mpq_class value(mpz_class(text.substr(digits, p - digits), 16));
  const long exponent = std::stol(text.substr(p + 1));
  if (exponent >= 0) {
    value <<= static_cast<mp_bitcnt_t>(exponent);
  } else {
    value >>= static_cast<mp_bitcnt_t>(-exponent);
  }
  return text[0] == '-' ? mpq_class(-value) : value;
}

inline mpq_class rational(const DyadicRatio& x) { return rational(x.numerator()) / rational(x.denominator()); }

/// Finite doubles: any bit pattern, small integers, subnormals, powers of two and their neighbours, the interval [-1,
/// 1].
class RandomDouble {
 public:
  explicit RandomDouble(std::uint64_t seed) : engine_(seed) {}
  std::uint64_t bits() { return engine_(); }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  double unit() { return std::uniform_real_distribution<double>(-1, 1)(engine_); }
  double operator()() {
    switch (integer(0, 4)) {
      case 0:
        return integer(-8, 8);
      case 1:
        return std::bit_cast<double>(bits() & 0x800f'ffff'ffff'ffffU);
      case 2:
        return std::nextafter(std::ldexp(1.0, integer(-1060, 1022)), integer(-1, 1) < 0 ? 0.0 : HUGE_VAL);
      case 3:
        return unit();
      default:
        break;
    }
    double x = std::bit_cast<double>(bits());
    while (!std::isfinite(x)) x = std::bit_cast<double>(bits());
    return x;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace tightrope::test
