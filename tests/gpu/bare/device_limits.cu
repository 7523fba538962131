#include <cuda_runtime.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>

#include "device_limits.h"

namespace tightrope::gpu_check {
namespace {

void check(cudaError_t error) {
  if (error == cudaSuccess) return;
  std::fprintf(stderr, "gpu_check: %s\n", cudaGetErrorString(error));
  std::exit(1);
}

/// Seconds of the fastest of some runs.
double fastest(const std::function<void()>& run) {
  cudaEvent_t start, end;
  check(cudaEventCreate(&start));
  check(cudaEventCreate(&end));
  float best = 0;
  for (int i = 0; i < 6; ++i) {
    check(cudaEventRecord(start));
    run();
    check(cudaEventRecord(end));
    check(cudaEventSynchronize(end));
    float milliseconds = 0;
    check(cudaEventElapsedTime(&milliseconds, start, end));
    if (i == 1 || (i > 1 && milliseconds < best)) best = milliseconds;  // the first one warms up
  }
  check(cudaEventDestroy(start));
  check(cudaEventDestroy(end));
  return best / 1e3;
}

constexpr int chains = 8;
constexpr int steps = 4096;

__global__ void multiply_and_add(double* result, double a, double b) {
  double x[chains];
  for (int i = 0; i < chains; ++i) x[i] = threadIdx.x + i;
  for (int step = 0; step < steps; ++step) {
#pragma unroll
    for (int i = 0; i < chains; ++i) x[i] = fma(x[i], a, b);
  }
  double sum = 0;
  for (int i = 0; i < chains; ++i) sum += x[i];
  if (sum == 0.123) *result = sum;  // never: the chains must not be removed
}

template <class Real>
__global__ void transpose_numbers(const Real* from, std::size_t count, Real* to) {
  const std::size_t number = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (number < 24 * count) to[number % 24 * count + number / 24] = from[number];
}

}  // namespace

double copy_bytes_per_second() {
  constexpr std::size_t bytes = std::size_t{1} << 29;
  void *from, *to;
  check(cudaMalloc(&from, bytes));
  check(cudaMalloc(&to, bytes));
  check(cudaMemset(from, 0, bytes));
  const double seconds = fastest([&] { check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToDevice)); });
  check(cudaFree(from));
  check(cudaFree(to));
  return 2.0 * bytes / seconds;
}

double upload_bytes_per_second() {
  constexpr std::size_t bytes = std::size_t{1} << 28;
  void *from, *to;
  check(cudaMallocHost(&from, bytes));
  check(cudaMalloc(&to, bytes));
  const double seconds = fastest([&] { check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice)); });
  check(cudaFreeHost(from));
  check(cudaFree(to));
  return bytes / seconds;
}

double fma_operations_per_second() {
  int multiprocessors = 0, device = 0;
  check(cudaGetDevice(&device));
  check(cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device));
  double* result;
  check(cudaMalloc(&result, sizeof(double)));
  const int blocks = 16 * multiprocessors, threads = 256;
  const double seconds = fastest([&] {
    multiply_and_add<<<blocks, threads>>>(result, 0.999, 1e-3);
    check(cudaGetLastError());
  });
  check(cudaFree(result));
  return 2.0 * chains * steps * threads * blocks / seconds;
}

template <class Real>
void transpose(const Real* by_query, std::size_t count, Real* by_coordinate) {
  constexpr unsigned threads = 256;
  const auto blocks = static_cast<unsigned>((24 * count + threads - 1) / threads);
  transpose_numbers<<<blocks, threads>>>(by_query, count, by_coordinate);
  check(cudaGetLastError());
  check(cudaDeviceSynchronize());
}
template void transpose(const double*, std::size_t, double*);
template void transpose(const float*, std::size_t, float*);

}  // namespace tightrope::gpu_check
