#include "command/device.h"

#include "tightrope/gpu.h"

namespace tightrope::ccd {

std::string_view name(Device device) {
  switch (device) {
    case Device::cpu:
      return "cpu";
    case Device::gpu:
      return "gpu";
  }
  return {};
}

Execution default_execution() { return {.instructions = instruction_sets().back()}; }

std::string why_unusable(Device device) {
  switch (device) {
    case Device::cpu:
      return {};
    case Device::gpu: {
      const gpu::DeviceCount devices = gpu::device_count();
      if (devices.result.status == gpu::Status::built_without_cuda) return "no GPU support in this build";
      if (!devices.result) return std::string("no GPU here: ") + devices.result.text;
      gpu::Workspace workspace;  // is there code for this GPU, and does its driver take it?
      const gpu::Result usable = gpu::collides(Queries<double>{}, nullptr, workspace);
      return usable ? std::string{} : std::string("this GPU cannot be used: ") + usable.text;
    }
  }
  return {};
}

namespace {

template <class Real>
BatchStatus on_gpu(const Queries<Real>& queries, unsigned char* results, Method method, int threads) {
  static gpu::Workspace workspace;  // one device and one call at a time: its memory lasts as long as the command
  const gpu::Result result = gpu::collides(queries, results, workspace, {.method = method, .threads = threads});
  switch (result.status) {
    case gpu::Status::done:
      return BatchStatus::done;
    case gpu::Status::out_of_memory:
      return BatchStatus::out_of_memory;
    case gpu::Status::built_without_cuda:
    case gpu::Status::no_device:
    case gpu::Status::invalid_argument:
    case gpu::Status::device_error:
      return BatchStatus::invalid_argument;
  }
  return BatchStatus::invalid_argument;
}

}  // namespace

template <class Real>
BatchStatus collides(const Queries<Real>& queries, unsigned char* results, Method method, const Execution& execution) {
  switch (execution.device) {
    case Device::cpu:
      return collides(
          queries, results,
          BatchOptions{.method = method, .threads = execution.threads, .instructions = execution.instructions});
    case Device::gpu:
      return on_gpu(queries, results, method, execution.threads);
  }
  return BatchStatus::invalid_argument;
}
template BatchStatus collides(const Queries<double>&, unsigned char*, Method, const Execution&);
template BatchStatus collides(const Queries<float>&, unsigned char*, Method, const Execution&);

std::string_view explanation(BatchStatus status) {
  switch (status) {
    case BatchStatus::done:
      return {};
    case BatchStatus::out_of_memory:
      return "out of memory";
    case BatchStatus::invalid_argument:
      return "this cannot be computed there";
  }
  return {};
}

}  // namespace tightrope::ccd
