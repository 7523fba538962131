#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

#include "exact_reference.h"

namespace tightrope {
namespace {

using test::RandomDouble;
using test::rational;

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double largest = std::numeric_limits<double>::max();
constexpr double eta = std::numeric_limits<double>::denorm_min();

/// Sums and products of a few doubles: numbers of many limbs, with gaps, cancellation and carries.
Dyadic random_number(RandomDouble& random) {
  Dyadic x(random());
  for (int i = random.integer(0, 5); i > 0; --i) {
    const Dyadic y(random());
    switch (random.integer(0, 3)) {
      case 0:
        x = x * y;
        break;
      case 1:
        x = x + y;
        break;
      case 2:
        x = x - y;
        break;
      default:
        x = x * x - x * y;
        break;
    }
  }
  return x;
}

TEST(Dyadic, HoldsEveryFiniteDoubleExactly) {
  RandomDouble random(1);
  for (int i = 0; i < 20000; ++i) {
    const double x = random();
    EXPECT_EQ(rational(Dyadic(x)), mpq_class(x)) << x;
    EXPECT_EQ(Dyadic(x).to_double(), x);
  }
  for (const double x : {0.0, -0.0, eta, -eta, largest, -largest, 0x1p-1022, 0x0.fffffffffffffp-1022, 1.0}) {
    EXPECT_EQ(rational(Dyadic(x)), mpq_class(x)) << x;
    EXPECT_EQ(Dyadic(x).to_double(), x);
  }
}

TEST(Dyadic, HoldsFloatsAndIntegersExactly) {
  EXPECT_EQ(rational(Dyadic(0.1f)), mpq_class(static_cast<double>(0.1f)));
  EXPECT_EQ(rational(Dyadic(-7)), mpq_class(-7));
  EXPECT_EQ(Dyadic(std::numeric_limits<std::int64_t>::min()).to_double(), -0x1p63);
  EXPECT_EQ(rational(Dyadic(std::numeric_limits<std::uint64_t>::max())), mpq_class("18446744073709551615"));
  EXPECT_EQ(Dyadic(0).sign(), 0);
  EXPECT_EQ(Dyadic(0), Dyadic(-0.0));
}

TEST(Dyadic, PrintsItsExactValue) {
  EXPECT_EQ(Dyadic(-62.625).to_string(), "-0x1f5p-3");
  EXPECT_EQ(Dyadic(48).to_string(), "0x3p+4");
  EXPECT_EQ(Dyadic().to_string(), "0x0p+0");
  EXPECT_EQ((Dyadic(0x1p100) + Dyadic(1)).to_string(), "0x10000000000000000000000001p+0");
}

TEST(Dyadic, ArithmeticAgreesWithRationalArithmetic) {
  RandomDouble random(2);
  for (int i = 0; i < 20000; ++i) {
    const Dyadic x = random_number(random), y = random_number(random);
    const mpq_class a = rational(x), b = rational(y);
    EXPECT_EQ(rational(x + y), a + b);
    EXPECT_EQ(rational(x - y), a - b);
    EXPECT_EQ(rational(x * y), a * b);
    EXPECT_EQ(rational(-x), -a);
    EXPECT_EQ(rational(abs(x)), ::abs(a));
    EXPECT_EQ(rational(min(x, y)), a < b ? a : b);
    EXPECT_EQ(rational(max(x, y)), a < b ? b : a);
    EXPECT_EQ(x.sign(), sgn(a));
    EXPECT_EQ(x < y, a < b);
    EXPECT_EQ(x == y, a == b);
    EXPECT_EQ(x > -y, a > -b);
  }
}

TEST(Dyadic, IsOneRepresentationPerValue) {
  RandomDouble random(3);
  for (int i = 0; i < 5000; ++i) {
    const Dyadic x = random_number(random), y = random_number(random), z = random_number(random);
    EXPECT_EQ((x + y) * (x - y), x * x - y * y);
    EXPECT_EQ((x + y) + z, x + (y + z));
    EXPECT_EQ(x * (y + z), x * y + x * z);
    EXPECT_EQ(((x + y) - x).to_string(), y.to_string());
    EXPECT_EQ(x - x, Dyadic());
    EXPECT_EQ((x - x).to_string(), "0x0p+0");
    EXPECT_EQ((-x * Dyadic(0)).sign(), 0);
  }
}

TEST(Dyadic, CarriesAndBorrowsCrossLimbs) {
  for (int e = -130; e <= 130; ++e) {
    const Dyadic power = mul_pow2(Dyadic(1), e), below = power - Dyadic(0x1p-500);
    EXPECT_LT(below, power);
    EXPECT_EQ(below + Dyadic(0x1p-500), power);
    EXPECT_EQ(power - below, Dyadic(0x1p-500));
    EXPECT_EQ(below.high_exponent(), e - 1);
    EXPECT_EQ(below.low_exponent(), -500);
    EXPECT_EQ(rational(below * below), rational(below) * rational(below));
  }
}

TEST(Dyadic, SpansTheWholeExponentRange) {
  const Dyadic sum = Dyadic(largest) + Dyadic(eta);
  EXPECT_GT(sum, Dyadic(largest));
  EXPECT_EQ(sum - Dyadic(largest), Dyadic(eta));
  EXPECT_EQ(rational(sum * sum), rational(sum) * rational(sum));
  EXPECT_EQ((Dyadic(0x1p1023) * Dyadic(eta)).to_double(), 0x1p-51);
  EXPECT_EQ(mul_pow2(mul_pow2(sum, 100000), -100000), sum);
}

TEST(Dyadic, ScalesByPowersOfTwo) {
  RandomDouble random(4);
  for (int i = 0; i < 5000; ++i) {
    const Dyadic x = random_number(random);
    const int e = random.integer(-300, 300);
    const Dyadic power = mul_pow2(Dyadic(1), e);
    EXPECT_EQ(rational(mul_pow2(x, e)), rational(x) * rational(power));
    EXPECT_EQ(power.high_exponent(), e);
    EXPECT_EQ(power.low_exponent(), e);
  }
}

TEST(Dyadic, SelfAssignmentAndMovesKeepTheValue) {
  Dyadic many_limbs = Dyadic(largest) + Dyadic(eta), few_limbs(3);
  const Dyadic copy = many_limbs;
  many_limbs = *&many_limbs;
  EXPECT_EQ(many_limbs, copy);
  std::vector<Dyadic> both = {many_limbs, few_limbs};
  std::swap(both[0], both[1]);
  EXPECT_EQ(both[0], Dyadic(3));
  EXPECT_EQ(both[1], copy);
  few_limbs = std::move(both[1]);
  both[1] = Dyadic(5);
  EXPECT_EQ(few_limbs, copy);
  EXPECT_EQ(both[1], Dyadic(5));
}

/// Is `rounded` a double nearest to `exact`, with an even last bit in a tie? By comparison with its neighbours.
::testing::AssertionResult is_nearest(double rounded, const mpq_class& exact) {
  const mpq_class error = ::abs(mpq_class(rounded) - exact);
  for (const double neighbour : {std::nextafter(rounded, -inf), std::nextafter(rounded, inf)}) {
    if (std::isinf(neighbour)) continue;
    const mpq_class other = ::abs(mpq_class(neighbour) - exact);
    const bool odd = (std::bit_cast<std::uint64_t>(rounded) & 1U) != 0;
    if (other < error || (other == error && odd)) return ::testing::AssertionFailure() << rounded << " is not nearest";
  }
  return ::testing::AssertionSuccess();
}

TEST(Dyadic, RoundsToTheNearestDouble) {
  RandomDouble random(5);
  int subnormal = 0, ties = 0;
  for (int i = 0; i < 20000; ++i) {
    // A double plus about half an ulp, exactly half in every other case; a third of them subnormal.
    double x = random();
    if (i % 3 == 0) x = std::ldexp(random.unit(), random.integer(-1074, -1015));
    const double ulp = std::nextafter(std::fabs(x), inf) - std::fabs(x);
    if (std::isinf(ulp)) continue;
    Dyadic y = Dyadic(x) + mul_pow2(Dyadic(ulp), -1);
    if (i % 2 == 0) y = y + Dyadic(random.integer(-1, 1)) * mul_pow2(Dyadic(ulp), -random.integer(2, 200));
    const mpq_class exact = rational(y);
    const double rounded = y.to_double();
    if (std::isinf(rounded)) {
      EXPECT_GE(::abs(exact), mpq_class(largest));
      continue;
    }
    EXPECT_TRUE(is_nearest(rounded, exact));
    EXPECT_LE(mpq_class(y.floor_double()), exact);
    EXPECT_GE(mpq_class(y.ceil_double()), exact);
    const bool representable = mpq_class(rounded) == exact;
    EXPECT_EQ(y.ceil_double(), representable ? rounded : std::nextafter(y.floor_double(), inf));
    subnormal += std::fabs(rounded) < 0x1p-1022 ? 1 : 0;
    ties += i % 2 != 0 ? 1 : 0;
  }
  EXPECT_GT(subnormal, 1000);
  EXPECT_GT(ties, 1000);
}

TEST(Dyadic, RoundingAgreesWithTheProcessor) {
  RandomDouble random(6);
  for (int i = 0; i < 20000; ++i) {
    const double x = random(), y = random();
    EXPECT_EQ((Dyadic(x) + Dyadic(y)).to_double(), x + y) << x << ' ' << y;
    EXPECT_EQ((Dyadic(x) * Dyadic(y)).to_double(), x * y) << x << ' ' << y;
    EXPECT_EQ(Dyadic(x).to_float(), static_cast<float>(x)) << x;
    const auto a = static_cast<float>(random.unit()), b = static_cast<float>(random.unit() * 0x1p-130);
    EXPECT_EQ((Dyadic(a) * Dyadic(b)).to_float(), a * b);
  }
}

TEST(Dyadic, OverflowAndUnderflowRoundAsIeeeSays) {
  const Dyadic max(largest), half_ulp = mul_pow2(Dyadic(1), 970), tiny = mul_pow2(Dyadic(1), -5000);
  EXPECT_EQ((max + half_ulp).to_double(), inf);  // the tie at the end rounds away: largest is odd
  EXPECT_EQ((max + half_ulp - tiny).to_double(), largest);
  EXPECT_EQ((max + tiny).floor_double(), largest);
  EXPECT_EQ((max + tiny).ceil_double(), inf);
  EXPECT_EQ((-max - tiny).floor_double(), -inf);
  EXPECT_EQ((-max - tiny).ceil_double(), -largest);
  EXPECT_EQ(mul_pow2(max, 7).to_double(), inf);
  EXPECT_EQ(mul_pow2(max, 7).floor_double(), largest);
  EXPECT_EQ(mul_pow2(-max, 7).to_double(), -inf);
  EXPECT_EQ(mul_pow2(Dyadic(eta), -1).to_double(), 0.0);  // the tie at 0 is even
  EXPECT_EQ((mul_pow2(Dyadic(eta), -1) + tiny).to_double(), eta);
  EXPECT_EQ(tiny.to_double(), 0.0);
  EXPECT_EQ(tiny.ceil_double(), eta);
  EXPECT_EQ(tiny.floor_double(), 0.0);
  EXPECT_EQ((-tiny).floor_double(), -eta);
  EXPECT_EQ(mul_pow2(Dyadic(1), 128).to_float(), std::numeric_limits<float>::infinity());
  EXPECT_EQ(mul_pow2(Dyadic(1), -149).to_float(), std::numeric_limits<float>::denorm_min());
}

TEST(DyadicDeathTest, RefusesWhatIsNotFinite) {
  EXPECT_DEATH(Dyadic(inf).sign(), "finite");
  EXPECT_DEATH(Dyadic(std::numeric_limits<double>::quiet_NaN()).sign(), "finite");
  EXPECT_DEATH(Dyadic(-std::numeric_limits<float>::infinity()).sign(), "finite");
  EXPECT_DEATH(Dyadic(0).high_exponent(), "not zero");
}

}  // namespace
}  // namespace tightrope
