#include "ccd/gpu/cuda_backend.h"
#include "ccd/gpu/launch.h"

namespace tightrope::ccd::gpu {
namespace {

constexpr unsigned threads_per_block = 128;
constexpr unsigned numbers_a_query = 24;

/// The numbers of open queries first .. , 24 together; a thread a number.
template <class Real>
__global__ void gather_open(const Chunk<Real> chunk, Index first, Index count, Real* to) {
  const Index there = chunk.counters->open > first ? chunk.counters->open - first : 0;
  const Index number = blockIdx.x * threads_per_block + threadIdx.x;
  const Index query = number / numbers_a_query, c = number % numbers_a_query;
  if (query >= count || query >= there) return;
  to[number] = chunk.points[chunk.open[first + query] * chunk.query_stride + c * chunk.coordinate_stride];
}

__global__ void scatter_answers(const Index* open, Index count, const unsigned char* answers, unsigned char* results) {
  const Index i = blockIdx.x * threads_per_block + threadIdx.x;
  if (i < count) results[open[i]] = answers[i];
}

unsigned blocks_of(std::size_t threads) {
  return static_cast<unsigned>((threads + threads_per_block - 1) / threads_per_block);
}

}  // namespace

Result result_of(cudaError_t error) {
  switch (static_cast<int>(error)) {
    case cudaSuccess:
      return {};
    case cudaErrorMemoryAllocation:
      return {Status::out_of_memory, cudaGetErrorString(error)};
    case cudaErrorNoDevice:
    case cudaErrorInsufficientDriver:
    case cudaErrorInvalidDevice:
    case cudaErrorNoKernelImageForDevice:
    case cudaErrorDevicesUnavailable:
      return {Status::no_device, cudaGetErrorString(error)};
    default:
      return {Status::device_error, cudaGetErrorString(error)};
  }
}

CurrentDevice::CurrentDevice(int device) : error_(cudaGetDevice(&before_)) {
  if (error_ == cudaSuccess) error_ = cudaSetDevice(device);
  if (error_ != cudaSuccess) cudaGetLastError();
}

CurrentDevice::~CurrentDevice() {
  if (error_ == cudaSuccess) cudaSetDevice(before_);
}

CudaBackend::~CudaBackend() {
  for (cudaEvent_t mark : marks_) {
    if (mark != nullptr) cudaEventDestroy(mark);
  }
  for (cudaStream_t stream : streams_) {
    if (stream != nullptr) cudaStreamDestroy(stream);
  }
}

bool CudaBackend::succeeded(cudaError_t error) {
  if (error == cudaSuccess) return true;
  error_ = error;
  cudaGetLastError();
  return false;
}

bool CudaBackend::open() {
  error_ = cudaSuccess;
  if (blocks_ == 0) {
    cudaFuncAttributes attributes;
    if (!succeeded(cudaFuncGetAttributes(&attributes, scatter_answers))) return false;  // is there code for it?
    constexpr int blocks_per_multiprocessor = 8;
    int multiprocessors = 0;
    if (!succeeded(cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device_))) return false;
    blocks_ = blocks_per_multiprocessor * multiprocessors;
  }
  for (int slot = 0; slot < 2; ++slot) {
    if (streams_[slot] == nullptr && !succeeded(cudaStreamCreateWithFlags(&streams_[slot], cudaStreamNonBlocking))) {
      return false;
    }
    if (marks_[slot] == nullptr && !succeeded(cudaEventCreateWithFlags(&marks_[slot], cudaEventDisableTiming))) {
      return false;
    }
  }
  return true;
}

void* CudaBackend::device_memory(std::size_t bytes) {
  void* memory = nullptr;
  return succeeded(cudaMalloc(&memory, bytes)) ? memory : nullptr;
}
void CudaBackend::free_device(void* memory) { succeeded(cudaFree(memory)); }
void* CudaBackend::pinned_memory(std::size_t bytes) {
  void* memory = nullptr;
  return succeeded(cudaMallocHost(&memory, bytes)) ? memory : nullptr;
}
void CudaBackend::free_pinned(void* memory) { succeeded(cudaFreeHost(memory)); }

bool CudaBackend::is_pinned(const void* memory) {
  cudaPointerAttributes attributes;
  return succeeded(cudaPointerGetAttributes(&attributes, memory)) && attributes.type == cudaMemoryTypeHost;
}

