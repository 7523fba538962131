/// Every operation of vector classes gives each lane the bits of the single number's (runtime/tightrope/highway-inl.h),
/// on every instruction set of this machine.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "tightrope/arithmetic.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/unit/batch/lanes_test.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

namespace tightrope::test {
#ifndef TIGHTROPE_TEST_NUMBERS
#define TIGHTROPE_TEST_NUMBERS

/// Numbers of every kind; the first are pairs of special ones.
template <class Real>
Real any_number(std::mt19937_64& random) {
  using Limits = std::numeric_limits<Real>;
  const Real special[] = {0,
                          Real(-0.0),
                          1,
                          -1,
                          Limits::infinity(),
                          -Limits::infinity(),
                          Limits::quiet_NaN(),
                          Limits::max(),
                          -Limits::max(),
                          Limits::min(),
                          -Limits::min(),
                          Limits::denorm_min()};
  if (random() % 3 == 0) return special[random() % std::size(special)];
  const Real x = static_cast<Real>(random()) * static_cast<Real>(random() % 2 == 0 ? 1 : -1);
  const int range = random() % 2 == 0 ? 4 : Limits::max_exponent;
  return std::ldexp(x, static_cast<int>(random() % static_cast<unsigned>(2 * range)) - range - 64);
}

/// The same number: equal bits, or both NaN.
template <class Real>
bool same(Real a, Real b) {
  return (std::isnan(a) && std::isnan(b)) || std::memcmp(&a, &b, sizeof(Real)) == 0;
}

#endif
}  // namespace tightrope::test

#include "tightrope/highway-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tightrope::TIGHTROPE_LANES {
namespace {

/// Compares `op` of the lanes of random triples with `op` of the numbers.
template <class Real, class Op>
HWY_NOINLINE void compare(const char* what, const Op& op) {
  using L = Lanes<Real>;
  constexpr std::size_t lanes = hn::MaxLanes(typename L::Tag());
  std::mt19937_64 random(5);
  for (int round = 0; round < 4000; ++round) {
    HWY_ALIGN Real a[lanes], b[lanes], c[lanes], result[lanes];
    for (std::size_t i = 0; i < lanes; ++i) {
      a[i] = test::any_number<Real>(random);
      b[i] = random() % 8 == 0 ? a[i] : test::any_number<Real>(random);
      c[i] = test::any_number<Real>(random);
    }
    const L in_lanes =
        op(L(hn::Load(typename L::Tag(), a)), L(hn::Load(typename L::Tag(), b)), L(hn::Load(typename L::Tag(), c)));
    hn::Store(in_lanes.v, typename L::Tag(), result);
    for (std::size_t i = 0; i < lanes; ++i) {
      ASSERT_TRUE(test::same(result[i], Real(op(a[i], b[i], c[i]))))
          << what << ' ' << a[i] << ' ' << b[i] << ' ' << c[i];
    }
  }
}

template <class Real>
void compare_all() {
  compare<Real>("+", [](auto a, auto b, auto) HWY_ATTR { return a + b; });
  compare<Real>("-", [](auto a, auto b, auto) HWY_ATTR { return a - b; });
  compare<Real>("/", [](auto a, auto b, auto) HWY_ATTR { return a / b; });
  compare<Real>("negation", [](auto a, auto, auto) HWY_ATTR { return -a; });
  compare<Real>("product", [](auto a, auto b, auto) HWY_ATTR { return product(a, b); });
  compare<Real>("unfused sum of products",
                [](auto a, auto b, auto c) HWY_ATTR { return product(a, b) + product(b, c); });
  compare<Real>("magnitude", [](auto a, auto, auto) HWY_ATTR { return magnitude(a); });
  compare<Real>("minimum", [](auto a, auto b, auto) HWY_ATTR { return minimum(a, b); });
  compare<Real>("maximum", [](auto a, auto b, auto) HWY_ATTR { return maximum(a, b); });
  compare<Real>("max_magnitude",
                [](auto a, auto b, auto) HWY_ATTR { return max_magnitude(magnitude(a), magnitude(b)); });
  compare<Real>("certain_nonzero", [](auto a, auto b, auto) HWY_ATTR { return certain_nonzero(a, magnitude(b)); });
  compare<Real>("certain_nonnegative",
                [](auto a, auto b, auto) HWY_ATTR { return certain_nonnegative(a, magnitude(b)); });
  compare<Real>("choose", [](auto a, auto b, auto c) HWY_ATTR { return choose(a, b, c); });
  compare<Real>("square_root", [](auto a, auto, auto) HWY_ATTR { return square_root(magnitude(a)); });
  compare<Real>("normalizer", [](auto a, auto, auto) HWY_ATTR { return normalizer(magnitude(a)); });
  compare<Real>("multiply_add", [](auto a, auto b, auto c) HWY_ATTR { return multiply_add(a, b, c); });
}

}  // namespace

void compare_lanes() {
  compare_all<double>();
  compare_all<float>();
}

}  // namespace tightrope::TIGHTROPE_LANES
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tightrope::lanes {

HWY_EXPORT(compare_lanes);

TEST(HighwayLanes, ComputeAsSingleNumbers) {
  int sets = 0;
  for (std::int64_t targets = hwy::SupportedTargets() & HWY_TARGETS; targets != 0; targets &= targets - 1) {
    hwy::SetSupportedTargetsForTest(targets & -targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    SCOPED_TRACE(hwy::TargetName(targets & -targets));
    HWY_DYNAMIC_DISPATCH(compare_lanes)();
    ++sets;
  }
  hwy::SetSupportedTargetsForTest(0);
  EXPECT_GE(sets, 1);
}

}  // namespace tightrope::lanes
#endif
