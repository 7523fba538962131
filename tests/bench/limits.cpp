#include "limits.h"

#include <chrono>
#include <limits>

namespace tightrope::bench {

// limit_kernels.cpp, once for each of them.
const LimitKernels& limit_kernels_scalar();
const LimitKernels& limit_kernels_sse4();
const LimitKernels& limit_kernels_avx2();
const LimitKernels& limit_kernels_avx512();
const LimitKernels& limit_kernels_neon();
const LimitKernels& limit_kernels_avx2_fused();
const LimitKernels& limit_kernels_avx512_fused();
const LimitKernels& limit_kernels_neon_fused();

namespace {

using ccd::InstructionSet;

struct Set {
  InstructionSet instructions;
  bool fused;
  const LimitKernels& (*kernels)();
};
constexpr Set sets[] = {
    {InstructionSet::scalar, false, limit_kernels_scalar},
#if defined(__x86_64__)
    {InstructionSet::sse4, false, limit_kernels_sse4},          {InstructionSet::avx2, false, limit_kernels_avx2},
    {InstructionSet::avx2, true, limit_kernels_avx2_fused},     {InstructionSet::avx512, false, limit_kernels_avx512},
    {InstructionSet::avx512, true, limit_kernels_avx512_fused},
#elif defined(__aarch64__)
    {InstructionSet::neon, false, limit_kernels_neon},
    {InstructionSet::neon, true, limit_kernels_neon_fused},
#endif
};

const LimitKernels* kernels_of(InstructionSet instructions, bool fused) {
  for (const Set& set : sets) {
    if (set.instructions == instructions && set.fused == fused) return &set.kernels();
  }
  return nullptr;
}

/// The kernel whose `call` takes least in relation to `work(kernel)`, the best of three times each.
template <class Kernel, class Call, class Work>
Kernel fastest_of(std::span<const Kernel> kernels, const Call& call, const Work& work) {
  Kernel best = kernels.front();
  double least = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 3; ++round) {
    for (const Kernel& kernel : kernels) {
      const auto start = std::chrono::steady_clock::now();
      call(kernel);
      const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
      if (time.count() / work(kernel) >= least) continue;
      least = time.count() / work(kernel);
      best = kernel;
    }
  }
  return best;
}

volatile double unused;  ///< what loops return, so that they are run

}  // namespace

const LimitKernels* limit_kernels(InstructionSet instructions) { return kernels_of(instructions, false); }
const LimitKernels* fused_limit_kernels(InstructionSet instructions) { return kernels_of(instructions, true); }

ReadKernel fastest(std::span<const ReadKernel> kernels, std::span<const double> numbers) {
  return fastest_of(
      kernels, [&](ReadKernel kernel) { unused = kernel(numbers.data(), numbers.size()); },
      [](ReadKernel) { return 1.0; });
}

template <class Real>
ArithmeticKernel<Real> fastest(std::span<const ArithmeticKernel<Real>> kernels) {
  constexpr std::size_t steps = 20'000;  // 0.1 ms
  return fastest_of(
      kernels, [](const ArithmeticKernel<Real>& kernel) { unused = kernel.run(Real{0.5}, Real{1}, steps); },
      [](const ArithmeticKernel<Real>& kernel) { return static_cast<double>(kernel.operations_per_step()); });
}
template ArithmeticKernel<double> fastest(std::span<const ArithmeticKernel<double>>);
template ArithmeticKernel<float> fastest(std::span<const ArithmeticKernel<float>>);

}  // namespace tightrope::bench
