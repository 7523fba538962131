#pragma once
/// Memory of a test on the GPU. Needs nvcc.

#include <cstdio>
#include <cstdlib>
#include <vector>

namespace tightrope_test {

inline bool device_is_there() {
  int count = 0;
  return cudaGetDeviceCount(&count) == cudaSuccess && count > 0;
}

inline void must(cudaError_t error) {
  if (error == cudaSuccess) return;
  std::fprintf(stderr, "%s\n", cudaGetErrorString(error));
  std::exit(1);
}

/// Memory on the device that holds a copy of a vector; copied back at the end.
template <class Number>
class OnDevice {
 public:
  explicit OnDevice(std::vector<Number>& host) : host_(host) {
    must(cudaMalloc(&data_, bytes()));
    must(cudaMemcpy(data_, host_.data(), bytes(), cudaMemcpyHostToDevice));
  }
  OnDevice(const OnDevice&) = delete;
  OnDevice& operator=(const OnDevice&) = delete;
  ~OnDevice() {
    must(cudaMemcpy(host_.data(), data_, bytes(), cudaMemcpyDeviceToHost));
    must(cudaFree(data_));
  }
  Number* data() const { return data_; }

 private:
  std::size_t bytes() const { return host_.size() * sizeof(Number); }

  std::vector<Number>& host_;
  Number* data_ = nullptr;
};

}  // namespace tightrope_test