bool CudaBackend::copy(Stream stream, void* to, std::size_t to_pitch, const void* from, std::size_t from_pitch,
                       std::size_t width, std::size_t rows, cudaMemcpyKind direction) {
  constexpr std::size_t most_pitch = 0x7fffffff;  // of CUDA's copies in two dimensions (cudaDevAttrMaxPitch)
  if (rows > 1 && to_pitch <= most_pitch && from_pitch <= most_pitch) {
    return succeeded(cudaMemcpy2DAsync(to, to_pitch, from, from_pitch, width, rows, direction, stream));
  }
  for (std::size_t row = 0; row < rows; ++row) {
    if (!succeeded(cudaMemcpyAsync(static_cast<char*>(to) + row * to_pitch,
                                   static_cast<const char*>(from) + row * from_pitch, width, direction, stream))) {
      return false;
    }
  }
  return true;
}
bool CudaBackend::upload(Stream stream, void* to, std::size_t to_pitch, const void* from, std::size_t from_pitch,
                         std::size_t width, std::size_t rows) {
  return copy(stream, to, to_pitch, from, from_pitch, width, rows, cudaMemcpyHostToDevice);
}
bool CudaBackend::download(Stream stream, void* to, std::size_t to_pitch, const void* from, std::size_t from_pitch,
                           std::size_t width, std::size_t rows) {
  return copy(stream, to, to_pitch, from, from_pitch, width, rows, cudaMemcpyDeviceToHost);
}

template <class Real>
bool CudaBackend::run(Stream stream, Method method, Kind kind, const Chunk<Real>& chunk) {
  if (!succeeded(cudaMemsetAsync(chunk.counters, 0, sizeof(Counters), stream))) return false;
  switch (method) {
    case Method::bsc_float:
      launch<Method::bsc_float>(kind, chunk, blocks_, stream);
      break;
    case Method::bsc_safe:
      launch<Method::bsc_safe>(kind, chunk, blocks_, stream);
      break;
    case Method::tight:
    case Method::bsc_exact:  // what `tight` cannot reject is open: Chunk::touching_is_open
      launch<Method::tight>(kind, chunk, blocks_, stream);
      break;
    case Method::safe:
      launch<Method::safe>(kind, chunk, blocks_, stream);
      break;
    case Method::safe_tight:
      launch<Method::safe_tight>(kind, chunk, blocks_, stream);
      break;
    case Method::tightrope:
      launch<Method::tightrope>(kind, chunk, blocks_, stream);
      break;
  }
  return succeeded(cudaGetLastError());
}

template <class Real>
bool CudaBackend::gather(Stream stream, const Chunk<Real>& chunk, std::size_t first, std::size_t count, Real* to) {
  gather_open<<<blocks_of(count * numbers_a_query), threads_per_block, 0, stream>>>(chunk, static_cast<Index>(first),
                                                                                    static_cast<Index>(count), to);
  return succeeded(cudaGetLastError());
}

template <class Real>
bool CudaBackend::scatter(Stream stream, const Chunk<Real>& chunk, std::size_t first, std::size_t count,
                          const unsigned char* answers) {
  scatter_answers<<<blocks_of(count), threads_per_block, 0, stream>>>(chunk.open + first, static_cast<Index>(count),
                                                                      answers, chunk.results);
  return succeeded(cudaGetLastError());
}

bool CudaBackend::mark(int slot, Stream stream) { return succeeded(cudaEventRecord(marks_[slot], stream)); }
bool CudaBackend::wait(int slot) { return succeeded(cudaEventSynchronize(marks_[slot])); }
bool CudaBackend::follow(Stream stream, int slot) { return succeeded(cudaStreamWaitEvent(stream, marks_[slot], 0)); }
void CudaBackend::drain(Stream stream) { cudaStreamSynchronize(stream); }

template bool CudaBackend::run(Stream, Method, Kind, const Chunk<double>&);
template bool CudaBackend::run(Stream, Method, Kind, const Chunk<float>&);
template bool CudaBackend::gather(Stream, const Chunk<double>&, std::size_t, std::size_t, double*);
template bool CudaBackend::gather(Stream, const Chunk<float>&, std::size_t, std::size_t, float*);
template bool CudaBackend::scatter(Stream, const Chunk<double>&, std::size_t, std::size_t, const unsigned char*);
template bool CudaBackend::scatter(Stream, const Chunk<float>&, std::size_t, std::size_t, const unsigned char*);

}  // namespace tightrope::ccd::gpu
