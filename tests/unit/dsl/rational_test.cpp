#include "dsl/rational.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace tightrope::dsl {
namespace {

mpz_class to_mpz(Int128 value) {
  const bool negative = value < 0;
  if (negative) value = -value;
  mpz_class high(static_cast<unsigned long>(value >> 64));
  mpz_class result = (high << 64) + mpz_class(static_cast<unsigned long>(value & ~0ull));
  return negative ? mpz_class(-result) : result;
}

mpq_class to_mpq(const Rational& r) {
  mpq_class result(to_mpz(r.odd_numerator()), to_mpz(r.odd_denominator()));
  result.canonicalize();
  const auto shift = static_cast<mp_bitcnt_t>(std::abs(r.exponent()));
  if (r.exponent() >= 0) {
    mpq_mul_2exp(result.get_mpq_t(), result.get_mpq_t(), shift);
  } else {
    mpq_div_2exp(result.get_mpq_t(), result.get_mpq_t(), shift);
  }
  return result;
}

bool is_normal(const Rational& r) {
  if (r.is_zero()) return r.odd_denominator() == 1 && r.exponent() == 0;
  const mpz_class n = to_mpz(r.odd_numerator());
  const mpz_class d = to_mpz(r.odd_denominator());
  return mpz_odd_p(n.get_mpz_t()) != 0 && mpz_odd_p(d.get_mpz_t()) != 0 && d > 0 && gcd(n, d) == 1;
}

Rational random_rational(std::mt19937_64& random, int bits) {
  const auto part = [&] {
    const auto value =
        static_cast<std::int64_t>(random() >> (64 - std::uniform_int_distribution<int>(1, bits)(random)));
    return random() % 2 == 0 ? value : -value;
  };
  std::int64_t d = 0;
  while (d == 0) d = part();
  const std::int64_t n = part();
  return Rational::quotient(n, d) * Rational::power_of_two(std::uniform_int_distribution<int>(-9, 9)(random));
}

TEST(Rational, AgreesWithGmp) {
  std::mt19937_64 random(11);
  for (int round = 0; round < 20000; ++round) {
    const Rational a = random_rational(random, 30);
    const Rational b = random_rational(random, 30);
    ASSERT_TRUE(a.valid() && b.valid());
    EXPECT_EQ(to_mpq(a + b), to_mpq(a) + to_mpq(b));
    EXPECT_EQ(to_mpq(a - b), to_mpq(a) - to_mpq(b));
    EXPECT_EQ(to_mpq(a * b), to_mpq(a) * to_mpq(b));
    EXPECT_EQ(to_mpq(-a), -to_mpq(a));
    EXPECT_EQ(a.sign(), sgn(to_mpq(a)));
    EXPECT_EQ(a == b, to_mpq(a) == to_mpq(b));
    EXPECT_TRUE(is_normal(a + b) && is_normal(a * b) && is_normal(a - b));
    if (b.is_zero()) continue;
    EXPECT_EQ(to_mpq(a / b), to_mpq(a) / to_mpq(b));
    EXPECT_TRUE(is_normal(a / b));
    if (a.is_zero()) continue;
    const Rational g = common_divisor(a, b);
    for (const Rational& multiple : {a / g, b / g}) {
      EXPECT_TRUE(multiple.odd_denominator() == 1 && multiple.exponent() >= 0)
          << a.to_string() << ", " << b.to_string();
    }
  }
}

TEST(Rational, IsNeverWrongWhereItDoesNotOverflow) {
  std::mt19937_64 random(12);
  int valid = 0;
  int invalid = 0;
  for (int round = 0; round < 5000; ++round) {
    Rational a = random_rational(random, 63);
    mpq_class exact = to_mpq(a);
    for (int step = 0; step < 4; ++step) {
      const Rational b = random_rational(random, 40);
      if (step % 2 == 0) {
        a = a * b;
        exact *= to_mpq(b);
      } else {
        a = a + b;
        exact += to_mpq(b);
      }
      if (!a.valid()) break;
      ASSERT_EQ(to_mpq(a), exact);
    }
    ++(a.valid() ? valid : invalid);
  }
  EXPECT_GT(valid, 100);
  EXPECT_GT(invalid, 100);  // so that the overflow paths have been taken
}

TEST(Rational, StaysInvalid) {
  const Rational bad = Rational(1) / Rational(0);
  EXPECT_FALSE(bad.valid());
  for (const Rational& r : {bad + 1, 1 - bad, bad * 0, bad / 2, -bad, bad.power(0) * bad, abs(bad)}) {
    EXPECT_FALSE(r.valid());
  }
  EXPECT_FALSE(bad.is_zero());
  EXPECT_FALSE(bad.is_one());
  EXPECT_FALSE(bad.to_double());
  EXPECT_FALSE(bad.to_integer());
  EXPECT_FALSE(Rational(3).power(100).valid());
  EXPECT_FALSE(Rational(2).power(100'000'000).valid());
  EXPECT_FALSE(Rational(0).power(-1).valid());
}

TEST(Rational, ReadsDecimalLiteralsExactly) {
  const auto q = [](std::int64_t n, std::int64_t d) { return Rational::quotient(n, d); };
  EXPECT_EQ(Rational::parse("0"), Rational(0));
  EXPECT_EQ(Rational::parse("12"), Rational(12));
  EXPECT_EQ(Rational::parse("007"), Rational(7));
  EXPECT_EQ(Rational::parse("0.1"), q(1, 10));
  EXPECT_EQ(Rational::parse("0.10000000000000000000000000000000000000000000"), q(1, 10));
  EXPECT_EQ(Rational::parse("10.0"), Rational(10));
  EXPECT_EQ(Rational::parse("1020.0304"), q(10200304, 10000));
  EXPECT_EQ(Rational::parse("2.5e-3"), q(1, 400));
  EXPECT_EQ(Rational::parse("2.5E+3"), Rational(2500));
  EXPECT_EQ(Rational::parse("1000e-3"), Rational(1));
  EXPECT_EQ(Rational::parse("0e999999999999999999999"), Rational(0));
  EXPECT_EQ(Rational::parse("1e22")->to_double(), 1e22);
  EXPECT_FALSE(Rational::parse("1e400")->valid());
  EXPECT_FALSE(Rational::parse("1e999999999999999999999999")->valid());
  EXPECT_FALSE(Rational::parse(std::string(100, '7'))->valid());
  for (const char* text : {"", ".", "e3", "1e", "1e+", "1.2.3", "0x10", "1 ", "-1", "1f"}) {
    EXPECT_FALSE(Rational::parse(text)) << text;
  }
}

TEST(Rational, KnowsWhichNumbersAreDoubles) {
  EXPECT_EQ(Rational(0).to_double(), 0.0);
  EXPECT_EQ(Rational(-3).to_double(), -3.0);
  EXPECT_EQ(Rational::quotient(3, 8).to_double(), 0.375);
  EXPECT_FALSE(Rational::quotient(1, 10).to_double());
  const std::int64_t big = std::int64_t{1} << 53;
  EXPECT_EQ(Rational(big - 1).to_double(), static_cast<double>(big - 1));
  EXPECT_FALSE(Rational(big + 1).to_double());
  EXPECT_EQ(Rational(big + 2).to_double(), static_cast<double>(big + 2));
  EXPECT_EQ(Rational::power_of_two(1023).to_double(), std::ldexp(1.0, 1023));
  EXPECT_FALSE(Rational::power_of_two(1024).to_double());
  EXPECT_EQ((Rational(big - 1) * Rational::power_of_two(971)).to_double(), std::numeric_limits<double>::max());
  EXPECT_EQ(Rational::power_of_two(-1074).to_double(), std::numeric_limits<double>::denorm_min());
  EXPECT_FALSE(Rational::power_of_two(-1075).to_double());
  EXPECT_EQ((3 * Rational::power_of_two(-1074)).to_double(), 3 * std::numeric_limits<double>::denorm_min());
}

TEST(Rational, RoundsDownToADouble) {
  std::mt19937_64 random(13);
  for (int round = 0; round < 5000; ++round) {
    const int scale = std::uniform_int_distribution<int>(-1080, 1030)(random);
    const Rational a = abs(random_rational(random, 63)) * Rational::power_of_two(scale);
    const double down = a.round_down();
    if (a.is_zero()) {
      EXPECT_EQ(down, 0);
      continue;
    }
    EXPECT_LE(mpq_class(down), to_mpq(a));
    const double up = std::nextafter(down, std::numeric_limits<double>::infinity());
    if (std::isfinite(up)) {
      EXPECT_GT(mpq_class(up), to_mpq(a));
    }
  }
  EXPECT_EQ(Rational::power_of_two(2000).round_down(), std::numeric_limits<double>::max());
  EXPECT_EQ(Rational::power_of_two(-1075).round_down(), 0);
  EXPECT_EQ(Rational::power_of_two(-1074).round_down(), std::numeric_limits<double>::denorm_min());
}

TEST(Rational, FindsRootsOfSquaresOnly) {
  std::mt19937_64 random(14);
  for (int round = 0; round < 500; ++round) {
    const Rational a = abs(random_rational(random, 50));
    EXPECT_EQ((a * a).square_root(), a);
    if (!a.is_zero()) {
      EXPECT_FALSE((a * a * 2).square_root());
    }
  }
  EXPECT_FALSE(Rational(-4).square_root());
  EXPECT_FALSE(Rational(3).square_root());
}

TEST(Rational, PrintsAsItIsWritten) {
  EXPECT_EQ(Rational(3).to_string(), "3");
  EXPECT_EQ(Rational::quotient(-1, 10).to_string(), "-1/10");
  EXPECT_EQ(Rational::quotient(12, 7).to_string(), "12/7");
  EXPECT_EQ(Rational::power_of_two(100).to_string(), "1267650600228229401496703205376");
  EXPECT_EQ((3 * Rational::power_of_two(200)).to_string(), "3*2^200");
  EXPECT_EQ((Rational(1) / 5 * Rational::power_of_two(-200)).to_string(), "1/(5*2^200)");
}

TEST(Rational, KnowsBinomialCoefficients) {
  EXPECT_EQ(binomial(4, 2), Rational(6));
  EXPECT_EQ(binomial(64, 0), Rational(1));
  EXPECT_EQ(binomial(64, 64), Rational(1));
  for (int n = 1; n <= 64; ++n) {
    for (int k = 1; k < n; ++k) ASSERT_EQ(binomial(n, k), binomial(n - 1, k - 1) + binomial(n - 1, k)) << n;
  }
  EXPECT_FALSE(binomial(500, 250).valid());
}

TEST(DoubleFactors, MultiplyToTheNumberAndAreDoubles) {
  for (const auto& [n, k] : {std::pair(3, 1), std::pair(60, 30), std::pair(64, 32), std::pair(120, 60)}) {
    const Rational b = binomial(n, k);
    ASSERT_TRUE(b.valid());
    mpz_class product = 1;
    for (const double factor : double_factors(b.odd_numerator())) product *= mpz_class(factor);
    EXPECT_EQ(product, to_mpz(b.odd_numerator()));
  }
  EXPECT_EQ(double_factors((Int128{1} << 53) - 1).size(), 1u);
  EXPECT_TRUE(double_factors((Int128{1} << 61) - 1).empty());  // a prime
}

}  // namespace
}  // namespace tightrope::dsl
