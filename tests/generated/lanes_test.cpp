/// Generated code for vector classes gives every lane the bits that the code for single numbers gives: all operations,
/// stages and State, errors that come in; inputs of every kind, on every instruction set of this machine.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "features.tight.double.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/generated/lanes_test.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR
#include <tightrope/highway-inl.h>

#include "features.tight.double.simd.h"

namespace tightrope::TIGHTROPE_LANES {
namespace {

constexpr std::size_t lanes = hn::MaxLanes(Lanes<double>::Tag());

/// Inputs: element i of lane j.
template <std::size_t N>
using Inputs = std::array<std::array<double, lanes>, N>;

template <std::size_t N>
Inputs<N> random_inputs(std::mt19937_64& random) {
  const double special[] = {0, -0.0, 1, HUGE_VAL, std::nan(""), 0x1p-1074, -0x1p1000};
  Inputs<N> inputs;
  for (auto& element : inputs) {
    for (double& x : element) {
      x = std::ldexp(static_cast<double>(random()) * 0x1p-63 - 1, static_cast<int>(random() % 8) - 4);
      if (random() % 40 == 0) x = special[random() % std::size(special)];
    }
  }
  return inputs;
}

template <std::size_t N>
std::array<Lanes<double>, N> in_lanes(const Inputs<N>& inputs) {
  std::array<Lanes<double>, N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = hn::LoadU(Lanes<double>::Tag(), inputs[i].data());
  return result;
}

template <std::size_t N>
std::array<double, N> of_lane(const Inputs<N>& inputs, std::size_t lane) {
  std::array<double, N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = inputs[i][lane];
  return result;
}

/// Results are nothing but numbers, the same ones in the same order in both forms.
template <class LanesResult, class Result>
void expect_same(const LanesResult& in_lanes, const Result& single, std::size_t lane) {
  static_assert(sizeof(LanesResult) / sizeof(Lanes<double>) == sizeof(Result) / sizeof(double));
  constexpr std::size_t count = sizeof(Result) / sizeof(double);
  std::array<double, count * lanes> all;
  std::array<double, count> expected;
  std::memcpy(all.data(), &in_lanes, sizeof(all));
  std::memcpy(expected.data(), &single, sizeof(expected));
  for (std::size_t i = 0; i < count; ++i) {
    const double x = all[i * lanes + lane];
    ASSERT_TRUE((std::isnan(x) && std::isnan(expected[i])) || std::memcmp(&x, &expected[i], sizeof(x)) == 0)
        << "number " << i << ", lane " << lane << ": " << x << ", not " << expected[i];
  }
}

using bound::tight;

void compare_quotients(std::mt19937_64& random) {
  const auto inputs = random_inputs<9>(random);
  const auto x = in_lanes(inputs);
  const Bounded<Lanes<double>> k{x[6], magnitude(x[8])};
  using Wide = quotients<tight, double>;
  Wide::State state;
  const auto ratios = Wide::ratios(&x[0], &x[2], &x[4], k, x[7], state);
  const auto roots = Wide::roots(&x[0], &x[2], &x[4], k, x[7], state);
  const auto fused = Wide::fused(&x[0], &x[2], &x[4], k, x[7], state);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const auto y = of_lane(inputs, lane);
    using Single = generated::quotients<tight, double>;
    Single::State single;
    const Bounded<double> bounded{y[6], std::fabs(y[8])};
    expect_same(ratios, Single::ratios(&y[0], &y[2], &y[4], bounded, y[7], single), lane);
    expect_same(roots, Single::roots(&y[0], &y[2], &y[4], bounded, y[7], single), lane);
    expect_same(fused, Single::fused(&y[0], &y[2], &y[4], bounded, y[7], single), lane);
  }
}

void compare_bounded_inputs(std::mt19937_64& random) {
  const auto inputs = random_inputs<21>(random);
  const auto x = in_lanes(inputs);
  std::array<Bounded<Lanes<double>>, 10> pairs;
  for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = {x[2 * i], magnitude(x[2 * i + 1])};
  using Wide = bounded_inputs<tight, double>;
  Wide::State state;
  const auto one = Wide::one(&pairs[0], &pairs[3], &pairs[6], x[20], state);
  const auto two = Wide::two(&pairs[0], &pairs[3], &pairs[6], x[20], state);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const auto y = of_lane(inputs, lane);
    std::array<Bounded<double>, 10> single_pairs;
    for (std::size_t i = 0; i < pairs.size(); ++i) single_pairs[i] = {y[2 * i], std::fabs(y[2 * i + 1])};
    const auto* const p = single_pairs.data();
    using Single = generated::bounded_inputs<tight, double>;
    Single::State single;
    expect_same(one, Single::one(p, p + 3, p + 6, y[20], single), lane);
    expect_same(two, Single::two(p, p + 3, p + 6, y[20], single), lane);
  }
}

