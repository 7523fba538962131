#pragma once
/// What a machine can do at most, as loops to be timed: reading memory, products and sums. One set of loops for each
/// instruction set, with its width of vectors, each loop in several unrollings of which the fastest counts.

#include <cstddef>
#include <span>

#include "tightrope/batch.h"

namespace tightrope::bench {

/// Reads `count` numbers once, front to back, and returns their sum; `count` a multiple of `read_granularity`, the
/// memory aligned to 64 bytes.
using ReadKernel = double (*)(const double* numbers, std::size_t count);
inline constexpr std::size_t read_granularity = 1024;

/// `chains` vectors of `lanes` numbers, vector i of which begins as term + i, x = x * factor + term in `steps` steps.
/// Returns the sum of all: the lanes of each vector, then the vectors.
template <class Real>
struct ArithmeticKernel {
  Real (*run)(Real factor, Real term, std::size_t steps);
  std::size_t lanes, chains;
  std::size_t operations_per_step() const { return 2 * lanes * chains; }
};

/// The loops of one instruction set.
struct LimitKernels {
  std::span<const ReadKernel> reads;
  std::span<const ArithmeticKernel<double>> doubles;
  std::span<const ArithmeticKernel<float>> floats;
};

/// None of an instruction set that this build has no loops for. Call them only where the machine can run them.
const LimitKernels* limit_kernels(ccd::InstructionSet instructions);
/// With a product and the sum that it feeds fused into one operation (which counts as two); none where the instruction
/// set has no such operation.
const LimitKernels* fused_limit_kernels(ccd::InstructionSet instructions);

/// The kernel that is fastest on this machine just now, on `numbers`.
ReadKernel fastest(std::span<const ReadKernel> kernels, std::span<const double> numbers);
template <class Real>
ArithmeticKernel<Real> fastest(std::span<const ArithmeticKernel<Real>> kernels);

}  // namespace tightrope::bench
