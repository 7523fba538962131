/// The range probe: the same few points at scales from 1e-300 to 1e200, where products leave the exponent range and
/// error bounds that were derived without it fail.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "circles.exact.double.h"
#include "circles.staged.double.h"
#include "circles.tight.double.h"
#include "exact_determinant.h"
#include "orientation.exact.double.h"
#include "orientation.safe.double.h"
#include "orientation.staged.double.h"
#include "orientation.tight.double.h"

namespace tightrope::testing {
namespace {

constexpr int scale = 1074;  // every double is a multiple of 2^-1074

int number(ExactSign s) { return static_cast<int>(s); }

void expect_orientation(const Point<3>& a, const Point<3>& b, const Point<3>& c, const Point<3>& d) {
  const Point<3> points[] = {a, b, c, d};
  const int truth = sign_of_determinant<3>(points, false, scale);
  using generated::orient3d;
  const auto evaluate = [&]<class B>(B) {
    return orient3d<B, double>::evaluate(a.data(), b.data(), c.data(), d.data()).volume;
  };
  ASSERT_EQ(number(evaluate(bound::staged{})), truth) << a[0] << ' ' << a[1] << ' ' << a[2];
  ASSERT_EQ(number(evaluate(bound::exact{})), truth);
  for (const Sign s : {sign(evaluate(bound::safe{})), sign(evaluate(bound::tight{}))}) {
    ASSERT_TRUE(s == Sign::uncertain || static_cast<int>(s) == truth);
  }
}

TEST(RangeProbe, TetrahedraFrom1eMinus300To1e200) {
  for (int exponent = -300; exponent <= 200; ++exponent) {
    const double s = std::pow(10.0, exponent);
    const Point<3> o = {0, 0, 0}, x = {s, 0, 0}, y = {0, s, 0}, z = {0, 0, s};
    expect_orientation(x, y, z, o);
    expect_orientation(y, x, z, o);
    expect_orientation(x, y, {s, s, 0}, o);                                      // flat
    expect_orientation(x, y, {s, s, std::nextafter(0.0, 1.0)}, o);               // flat but for the smallest number
    expect_orientation({s, 2 * s, 3 * s}, {2 * s, 4 * s, 6 * s}, z, o);          // collinear with the origin
    expect_orientation({s, 1, 1}, {1, s, 1}, {1, 1, s}, {s, s, s});              // of two magnitudes
    expect_orientation({s, s, s}, {1 / s, s, 1}, {1, 1 / s, s}, {s, 1 / s, 1});  // of three
  }
}

TEST(RangeProbe, TetrahedraOfMixedMagnitudes) {
  std::mt19937_64 random(5);
  std::uniform_int_distribution<int> exponent(-1074, 1023);
  std::uniform_int_distribution<int> digit(-4, 4);
  for (int i = 0; i < 20'000; ++i) {
    Point<3> p[4];
    const int common = exponent(random);
    for (auto& point : p) {
      for (double& x : point) x = std::ldexp(digit(random), i % 2 == 0 ? std::min(common, 1020) : exponent(random) - 3);
    }
    expect_orientation(p[0], p[1], p[2], p[3]);
  }
}

TEST(RangeProbe, SpheresFrom1eMinus300To1e200) {
  using generated::insphere;
  for (int exponent = -300; exponent <= 200; exponent += 5) {
    const double s = std::pow(10.0, exponent);
    for (const double t : {0.5 * s, s, std::nextafter(s, 0.0), std::nextafter(s, 2 * s)}) {
      const Point<3> points[] = {{0, 0, 0}, {s, 0, 0}, {0, s, 0}, {0, 0, s}, {t, t, s}};
      const int truth = sign_of_determinant<3>(points, true, scale);
      const auto evaluate = [&]<class B>(B) {
        return insphere<B, double>::evaluate(points[0].data(), points[1].data(), points[2].data(), points[3].data(),
                                             points[4].data())
            .inside;
      };
      ASSERT_EQ(number(evaluate(bound::staged{})), truth) << s << ' ' << t;
      ASSERT_EQ(number(evaluate(bound::exact{})), truth);
      const Sign tight = sign(evaluate(bound::tight{}));
      ASSERT_TRUE(tight == Sign::uncertain || static_cast<int>(tight) == truth);
    }
  }
}

TEST(RangeProbe, NoSignForWhatIsNoNumber) {
  const Point<3> o = {0, 0, 0}, x = {1, 0, 0}, y = {0, 1, 0};
  for (const double bad : {HUGE_VAL, -HUGE_VAL, std::nan("")}) {
    const Point<3> z = {0, 0, bad};
    using generated::orient3d;
    const auto evaluate = [&]<class B>(B) {
      return orient3d<B, double>::evaluate(x.data(), y.data(), z.data(), o.data()).volume;
    };
    EXPECT_EQ(evaluate(bound::staged{}), ExactSign::invalid);
    EXPECT_EQ(evaluate(bound::exact{}), ExactSign::invalid);
    EXPECT_EQ(sign(evaluate(bound::safe{})), Sign::uncertain);
    EXPECT_EQ(sign(evaluate(bound::tight{})), Sign::uncertain);
  }
}

}  // namespace
}  // namespace tightrope::testing
