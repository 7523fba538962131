#pragma once
/// The methods are one algorithm for processors and GPUs: compiled by nvcc their functions are there on both sides.

#if defined(__CUDACC__)
#define TIGHTROPE_HOST_DEVICE __host__ __device__
#else
#define TIGHTROPE_HOST_DEVICE
#endif

/// Not inlined on the host: what precedes it settles nearly every query and then needs few registers and no frame. On a
/// device a kernel of its own does the same.
#if defined(__CUDA_ARCH__)
#define TIGHTROPE_RARE TIGHTROPE_HOST_DEVICE
#else
#define TIGHTROPE_RARE [[gnu::noinline]] TIGHTROPE_HOST_DEVICE
#endif

#include <cstddef>

namespace tightrope::ccd {

/// to[i] = from[i], i < count. As std::copy_n, of which nvcc 13 makes device code that copies nothing, and does not say
/// so; tests/gpu runs what it makes of the rest of the standard library that the methods use.
template <class From, class To>
TIGHTROPE_HOST_DEVICE void copy_numbers(const From* from, std::size_t count, To* to) {
  for (std::size_t i = 0; i < count; ++i) to[i] = from[i];
}

}  // namespace tightrope::ccd
