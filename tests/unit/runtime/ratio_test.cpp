#include <gtest/gtest.h>

#include <limits>

#include "exact_reference.h"

namespace tightrope {
namespace {

using test::RandomDouble;
using test::rational;

DyadicRatio random_ratio(RandomDouble& random) {
  DyadicRatio x(random());
  for (int i = random.integer(0, 2); i > 0; --i) {
    const double divisor = random();
    if (divisor != 0) x = x / DyadicRatio(divisor) + DyadicRatio(random());
  }
  return x;
}

TEST(DyadicRatio, ArithmeticAgreesWithRationalArithmetic) {
  RandomDouble random(11);
  for (int i = 0; i < 10000; ++i) {
    const DyadicRatio x = random_ratio(random), y = i % 4 == 0 ? x : random_ratio(random);
    const mpq_class a = rational(x), b = rational(y);
    EXPECT_EQ(rational(x + y), a + b);
    EXPECT_EQ(rational(x - y), a - b);
    EXPECT_EQ(rational(x * y), a * b);
    if (y.sign() != 0) {
      EXPECT_EQ(rational(x / y), a / b);
    }
    EXPECT_EQ(rational(-x), -a);
    EXPECT_EQ(rational(abs(x)), ::abs(a));
    EXPECT_EQ(rational(min(x, y)), a < b ? a : b);
    EXPECT_EQ(rational(max(x, y)), a < b ? b : a);
    EXPECT_EQ(rational(fma(x, y, x)), a * b + a);
    EXPECT_EQ(rational(mul_pow2(x, -77)) * rational(Dyadic(0x1p77)), a);
    EXPECT_EQ(x.sign(), sgn(a));
    EXPECT_EQ(x < y, a < b);
    EXPECT_EQ(x == y, a == b);
    EXPECT_EQ(rational(x.denominator()) > 0, true);
  }
}

TEST(DyadicRatio, AlgebraicIdentitiesHoldExactly) {
  RandomDouble random(12);
  for (int i = 0; i < 3000; ++i) {
    const DyadicRatio x = random_ratio(random), y = random_ratio(random), z = random_ratio(random);
    EXPECT_EQ((x + y) * (x - y), x * x - y * y);
    EXPECT_EQ(x * (y + z), x * y + x * z);
    EXPECT_EQ((x + y) + z, x + (y + z));
    if (y.sign() != 0) {
      EXPECT_EQ(x / y * y, x);
      EXPECT_EQ((x + z) / y, x / y + z / y);
    }
  }
}

TEST(DyadicRatio, PowersOfTwoAndEqualDenominatorsDoNotGrowTheDenominator) {
  const DyadicRatio third = DyadicRatio(1) / DyadicRatio(3);
  EXPECT_EQ((third + third).denominator(), Dyadic(3));
  EXPECT_EQ((third - DyadicRatio(2) / DyadicRatio(3)).denominator(), Dyadic(3));
  EXPECT_EQ((DyadicRatio(5) / DyadicRatio(0.125)).denominator(), Dyadic(1));
  EXPECT_EQ((DyadicRatio(5) / DyadicRatio(-0.125)), DyadicRatio(-40));
  EXPECT_EQ(mul_pow2(third, 5).denominator(), Dyadic(3));
}

TEST(DyadicRatio, ToDoubleIsWithinTwoUlps) {
  RandomDouble random(13);
  for (int i = 0; i < 10000; ++i) {
    const double p = std::ldexp(random.unit(), random.integer(-300, 300));
    const double q = std::ldexp(random.unit(), random.integer(-300, 300));
    const DyadicRatio x = DyadicRatio(p) / DyadicRatio(q) + DyadicRatio(random.unit()) * DyadicRatio(0x1p-70);
    const mpq_class exact = rational(x), error = ::abs(mpq_class(x.to_double()) - exact);
    EXPECT_LE(error, ::abs(exact) * mpq_class(0x1p-51));
  }
  EXPECT_EQ((DyadicRatio(1) / DyadicRatio(3)).to_double(), 1.0 / 3.0);
  EXPECT_EQ((DyadicRatio(0x1p-1074) / DyadicRatio(3)).to_double(), 0.0);
  EXPECT_EQ((DyadicRatio(-0x1p1023) / DyadicRatio(1.0 / 3.0)).to_double(), -std::numeric_limits<double>::infinity());
}

TEST(DyadicRatioDeathTest, RefusesZeroDenominatorsAndSquareRoots) {
  EXPECT_DEATH(DyadicRatio(1) / DyadicRatio(0), "denominator is not zero");
  EXPECT_DEATH(DyadicRatio(Dyadic(1), Dyadic(0)).sign(), "denominator is not zero");
  EXPECT_DEATH(sqrt(DyadicRatio(4)), "square roots");
  EXPECT_DEATH(DyadicRatio(std::numeric_limits<double>::quiet_NaN()).sign(), "finite");
}

}  // namespace
}  // namespace tightrope
