#pragma once
/// A device of CUDA as the pipeline sees it.

#include <cuda_runtime.h>

#include <cstddef>

#include "ccd/gpu/chunk.h"
#include "tightrope/gpu.h"

namespace tightrope::ccd::gpu {

/// What an error of CUDA means for the caller.
Result result_of(cudaError_t error);

/// Makes a device the current one, and the one before again at the end.
class CurrentDevice {
 public:
  explicit CurrentDevice(int device);
  CurrentDevice(const CurrentDevice&) = delete;
  CurrentDevice& operator=(const CurrentDevice&) = delete;
  ~CurrentDevice();
  cudaError_t error() const { return error_; }

 private:
  int before_ = 0;
  cudaError_t error_;
};

class CudaBackend {
 public:
  using Stream = cudaStream_t;

  explicit CudaBackend(int device) : device_(device) {}
  CudaBackend(const CudaBackend&) = delete;
  CudaBackend& operator=(const CudaBackend&) = delete;
  ~CudaBackend();

  int device() const { return device_; }
  /// Makes streams and marks at the first call. The device is current in all calls that follow.
  bool open();

  Stream stream(int slot) const { return streams_[slot]; }
  void* device_memory(std::size_t bytes);
  void free_device(void* memory);
  void* pinned_memory(std::size_t bytes);
  void free_pinned(void* memory);
  bool is_pinned(const void* memory);
  bool upload(Stream stream, void* to, std::size_t to_pitch, const void* from, std::size_t from_pitch,
              std::size_t width, std::size_t rows);
  bool download(Stream stream, void* to, std::size_t to_pitch, const void* from, std::size_t from_pitch,
                std::size_t width, std::size_t rows);
  template <class Real>
  bool run(Stream stream, Method method, Kind kind, const Chunk<Real>& chunk);
  template <class Real>
  bool gather(Stream stream, const Chunk<Real>& chunk, std::size_t first, std::size_t count, Real* to);
  template <class Real>
  bool scatter(Stream stream, const Chunk<Real>& chunk, std::size_t first, std::size_t count,
               const unsigned char* answers);
  bool mark(int slot, Stream stream);
  bool wait(int slot);
  bool follow(Stream stream, int slot);
  void drain(Stream stream);
  Result error() const { return result_of(error_); }

 private:
  /// Keeps an error for `error`, and clears it where CUDA keeps it.
  bool succeeded(cudaError_t error);
  bool copy(Stream stream, void* to, std::size_t to_pitch, const void* from, std::size_t from_pitch, std::size_t width,
            std::size_t rows, cudaMemcpyKind direction);

  int device_;
  int blocks_ = 0;  ///< that run at a time
  cudaStream_t streams_[2] = {};
  cudaEvent_t marks_[2] = {};
  cudaError_t error_ = cudaSuccess;
};

}  // namespace tightrope::ccd::gpu
