#include "query_io/rational.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace tightrope::ccd {
namespace {

double random_finite(std::mt19937_64& random) {
  while (true) {
    const double value = std::bit_cast<double>(random());
    if (std::isfinite(value)) return value;
  }
}

Rational parse(const mpz_class& numerator, const mpz_class& denominator) {
  return parse_rational(numerator.get_str(), denominator.get_str());
}

/// No double is nearer to `exact` than `value`, and of two equally near ones it is the even one.
bool is_nearest(double value, const mpq_class& exact) {
  const mpq_class distance = abs(mpq_class(value) - exact);
  for (const double limit : {-HUGE_VAL, HUGE_VAL}) {
    const double neighbour = std::nextafter(value, limit);
    if (std::isinf(neighbour)) continue;
    const mpq_class other = abs(mpq_class(neighbour) - exact);
    if (other < distance) return false;
    if (other == distance && std::bit_cast<std::uint64_t>(value) % 2 == 1) return false;
  }
  return true;
}

TEST(Rational, EveryDoubleComesBackExactly) {
  std::mt19937_64 random(1);
  std::vector<double> values = {0.0,    1.0,     -0.1,      0x1p-1074, -0x1p-1022, 0x1.fffffffffffffp1023,
                                0x1p62, 0x1p-63, 0x1p53 + 2};
  for (int i = 0; i < 20000; ++i) values.push_back(random_finite(random));
  for (int i = 0; i < 2000; ++i) values.push_back(std::ldexp(random_finite(random), -1100));  // subnormals among them
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    std::string text;
    append_rational(text, value);
    const auto comma = text.find(',');
    const Rational back = parse_rational(text.substr(0, comma), text.substr(comma + 1));
    EXPECT_TRUE(back.exact && back.fault.empty()) << text;
    EXPECT_EQ(back.value, value) << text;
  }
}

TEST(Rational, IsWrittenInLowestTerms) {
  const auto written = [](double value) {
    std::string text;
    append_rational(text, value);
    return text;
  };
  EXPECT_EQ(written(0), "0,1");
  EXPECT_EQ(written(-0.0), "0,1");
  EXPECT_EQ(written(-0.75), "-3,4");
  EXPECT_EQ(written(48), "48,1");
  EXPECT_EQ(written(0x1p70), "1180591620717411303424,1");
  EXPECT_EQ(written(0x3p-70), "3,1180591620717411303424");
}

/// Numerators and denominators of 1 .. `bits` bits.
mpz_class random_integer(std::mt19937_64& random, unsigned bits) {
  mpz_class value = 1;
  for (auto count = 1 + random() % bits; count > 1; --count)
    value = 2 * value + static_cast<unsigned long>(random() % 2);
  return random() % 2 == 0 ? value : mpz_class(-value);
}

TEST(Rational, IsRoundedToNearestTiesToEven) {
  std::mt19937_64 random(2);
  int truncation_wrong = 0;
  int inexact = 0;
  for (int i = 0; i < 30000; ++i) {
    const unsigned bits = i % 3 == 0 ? 60 : i % 3 == 1 ? 300 : 1100;
    const mpz_class numerator = random_integer(random, bits);
    const mpz_class denominator = random_integer(random, bits);
    mpq_class exact(numerator, denominator);
    exact.canonicalize();
    const Rational parsed = parse(numerator, denominator);
    if (!parsed.fault.empty()) {
      EXPECT_GE(abs(exact), mpq_class(0x1.fffffffffffffp1023)) << parsed.fault;
      continue;
    }
    EXPECT_TRUE(is_nearest(parsed.value, exact)) << numerator << "," << denominator;
    EXPECT_EQ(parsed.exact, mpq_class(parsed.value) == exact) << numerator << "," << denominator;
    inexact += parsed.exact ? 0 : 1;
    truncation_wrong += is_nearest(exact.get_d(), exact) ? 0 : 1;  // mpq_class::get_d rounds towards 0
  }
  EXPECT_GT(inexact, 10000);
  EXPECT_GT(truncation_wrong, 5000) << "this test would not notice truncation";
}

TEST(Rational, TiesAndTheEdgesOfTheRange) {
  const mpz_class one = 1;
  const auto power = [&](unsigned exponent) { return mpz_class(one << exponent); };
  EXPECT_EQ(parse(power(60) + power(7), one).value, 0x1p60);              // tie, down to even
  EXPECT_EQ(parse(power(60) + 3 * power(7), one).value, 0x1p60 + 0x1p9);  // tie, up to even
  EXPECT_EQ(parse(power(60) + power(7) + 1, one).value, 0x1p60 + 0x1p8);  // just above a tie
  EXPECT_EQ(parse(one, power(1075)).value, 0.0);                          // tie between 0 and the least double
  EXPECT_FALSE(parse(one, power(1075)).exact);
  EXPECT_EQ(parse(power(10) + 1, power(1085)).value, 0x1p-1074);
  EXPECT_EQ(parse(mpz_class(-3), power(1075)).value, -0x1p-1073);  // tie among subnormals
  EXPECT_EQ(parse(one, power(5000)).value, 0.0);
  EXPECT_EQ(parse(power(1024) - power(970) - 1, one).value, 0x1.fffffffffffffp1023);
  EXPECT_EQ(parse(power(1024) - power(970), one).fault, "value beyond the range of double");
  EXPECT_EQ(parse(power(5000), one).fault, "value beyond the range of double");
  EXPECT_EQ(parse(power(5000), power(4999)).value, 2.0);
  EXPECT_TRUE(parse(power(5000), power(4999)).exact);
}

TEST(Rational, SignsAndFaults) {
  EXPECT_EQ(parse_rational("+3", "-4").value, -0.75);
  EXPECT_EQ(parse_rational("-3", "-4").value, 0.75);
  EXPECT_EQ(parse_rational("007", "0014").value, 0.5);
  EXPECT_EQ(parse_rational("1", "0").fault, "zero denominator");
  EXPECT_EQ(parse_rational("0", "-0").fault, "zero denominator");
  EXPECT_EQ(parse_rational(std::string(400, '9'), std::string(400, '0')).fault, "zero denominator");
  for (const char* bad : {"", "-", "+", "1.5", "1e3", "0x10", "--1", "1 2", "nan", "1_000"}) {
    EXPECT_EQ(parse_rational(bad, "1").fault, "numerator is not an integer") << bad;
    EXPECT_EQ(parse_rational("1", bad).fault, "denominator is not an integer") << bad;
  }
}

}  // namespace
}  // namespace tightrope::ccd
