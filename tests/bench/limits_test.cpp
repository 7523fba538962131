/// The loops that measure physical limits do all of the work that they are given credit for, and round as they say.

#include "limits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <span>
#include <vector>

namespace tightrope::bench {
namespace {

using ccd::InstructionSet;

TEST(ReadKernels, ReadEveryNumberOnce) {
  std::vector<double> numbers(5 * read_granularity);
  std::iota(numbers.begin(), numbers.end(), 1.0);  // sums of them are exact, in any order
  const double sum = static_cast<double>(numbers.size()) * static_cast<double>(numbers.size() + 1) / 2;
  for (const InstructionSet instructions : ccd::instruction_sets()) {
    const LimitKernels* kernels = limit_kernels(instructions);
    ASSERT_NE(kernels, nullptr) << ccd::name(instructions);
    for (const ReadKernel read : kernels->reads) {
      EXPECT_EQ(read(numbers.data(), numbers.size()), sum) << ccd::name(instructions);
    }
  }
}

/// What the kernel is said to compute, each product rounded or, `fused`, not.
template <class Real>
Real expected(const ArithmeticKernel<Real>& kernel, Real factor, Real term, std::size_t steps, bool fused) {
  Real sum = 0;
  for (std::size_t chain = 0; chain < kernel.chains; ++chain) {
    Real x = term + static_cast<Real>(chain);
    for (std::size_t step = 0; step < steps; ++step) {
      if (fused) {
        x = std::fma(x, factor, term);
      } else {
        x = x * factor;
        x = x + term;
      }
    }
    Real lanes = 0;
    for (std::size_t lane = 0; lane < kernel.lanes; ++lane) lanes += x;
    sum += lanes;
  }
  return sum;
}

template <class Real>
void expect_arithmetic(std::span<const ArithmeticKernel<Real>> kernels, bool fused) {
  const Real factor = Real{-11} / 10, term = Real{1} / 3;  // every product is rounded, and no error fades
  constexpr std::size_t steps = 101;
  std::size_t unlike = 0;
  for (const ArithmeticKernel<Real>& kernel : kernels) {
    const Real result = kernel.run(factor, term, steps);
    EXPECT_EQ(result, expected(kernel, factor, term, steps, fused)) << kernel.lanes << " lanes, " << kernel.chains;
    EXPECT_NE(result, expected(kernel, factor, term, steps - 1, fused));
    unlike += result != expected(kernel, factor, term, steps, !fused) ? 1 : 0;  // sums may agree by chance
  }
  EXPECT_GT(unlike, kernels.size() / 2) << "fused and separate operations cannot be told apart";
}

TEST(ArithmeticKernels, DoEveryStepAndRoundAsTheySay) {
  for (const InstructionSet instructions : ccd::instruction_sets()) {
    SCOPED_TRACE(ccd::name(instructions));
    for (const bool fused : {false, true}) {
      const LimitKernels* kernels = fused ? fused_limit_kernels(instructions) : limit_kernels(instructions);
      if (kernels == nullptr) continue;
      SCOPED_TRACE(fused ? "fused" : "separate");
      expect_arithmetic(kernels->doubles, fused);
      expect_arithmetic(kernels->floats, fused);
    }
  }
}

}  // namespace
}  // namespace tightrope::bench
