#pragma once
/// Batches of calls of a generated predicate on a GPU: what NAME.BOUND.REAL.cuda.h and .cu are made of
/// (`tightrope compile --target cuda`, docs/cuda.md). Needs the CUDA runtime; any C++ compiler may include it.
///
/// Arguments and results are structures of arrays: number c of call i stands at data[c * pitch + i], so that
/// neighbouring threads read neighbouring numbers.

#include <cuda_runtime_api.h>
#include <tightrope/sign.h>

#include <cstddef>

#if defined(__CUDA_ARCH__)
#define TIGHTROPE_UNROLL _Pragma("unroll")
#else
#define TIGHTROPE_UNROLL
#endif

namespace tightrope {

/// One argument of every call; `pitch` is at least the number of calls, and of no meaning for a single number.
template <class Real>
struct ArgumentArray {
  const Real* data = nullptr;
  std::size_t pitch = 0;
};

/// One argument that carries errors.
template <class Real>
struct BoundedArgumentArray {
  const Real* values = nullptr;
  const Real* bounds = nullptr;
  std::size_t pitch = 0;
};

/// Where one output of every call goes, elements in row-major order. What is null is not wanted. Signs are -1, 0
/// (uncertain), +1.
template <class Real>
struct OutputArray {
  signed char* signs = nullptr;
  Real* values = nullptr;
  Real* bounds = nullptr;
  std::size_t pitch = 0;
};

/// The arrays of a batch of calls, and its launch; NAME.BOUND.REAL.cuda.h specialises it for every predicate.
template <class Predicate>
struct Batch;

template <class Real>
TIGHTROPE_FUNCTION void load(const ArgumentArray<Real>& array, std::size_t call, Real& number, std::size_t place = 0) {
  number = array.data[place * array.pitch + call];
}

template <class Real>
TIGHTROPE_FUNCTION void load(const BoundedArgumentArray<Real>& array, std::size_t call, Bounded<Real>& number,
                             std::size_t place = 0) {
  number = {array.values[place * array.pitch + call], array.bounds[place * array.pitch + call]};
}

template <class Array, class Number, std::size_t N>
TIGHTROPE_FUNCTION void load(const Array& array, std::size_t call, Number (&numbers)[N]) {
  TIGHTROPE_UNROLL
  for (std::size_t place = 0; place < N; ++place) load(array, call, numbers[place], place);
}

template <class Real>
TIGHTROPE_FUNCTION bool wanted(const OutputArray<Real>& output) {
  return output.signs || output.values || output.bounds;
}

template <class Real>
TIGHTROPE_FUNCTION void store(const Bounded<Real>& element, const OutputArray<Real>& output, std::size_t call,
                              std::size_t place = 0) {
  const std::size_t i = place * output.pitch + call;
  if (output.signs) output.signs[i] = static_cast<signed char>(sign(element));
  if (output.values) output.values[i] = element.value;
  if (output.bounds) output.bounds[i] = element.bound;
}

/// Elements `place`, `place` + 1, ... of the output.
template <class Element, std::size_t N, class Real>
TIGHTROPE_FUNCTION void store(const Element (&elements)[N], const OutputArray<Real>& output, std::size_t call,
                              std::size_t place = 0) {
  constexpr std::size_t each = sizeof(Element) / sizeof(Bounded<Real>);
  TIGHTROPE_UNROLL
  for (std::size_t k = 0; k < N; ++k) store(elements[k], output, call, place + k * each);
}

/// A parameter that kernels read where it is, without a copy of their own. GPUs before 7.0 have no such thing.
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ < 700
#define TIGHTROPE_GRID_CONSTANT
#else
#define TIGHTROPE_GRID_CONSTANT __grid_constant__
#endif

#if defined(__CUDACC__)
inline constexpr unsigned threads_per_block = 128;  // up to 255 registers of 64K a thread, on every architecture

__device__ inline std::size_t call_of_thread() {
  return blockIdx.x * static_cast<std::size_t>(threads_per_block) + threadIdx.x;
}

/// One thread a call. (No loop over more calls than a grid has threads: their arrays would not fit into any memory. And
/// nvcc would make a copy of the loop for every combination of wanted outputs.) The error, if any, is that of the
/// launch.
template <class Calls>
cudaError_t launch_calls(void (*kernel)(Calls, std::size_t), Calls calls, std::size_t count, cudaStream_t stream) {
  if (count == 0) return cudaSuccess;
  const std::size_t blocks = (count - 1) / threads_per_block + 1;
  if (blocks > 0x7fffffff) return cudaErrorInvalidValue;
  void* arguments[] = {&calls, &count};
  return cudaLaunchKernel(reinterpret_cast<const void*>(kernel), dim3(static_cast<unsigned>(blocks)),
                          dim3(threads_per_block), arguments, 0, stream);
}
#endif

}  // namespace tightrope

#undef TIGHTROPE_UNROLL