/// Stages with a declared range: the form without the test of it, on inputs within.
void compare_stages(std::mt19937_64& random) {
  const auto inputs = random_inputs<18>(random);
  const auto x = in_lanes(inputs);
  using Wide = stages<tight, double>;
  Wide::State state;
  const auto first = Wide::first_in_range(&x[0], &x[3], &x[6], &x[9], &x[12], &x[15], state);
  const auto second = Wide::second_in_range(&x[0], &x[3], &x[6], &x[9], &x[12], &x[15], state);
  const auto third = Wide::third_in_range(&x[0], &x[3], &x[6], &x[9], &x[12], &x[15], state);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const auto y = of_lane(inputs, lane);
    using Single = generated::stages<tight, double>;
    Single::State single;
    expect_same(first, Single::first_in_range(&y[0], &y[3], &y[6], &y[9], &y[12], &y[15], single), lane);
    expect_same(second, Single::second_in_range(&y[0], &y[3], &y[6], &y[9], &y[12], &y[15], single), lane);
    expect_same(third, Single::third_in_range(&y[0], &y[3], &y[6], &y[9], &y[12], &y[15], single), lane);
  }
}

/// Arguments that are products: each is rounded before the predicate begins, although this file is compiled with
/// contraction.
void compare_products(std::mt19937_64& random) {
  const auto factors = random_inputs<16>(random);
  const auto x = in_lanes(factors);
  std::array<Lanes<double>, 8> products;
  for (std::size_t i = 0; i < products.size(); ++i) products[i] = hn::Mul(x[2 * i].v, x[2 * i + 1].v);
  const auto side = incircle<tight, double>::evaluate(&products[0], &products[2], &products[4], &products[6]);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const auto y = of_lane(factors, lane);
    std::array<double, 8> rounded;
    for (std::size_t i = 0; i < rounded.size(); ++i) {
      const volatile double product = y[2 * i] * y[2 * i + 1];
      rounded[i] = product;
    }
    expect_same(side, generated::incircle<tight, double>::evaluate(&rounded[0], &rounded[2], &rounded[4], &rounded[6]),
                lane);
  }
}

}  // namespace

void compare_generated() {
  std::mt19937_64 random(3);
  for (int round = 0; round < 3000; ++round) {
    compare_quotients(random);
    compare_bounded_inputs(random);
    compare_stages(random);
    compare_products(random);
  }
}

}  // namespace tightrope::TIGHTROPE_LANES
#else
namespace tightrope::lanes::HWY_NAMESPACE {
void compare_generated() {}
}  // namespace tightrope::lanes::HWY_NAMESPACE
#endif
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tightrope::lanes {

HWY_EXPORT(compare_generated);

TEST(GeneratedLanes, GiveTheBitsOfSingleNumbers) {
  for (std::int64_t targets = hwy::SupportedTargets() & HWY_TARGETS; targets != 0; targets &= targets - 1) {
    hwy::SetSupportedTargetsForTest(targets & -targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    SCOPED_TRACE(hwy::TargetName(targets & -targets));
    HWY_DYNAMIC_DISPATCH(compare_generated)();
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace tightrope::lanes
#endif
