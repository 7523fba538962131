/// Integers of fixed width and scaled inputs against Dyadic numbers.

#include <gtest/gtest.h>
#include <tightrope/exact_sign.h>

#include <cmath>
#include <limits>
#include <random>

namespace tightrope {
namespace {

namespace q = exact_arithmetic;

template <int Words>
Dyadic dyadic(const Integer<Words>& a) {
  Dyadic r;
  for (int i = 0; i < Words; ++i) r += mul_pow2(Dyadic(a.word[i]), 64 * i);
  return a.negative() ? r - mul_pow2(Dyadic(1), 64 * Words) : r;
}

/// Random words, with many that are all zeros or all ones; below 2^(64 Words - spare) in magnitude.
template <int Words>
Integer<Words> random_integer(std::mt19937_64& engine, int spare) {
  Integer<Words> r;
  for (std::uint64_t& word : r.word) {
    const auto kind = engine() % 4;
    word = kind == 0 ? 0 : kind == 1 ? ~std::uint64_t{0} : engine();
  }
  auto top = static_cast<std::int64_t>(r.word[Words - 1]);
  top >>= spare;
  r.word[Words - 1] = static_cast<std::uint64_t>(top);
  return r;
}

template <int A, int B>
void compare_operations(std::mt19937_64& engine) {
  for (int n = 0; n < 300; ++n) {
    const auto a = random_integer<A>(engine, 1);
    const auto b = random_integer<B>(engine, 1);
    const Dyadic x = dyadic(a), y = dyadic(b);
    constexpr int most = A > B ? A : B;
    ASSERT_EQ(dyadic(q::sum<Integer<most>>(a, b)), x + y);
    ASSERT_EQ(dyadic(q::difference<Integer<most>>(a, b)), x - y);
    ASSERT_EQ(dyadic(q::sum<Integer<most + 1>>(a, b)), x + y);
    ASSERT_EQ(dyadic(q::product<Integer<A + B>>(a, b)), x * y);
    ASSERT_EQ(dyadic(q::product<Integer<A + B + 1>>(a, b)), x * y);
    ASSERT_EQ(q::sign_of(a), x.sign());
    ASSERT_EQ(dyadic(q::negated<Integer<A>>(a)), -x);
    ASSERT_EQ(dyadic(q::magnitude<Integer<A>>(a)).sign(), std::abs(x.sign()));
    ASSERT_EQ(dyadic(q::multiple<Integer<A + 1>>(a, 1234567890123456789)), x * Dyadic(1234567890123456789));
    const int bits = static_cast<int>(engine() % 128);
    ASSERT_EQ(dyadic(q::shifted<Integer<A + 2>>(a, bits)), mul_pow2(x, bits));
  }
}

TEST(Integer, OperationsAreThoseOfExactNumbers) {
  std::mt19937_64 engine(1);
  compare_operations<1, 1>(engine);
  compare_operations<1, 2>(engine);
  compare_operations<2, 1>(engine);
  compare_operations<2, 2>(engine);
  compare_operations<2, 3>(engine);
  compare_operations<3, 3>(engine);
  compare_operations<4, 3>(engine);
  compare_operations<4, 5>(engine);  // products of many words
  compare_operations<1, 13>(engine);
}

TEST(Integer, ProductsWrapAtTheWidthOfTheResult) {
  std::mt19937_64 engine(2);
  for (int n = 0; n < 300; ++n) {  // small values in wide numbers: fewer words than both together hold the product
    const auto a = q::resized<3>(random_integer<1>(engine, 1));
    const auto b = q::resized<2>(random_integer<2>(engine, 2));
    ASSERT_EQ(dyadic(q::product<Integer<3>>(a, b)), dyadic(a) * dyadic(b));
  }
}

/// Whether every input is a multiple of 2^e with e as the doc of scale_inputs says.
template <std::size_t N>
bool fits(const double (&x)[N], int L) {
  double largest = 0;
  for (const double v : x) largest = std::fmax(largest, std::abs(v));
  if (largest == 0) return true;
  const int e = std::ilogb(largest) - (L - 1);
  for (const double v : x) {
    if (v != 0 && Dyadic(v).low_exponent() < e) return false;
  }
  return true;
}

template <int L>
void check_scaling(const double (&x)[3], bool certain_range) {
  Integer<L / 64 + 1> X[3];
  int unit = 0;
  const bool scaled = q::scale_inputs<L>(x, X, unit);
  if (certain_range) {
    ASSERT_EQ(scaled, fits(x, L)) << x[0] << ' ' << x[1] << ' ' << x[2];
  }
  for (int i = 0; scaled && i < 3; ++i) {
    ASSERT_EQ(mul_pow2(dyadic(X[i]), -unit), Dyadic(x[i]));
    ASSERT_LT(abs(DyadicRatio(dyadic(X[i]))), DyadicRatio(mul_pow2(Dyadic(1), L)));
  }
}

TEST(ScaledInputs, AreTheInputsWhereSpansJustFitAndWhereTheyJustDoNot) {
  std::mt19937_64 engine(3);
  for (int top = -1074; top <= 1023; top += 9) {
    const bool certain = top > -900;  // below, 2^-e is beyond the format, and fewer inputs fit
    for (int gap = 0; gap <= 130; ++gap) {
      if (top - gap < -1074) break;
      const double large = std::ldexp(1.0, top), small = -std::ldexp(1.0, top - gap);
      check_scaling<58>({large, small, -0.0}, certain);
      check_scaling<62>({large, small, 0.0}, certain);
      check_scaling<110>({small, large, small}, true);
      check_scaling<126>({small, 0.0, large}, true);
    }
    const double random = std::ldexp(static_cast<double>(engine() >> 11), std::max(top - 53, -1074));
    check_scaling<61>({random, -random, std::ldexp(1.0, std::max(top - 60, -1074))}, false);
    check_scaling<123>({random, -random, std::ldexp(1.0, std::max(top - 122, -1074))}, true);
  }
  check_scaling<61>({0x1p942, 0x1.8p-488, 0.0}, true);  // once took the second for 0: its scaled value underflows
}

TEST(ScaledInputs, RefuseWhatIsNotFinite) {
  const double bad[] = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                        std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::quiet_NaN()};
  for (const double b : bad) {
    const double cases[][3] = {{b, 1, 2}, {1, 2, b}, {0, b, 0}};
    for (const double(&x)[3] : cases) {
      Integer<1> narrow[3];
      Integer<2> wide[3];
      int unit = 0;
      EXPECT_FALSE(q::scale_inputs<61>(x, narrow, unit));
      EXPECT_FALSE(q::scale_inputs<123>(x, wide, unit));
    }
  }
}

/// a + b sqrt(c) for small integers, c the square of r or between squares, against |a| and |b| r compared as integers.
TEST(RootSign, IsThatOfTheSum) {
  using One = Integer<1>;
  const auto number = [](int v) { return q::unit<One>(v); };
  for (int a = -12; a <= 12; ++a) {
    for (int b = -4; b <= 4; ++b) {
      for (int c = 0; c <= 10; ++c) {
        const double value = a + b * std::sqrt(static_cast<double>(c));  // zero or at least 1 / 50 away from it
        const int expected = std::abs(value) < 1e-9 ? 0 : value < 0 ? -1 : 1;
        const int term = c == 0 ? 0 : b;
        EXPECT_EQ(q::sign_of(q::root_sign<One>(number(a), number(term), number(a * a - b * b * c))), expected);
        EXPECT_EQ(q::root_sign<Dyadic>(Dyadic(a), Dyadic(term), Dyadic(a * a - b * b * c)).sign(), expected);
      }
    }
  }
}

TEST(ExactSign, IsNegatedButForInvalid) {
  EXPECT_EQ(-ExactSign::negative, ExactSign::positive);
  EXPECT_EQ(-ExactSign::zero, ExactSign::zero);
  EXPECT_EQ(-ExactSign::invalid, ExactSign::invalid);
  static_assert(!std::is_convertible_v<ExactSign, Sign> && !std::is_convertible_v<ExactSign, bool>);
}

}  // namespace
}  // namespace tightrope
