/// Generated code for vector classes gives every lane the bits that the code for single numbers gives: all operations,
/// stages and State, errors that come in; inputs of every kind, on every instruction set of this machine.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "features.safe.double.h"
#include "features.safe.float.h"
#include "features.tight.double.h"
#include "features.tight.float.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/generated/lanes_test.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <tightrope/highway-inl.h>

HWY_BEFORE_NAMESPACE();
#include "features.safe.double.simd.h"
#include "features.safe.float.simd.h"
#include "features.tight.double.simd.h"
#include "features.tight.float.simd.h"

namespace tightrope::TIGHTROPE_LANES {
namespace {

template <class Real>
constexpr std::size_t lanes = hn::MaxLanes(typename Lanes<Real>::Tag());

/// Inputs: element i of lane j.
template <std::size_t N, class Real>
using Inputs = std::array<std::array<Real, lanes<Real>>, N>;

template <std::size_t N, class Real>
Inputs<N, Real> random_inputs(std::mt19937_64& random) {
  using Limits = std::numeric_limits<Real>;
  const Real special[] = {0,
                          Real(-0.0),
                          1,
                          Limits::infinity(),
                          Limits::quiet_NaN(),
                          Limits::denorm_min(),
                          -std::ldexp(Real(1), Limits::max_exponent - 24)};
  Inputs<N, Real> inputs;
  for (auto& element : inputs) {
    for (Real& x : element) {
      x = static_cast<Real>(
          std::ldexp(static_cast<double>(random()) * 0x1p-63 - 1, static_cast<int>(random() % 8) - 4));
      if (random() % 40 == 0) x = special[random() % std::size(special)];
    }
  }
  return inputs;
}

template <class Real, std::size_t N>
std::array<Lanes<Real>, N> in_lanes(const std::array<std::array<Real, lanes<Real>>, N>& inputs) {
  std::array<Lanes<Real>, N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = hn::LoadU(typename Lanes<Real>::Tag(), inputs[i].data());
  return result;
}

template <class Real, std::size_t N>
std::array<Real, N> of_lane(const std::array<std::array<Real, lanes<Real>>, N>& inputs, std::size_t lane) {
  std::array<Real, N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = inputs[i][lane];
  return result;
}

/// Results are nothing but numbers, the same ones in the same order in both forms.
template <class Real, class LanesResult, class Result>
void expect_same(const LanesResult& in_lanes, const Result& single, std::size_t lane) {
  static_assert(sizeof(LanesResult) / sizeof(Lanes<Real>) == sizeof(Result) / sizeof(Real));
  constexpr std::size_t count = sizeof(Result) / sizeof(Real);
  std::array<Real, count * lanes<Real>> all;
  std::array<Real, count> expected;
  std::memcpy(all.data(), &in_lanes, sizeof(all));
  std::memcpy(expected.data(), &single, sizeof(expected));
  for (std::size_t i = 0; i < count; ++i) {
    const Real x = all[i * lanes<Real> + lane];
    ASSERT_TRUE((std::isnan(x) && std::isnan(expected[i])) || std::memcmp(&x, &expected[i], sizeof(x)) == 0)
        << "number " << i << ", lane " << lane << ": " << x << ", not " << expected[i];
  }
}

template <class Bound, class Real>
void compare_quotients(std::mt19937_64& random) {
  const auto inputs = random_inputs<9, Real>(random);
  const auto x = in_lanes<Real>(inputs);
  const Bounded<Lanes<Real>> k{x[6], magnitude(x[8])};
  using Wide = quotients<Bound, Real>;
  typename Wide::State state;
  const auto ratios = Wide::ratios(&x[0], &x[2], &x[4], k, x[7], state);
  const auto roots = Wide::roots(&x[0], &x[2], &x[4], k, x[7], state);
  const auto fused = Wide::fused(&x[0], &x[2], &x[4], k, x[7], state);
  for (std::size_t lane = 0; lane < lanes<Real>; ++lane) {
    const auto y = of_lane<Real>(inputs, lane);
    using Single = generated::quotients<Bound, Real>;
    typename Single::State single;
    const Bounded<Real> bounded{y[6], std::fabs(y[8])};
    expect_same<Real>(ratios, Single::ratios(&y[0], &y[2], &y[4], bounded, y[7], single), lane);
    expect_same<Real>(roots, Single::roots(&y[0], &y[2], &y[4], bounded, y[7], single), lane);
    expect_same<Real>(fused, Single::fused(&y[0], &y[2], &y[4], bounded, y[7], single), lane);
  }
}

template <class Bound, class Real>
void compare_bounded_inputs(std::mt19937_64& random) {
  const auto inputs = random_inputs<21, Real>(random);
  const auto x = in_lanes<Real>(inputs);
  std::array<Bounded<Lanes<Real>>, 10> pairs;
  for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = {x[2 * i], magnitude(x[2 * i + 1])};
  using Wide = bounded_inputs<Bound, Real>;
  typename Wide::State state;
  const auto one = Wide::one(&pairs[0], &pairs[3], &pairs[6], x[20], state);
  const auto two = Wide::two(&pairs[0], &pairs[3], &pairs[6], x[20], state);
  for (std::size_t lane = 0; lane < lanes<Real>; ++lane) {
    const auto y = of_lane<Real>(inputs, lane);
    std::array<Bounded<Real>, 10> single_pairs;
    for (std::size_t i = 0; i < pairs.size(); ++i) single_pairs[i] = {y[2 * i], std::fabs(y[2 * i + 1])};
    const auto* const p = single_pairs.data();
    using Single = generated::bounded_inputs<Bound, Real>;
    typename Single::State single;
    expect_same<Real>(one, Single::one(p, p + 3, p + 6, y[20], single), lane);
    expect_same<Real>(two, Single::two(p, p + 3, p + 6, y[20], single), lane);
  }
}

/// Stages with a declared range: the form without the test of it, on inputs within.
template <class Bound, class Real>
void compare_stages(std::mt19937_64& random) {
  const auto inputs = random_inputs<18, Real>(random);
  const auto x = in_lanes<Real>(inputs);
  using Wide = stages<Bound, Real>;
  typename Wide::State state;
  const auto first = Wide::first_in_range(&x[0], &x[3], &x[6], &x[9], &x[12], &x[15], state);
  const auto second = Wide::second_in_range(&x[0], &x[3], &x[6], &x[9], &x[12], &x[15], state);
  const auto third = Wide::third_in_range(&x[0], &x[3], &x[6], &x[9], &x[12], &x[15], state);
  for (std::size_t lane = 0; lane < lanes<Real>; ++lane) {
    const auto y = of_lane<Real>(inputs, lane);
    using Single = generated::stages<Bound, Real>;
    typename Single::State single;
    expect_same<Real>(first, Single::first_in_range(&y[0], &y[3], &y[6], &y[9], &y[12], &y[15], single), lane);
    expect_same<Real>(second, Single::second_in_range(&y[0], &y[3], &y[6], &y[9], &y[12], &y[15], single), lane);
    expect_same<Real>(third, Single::third_in_range(&y[0], &y[3], &y[6], &y[9], &y[12], &y[15], single), lane);
  }
}

/// Arguments that are products: each is rounded before the predicate begins, although this file is compiled with
/// contraction.
template <class Bound, class Real>
void compare_products(std::mt19937_64& random) {
  const auto factors = random_inputs<16, Real>(random);
  const auto x = in_lanes<Real>(factors);
  std::array<Lanes<Real>, 8> products;
  for (std::size_t i = 0; i < products.size(); ++i) products[i] = hn::Mul(x[2 * i].v, x[2 * i + 1].v);
  const auto side = incircle<Bound, Real>::evaluate(&products[0], &products[2], &products[4], &products[6]);
  for (std::size_t lane = 0; lane < lanes<Real>; ++lane) {
    const auto y = of_lane<Real>(factors, lane);
    std::array<Real, 8> rounded;
    for (std::size_t i = 0; i < rounded.size(); ++i) {
      const volatile Real product = y[2 * i] * y[2 * i + 1];
      rounded[i] = product;
    }
    using Single = generated::incircle<Bound, Real>;
    expect_same<Real>(side, Single::evaluate(&rounded[0], &rounded[2], &rounded[4], &rounded[6]), lane);
  }
}

template <class Bound, class Real>
void compare_all() {
  std::mt19937_64 random(3);
  for (int round = 0; round < 1500; ++round) {
    compare_quotients<Bound, Real>(random);
    compare_bounded_inputs<Bound, Real>(random);
    compare_stages<Bound, Real>(random);
    compare_products<Bound, Real>(random);
  }
}

}  // namespace

void compare_generated() {
  compare_all<bound::safe, double>();
  compare_all<bound::safe, float>();
  compare_all<bound::tight, double>();
  compare_all<bound::tight, float>();
}

}  // namespace tightrope::TIGHTROPE_LANES
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
