#include <gtest/gtest.h>
#include <tightrope/sign.h>

#include <cmath>
#include <limits>

namespace tightrope {
namespace {

template <class Real>
class SignOf : public ::testing::Test {};
using Reals = ::testing::Types<double, float>;
TYPED_TEST_SUITE(SignOf, Reals);

TYPED_TEST(SignOf, IsDefiniteOnlyBeyondTheBound) {
  using Real = TypeParam;
  const Real value = Real(0.375), above = std::nextafter(value, Real(1)), below = std::nextafter(value, Real(0));
  EXPECT_EQ(sign(Bounded<Real>{value, below}), Sign::positive);
  EXPECT_EQ(sign(Bounded<Real>{value, value}), Sign::uncertain);  // the exact value may be 0
  EXPECT_EQ(sign(Bounded<Real>{value, above}), Sign::uncertain);
  EXPECT_EQ(sign(Bounded<Real>{-value, below}), Sign::negative);
  EXPECT_EQ(sign(Bounded<Real>{-value, value}), Sign::uncertain);
  EXPECT_EQ(sign(Bounded<Real>{std::numeric_limits<Real>::denorm_min(), 0}), Sign::positive);
}

TYPED_TEST(SignOf, AnExactZeroHasNoSign) {
  using Real = TypeParam;
  EXPECT_EQ(sign(Bounded<Real>{0, 0}), Sign::uncertain);
  EXPECT_EQ(sign(Bounded<Real>{Real(-0.0), 0}), Sign::uncertain);
}

TYPED_TEST(SignOf, IsUncertainForNaNAndInfiniteBounds) {
  using Real = TypeParam;
  const Real nan = std::numeric_limits<Real>::quiet_NaN(), inf = std::numeric_limits<Real>::infinity();
  for (const Real x : {Real(0), Real(1), Real(-1), inf, -inf, nan}) {
    EXPECT_EQ(sign(Bounded<Real>{nan, x}), Sign::uncertain) << x;
    EXPECT_EQ(sign(Bounded<Real>{x, nan}), Sign::uncertain) << x;
    EXPECT_EQ(sign(Bounded<Real>{x, inf}), Sign::uncertain) << x;
  }
}

TYPED_TEST(SignOf, IsUncertainForWhatWasMadeUncertain) {
  using Real = TypeParam;
  Bounded<Real> single = {1, 0}, table[2][3] = {{{1, 0}, {2, 0}, {3, 0}}, {{-1, 0}, {-2, 0}, {-3, 0}}};
  make_uncertain(single);
  make_uncertain(table);
  EXPECT_EQ(sign(single), Sign::uncertain);
  for (const auto& row : table) {
    for (const Bounded<Real>& x : row) {
      EXPECT_EQ(sign(x), Sign::uncertain);
      EXPECT_TRUE(std::isnan(x.value) && std::isinf(x.bound));
    }
  }
}

TEST(Sign, NegationSwapsDefiniteSigns) {
  EXPECT_EQ(-Sign::positive, Sign::negative);
  EXPECT_EQ(-Sign::negative, Sign::positive);
  EXPECT_EQ(-Sign::uncertain, Sign::uncertain);
}

TYPED_TEST(SignOf, MinimumAndMaximumPropagateNaN) {
  using Real = TypeParam;
  const Real nan = std::numeric_limits<Real>::quiet_NaN(), inf = std::numeric_limits<Real>::infinity();
  for (const Real x : {Real(0), Real(3), -inf, inf, nan}) {
    EXPECT_TRUE(std::isnan(minimum(x, nan))) << x;
    EXPECT_TRUE(std::isnan(minimum(nan, x))) << x;
    EXPECT_TRUE(std::isnan(maximum(x, nan))) << x;
    EXPECT_TRUE(std::isnan(maximum(nan, x))) << x;
  }
  EXPECT_EQ(minimum(Real(2), Real(-3)), Real(-3));
  EXPECT_EQ(maximum(Real(2), Real(-3)), Real(2));
  EXPECT_EQ(minimum(-inf, inf), -inf);
  EXPECT_EQ(maximum(-inf, inf), inf);
  EXPECT_EQ(maximum(Real(2), Real(2)), Real(2));
}

TYPED_TEST(SignOf, MagnitudeClearsTheSignBit) {
  using Real = TypeParam;
  EXPECT_EQ(magnitude(Real(-2.5)), Real(2.5));
  EXPECT_FALSE(std::signbit(magnitude(Real(-0.0))));
  EXPECT_EQ(magnitude(-std::numeric_limits<Real>::infinity()), std::numeric_limits<Real>::infinity());
  EXPECT_EQ(magnitude(-std::numeric_limits<Real>::denorm_min()), std::numeric_limits<Real>::denorm_min());
}

TYPED_TEST(SignOf, MaximumOfMagnitudesIsTheLargerNumber) {
  using Real = TypeParam;
  EXPECT_EQ(max_magnitude(Real(1), Real(2)), Real(2));
  EXPECT_EQ(max_magnitude(Real(2), Real(1)), Real(2));
  EXPECT_EQ(max_magnitude(Real(2), std::numeric_limits<Real>::infinity()), std::numeric_limits<Real>::infinity());
}

TYPED_TEST(SignOf, GuardsLetPassWhatIsCertainOnly) {
  using Real = TypeParam;
  const Real nan = std::numeric_limits<Real>::quiet_NaN();
  EXPECT_EQ(certain_nonzero(Real(-3), Real(2)), Real(-3));
  EXPECT_TRUE(std::isnan(certain_nonzero(Real(-3), Real(3))));
  EXPECT_TRUE(std::isnan(certain_nonzero(Real(0), Real(0))));
  EXPECT_TRUE(std::isnan(certain_nonzero(Real(1), nan)));
  EXPECT_TRUE(std::isnan(certain_nonzero(nan, Real(0))));
  EXPECT_EQ(certain_nonnegative(Real(3), Real(3)), Real(3));
  EXPECT_EQ(certain_nonnegative(Real(0), Real(0)), Real(0));
  EXPECT_TRUE(std::isnan(certain_nonnegative(Real(3), Real(4))));
  EXPECT_TRUE(std::isnan(certain_nonnegative(Real(-3), Real(0))));
  EXPECT_TRUE(std::isnan(certain_nonnegative(Real(3), nan)));
}

TYPED_TEST(SignOf, ANaNDoesNotWipeOutTheMaximumOfMagnitudesBeforeIt) {
  using Real = TypeParam;
  const Real nan = std::numeric_limits<Real>::quiet_NaN();
  EXPECT_EQ(max_magnitude(max_magnitude(Real(8), nan), Real(1)), Real(8));
  EXPECT_TRUE(std::isnan(max_magnitude(nan, Real(1))));
}

}  // namespace
}  // namespace tightrope
