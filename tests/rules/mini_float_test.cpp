/// The miniature format against an independent definition: the nearest of all numbers, found by search.

#include "tests/rules/mini_float.h"

#include <gtest/gtest.h>
#include <tightrope/exact.h>

#include <functional>

namespace tightrope::rules {
namespace {

/// All magnitudes in ascending order; the last one, 2^(max_exponent + 1), stands for infinity as IEEE 754 has it.
template <class Mini>
std::vector<DyadicRatio> ladder() {
  std::vector<DyadicRatio> all;
  for (const Mini x : Mini::magnitudes()) all.emplace_back(x.to_double());
  all.emplace_back(std::ldexp(1.0, Mini::max_exponent + 1));
  return all;
}

using Comparison = std::function<int(const DyadicRatio&)>;  ///< sign of (number - x), for the number in question

/// The code of the magnitude nearest to a number.
template <class Mini>
int nearest(const Comparison& compare) {
  static const std::vector<DyadicRatio> numbers = ladder<Mini>();
  std::size_t low = 0;
  std::size_t high = numbers.size();
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (compare(numbers[middle]) >= 0 ? low : high) = middle;
  }
  if (low + 1 == numbers.size()) return static_cast<int>(low);
  const int side = compare((numbers[low] + numbers[low + 1]) * DyadicRatio(0.5));
  const bool up = side > 0 || (side == 0 && low % 2 == 1);
  return static_cast<int>(up ? low + 1 : low);
}

/// Expected: the nearest number; where IEEE 754 has special rules (zeros, infinities, NaN), what double does.
template <class Mini>
::testing::AssertionResult is_rounded(Mini result, const DyadicRatio& exact, double in_double) {
  if (!std::isfinite(in_double) || exact.sign() == 0) {
    const bool same = std::isnan(in_double) ? result.is_nan()
                                            : result.to_double() == in_double &&
                                                  std::signbit(result.to_double()) == std::signbit(in_double);
    return same ? ::testing::AssertionSuccess() : ::testing::AssertionFailure() << result.to_double() << in_double;
  }
  const DyadicRatio magnitude = abs(exact);
  const int code = nearest<Mini>([&](const DyadicRatio& x) { return (magnitude - x).sign(); });
  if (result.magnitude() == code && result.negative() == (exact.sign() < 0)) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << exact.to_string() << " gives " << result.to_double();
}

template <class Mini>
class MiniFloatTest : public ::testing::Test {};
using Formats = ::testing::Types<MiniFloat<3, 3>, MiniFloat<3, 5>, MiniFloat<4, 3>, MiniFloat<4, 4>, MiniFloat<4, 5>>;
TYPED_TEST_SUITE(MiniFloatTest, Formats);

TYPED_TEST(MiniFloatTest, SumsProductsAndQuotientsAreTheNearestNumbers) {
  using Mini = TypeParam;
  for (int a = 0; a < Mini::codes; ++a) {
    for (int b = 0; b < Mini::codes; ++b) {
      const Mini x = Mini::from_code(a);
      const Mini y = Mini::from_code(b);
      const double dx = x.to_double();
      const double dy = y.to_double();
      const bool finite = x.is_finite() && y.is_finite();
      const DyadicRatio ex(finite ? dx : 0);
      const DyadicRatio ey(finite ? dy : 0);
      ASSERT_TRUE(is_rounded(x + y, ex + ey, dx + dy)) << dx << " + " << dy;
      ASSERT_TRUE(is_rounded(x - y, ex - ey, dx - dy)) << dx << " - " << dy;
      ASSERT_TRUE(is_rounded(x * y, ex * ey, dx * dy)) << dx << " * " << dy;
      const DyadicRatio quotient = ey.sign() == 0 ? DyadicRatio() : ex / ey;
      ASSERT_TRUE(is_rounded(x / y, quotient, dx / dy)) << dx << " / " << dy;
      ASSERT_EQ(x < y, dx < dy);
      ASSERT_EQ(x <= y, dx <= dy);
      ASSERT_EQ(x == y, dx == dy);
    }
  }
}

TYPED_TEST(MiniFloatTest, RootsScalingsAndConversionsAreTheNearestNumbers) {
  using Mini = TypeParam;
  for (int a = 0; a < Mini::codes; ++a) {
    const Mini x = Mini::from_code(a);
    const double dx = x.to_double();
    ASSERT_EQ(abs(x).magnitude(), x.magnitude());
    ASSERT_FALSE(abs(x).negative());
    if (!x.is_finite()) continue;
    const DyadicRatio exact(dx);
    for (int k = -25; k <= 25; ++k) {
      ASSERT_TRUE(is_rounded(mul_pow2(x, k), mul_pow2(exact, k), std::ldexp(dx, k))) << dx << " 2^" << k;
    }
    ASSERT_EQ(Mini(dx).code(), x.code());
    for (const double part : {0.25, 0.5, 0.75}) {
      const double between = dx * (1 + std::ldexp(part, 1 - Mini::digits));
      ASSERT_TRUE(is_rounded(Mini(between), DyadicRatio(between), between)) << between;
    }
    if (dx < 0) {
      ASSERT_TRUE(sqrt(x).is_nan());
    } else if (dx > 0) {
      const int code = nearest<Mini>([&](const DyadicRatio& y) { return (exact - y * y).sign(); });
      ASSERT_EQ(sqrt(x).code(), code) << dx;
    }
  }
  EXPECT_TRUE(sqrt(Mini::infinity()).is_infinite());
  EXPECT_TRUE(sqrt(Mini::quiet_NaN()).is_nan());
  EXPECT_TRUE(Mini(std::nan("")).is_nan());
  EXPECT_EQ(sqrt(-Mini()).code(), (-Mini()).code());
}

TEST(MiniFloat, FusedMultiplyAddIsTheNearestNumber) {
  using Mini = MiniFloat<3, 3>;
  for (int a = 0; a < Mini::codes; ++a) {
    for (int b = 0; b < Mini::codes; ++b) {
      for (int c = 0; c < Mini::codes; ++c) {
        const Mini x = Mini::from_code(a), y = Mini::from_code(b), z = Mini::from_code(c);
        const double dx = x.to_double(), dy = y.to_double(), dz = z.to_double();
        const bool finite = x.is_finite() && y.is_finite() && z.is_finite();
        const DyadicRatio exact = finite ? DyadicRatio(dx * dy + dz) : DyadicRatio();  // few bits: exact in double
        ASSERT_TRUE(is_rounded(fma(x, y, z), exact, dx * dy + dz)) << dx << ' ' << dy << ' ' << dz;
      }
    }
  }
}

/// A multiplication that truncates must not pass for one that rounds to nearest.
TEST(MiniFloat, TheSearchNoticesTruncation) {
  using Mini = MiniFloat<4, 4>;
  int noticed = 0;
  for (int a = 0; a < Mini::infinite; ++a) {
    const double square = Mini::from_code(a).to_double() * Mini::from_code(a).to_double();
    int code = 0;
    while (code + 1 < Mini::infinite && Mini::from_code(code + 1).to_double() <= square) ++code;
    if (!is_rounded(Mini::from_code(code), DyadicRatio(square), square)) ++noticed;
  }
  EXPECT_GT(noticed, Mini::infinite / 4);
}

}  // namespace
}  // namespace tightrope::rules
