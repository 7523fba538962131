/// The public functions on a device of CUDA.

#include "tightrope/gpu.h"

#include <cuda_runtime.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <utility>

#include "ccd/batch/source.h"
#include "ccd/gpu/cuda_backend.h"
#include "ccd/gpu/pipeline.h"

namespace tightrope::ccd::gpu {

struct Workspace::State {
  explicit State(int device) : backend(device), pipeline(backend) {}
  ~State() {
    const CurrentDevice current(backend.device());
    pipeline.release();
  }
  CudaBackend backend;
  Pipeline<CudaBackend> pipeline;
};

namespace {

Result invalid(const char* what) { return {Status::invalid_argument, what}; }

cudaMemoryType type_of(const void* memory) {
  cudaPointerAttributes attributes;
  if (cudaPointerGetAttributes(&attributes, memory) == cudaSuccess) return attributes.type;
  cudaGetLastError();
  return cudaMemoryTypeUnregistered;
}

/// Runs `flow` on the pipeline with its device current, if the arguments are valid.
template <class Real, class Flow>
Result on_workspace(const Queries<Real>& queries, const unsigned char* results, Workspace& workspace,
                    const Options& options, const Flow& flow) {
  Workspace::State* state = workspace.state();
  if (state == nullptr) return invalid("the workspace is empty");
  if (!batch::is_valid(queries)) return invalid("queries: a null pointer, or a pitch below their number");
  if (queries.count > 0 && results == nullptr) return invalid("results: a null pointer");
  if (options.threads < 0) return invalid("a negative number of threads");
  const CurrentDevice current(state->backend.device());
  if (current.error() != cudaSuccess) return result_of(current.error());
  if (!state->backend.open()) return state->backend.error();
  return flow(*state);
}

}  // namespace

DeviceCount device_count() noexcept {
  int count = 0;
  const cudaError_t error = cudaGetDeviceCount(&count);
  if (error == cudaSuccess && count > 0) return {count, {}};
  cudaGetLastError();
  if (error == cudaSuccess) return {0, {Status::no_device, "there is no device"}};
  int driver = 0;  // CUDA calls a driver that is not there too old
  if (cudaDriverGetVersion(&driver) == cudaSuccess && driver == 0) {
    return {0, {Status::no_device, "there is no driver of NVIDIA"}};
  }
  return {0, {Status::no_device, cudaGetErrorString(error)}};
}

std::optional<Device> device(int number) noexcept {
  cudaDeviceProp properties;
  if (number < 0 || number >= device_count().count) return std::nullopt;
  if (cudaGetDeviceProperties(&properties, number) != cudaSuccess) {
    cudaGetLastError();
    return std::nullopt;
  }
  Device found{
      number, {}, 10 * properties.major + properties.minor, properties.multiProcessorCount, properties.totalGlobalMem};
  static_assert(sizeof(found.name) >= sizeof(properties.name));
  std::memcpy(found.name, properties.name, sizeof(properties.name));
  return found;
}

Workspace::Workspace(int device) noexcept : state_(new (std::nothrow) State(device)) {}
Workspace::Workspace(Workspace&& other) noexcept : state_(std::exchange(other.state_, nullptr)) {}
Workspace& Workspace::operator=(Workspace&& other) noexcept {
  Workspace taken(std::move(other));
  std::swap(state_, taken.state_);
  return *this;
}
Workspace::~Workspace() { delete state_; }

void Workspace::release() noexcept {
  if (state_ == nullptr) return;
  const CurrentDevice current(state_->backend.device());
  state_->pipeline.release();
}
std::size_t Workspace::device_bytes() const noexcept { return state_ == nullptr ? 0 : state_->pipeline.device_bytes(); }
std::size_t Workspace::pinned_bytes() const noexcept { return state_ == nullptr ? 0 : state_->pipeline.pinned_bytes(); }

template <class Real>
Result collides(const Queries<Real>& queries, unsigned char* results, Workspace& workspace, const Options& options,
                Report* report) noexcept {
  Report unread;
  return on_workspace(queries, results, workspace, options, [&](Workspace::State& state) -> Result {
    if (queries.count > 0 &&
        (type_of(queries.points) == cudaMemoryTypeDevice || type_of(results) == cudaMemoryTypeDevice)) {
      return invalid("a pointer of the device: collides_on_device takes those");
    }
    return state.pipeline.from_host(queries, results, options, report != nullptr ? *report = {} : unread);
  });
}

template <class Real>
Result collides_on_device(const Queries<Real>& queries, unsigned char* results, Workspace& workspace, Stream stream,
                          const Options& options, Report* report) noexcept {
  Report unread;
  return on_workspace(queries, results, workspace, options, [&](Workspace::State& state) -> Result {
    int reaches_all = 0;  // devices that read what malloc gave
    cudaDeviceGetAttribute(&reaches_all, cudaDevAttrPageableMemoryAccess, state.backend.device());
    if (queries.count > 0 && reaches_all == 0 &&
        (type_of(queries.points) == cudaMemoryTypeUnregistered || type_of(results) == cudaMemoryTypeUnregistered)) {
      return invalid("a pointer that the device cannot use");
    }
    return state.pipeline.on_device(queries, results, static_cast<cudaStream_t>(stream), options,
                                    report != nullptr ? *report = {} : unread);
  });
}

template Result collides(const Queries<double>&, unsigned char*, Workspace&, const Options&, Report*) noexcept;
template Result collides(const Queries<float>&, unsigned char*, Workspace&, const Options&, Report*) noexcept;
template Result collides_on_device(const Queries<double>&, unsigned char*, Workspace&, Stream, const Options&,
                                   Report*) noexcept;
template Result collides_on_device(const Queries<float>&, unsigned char*, Workspace&, Stream, const Options&,
                                   Report*) noexcept;

}  // namespace tightrope::ccd::gpu
