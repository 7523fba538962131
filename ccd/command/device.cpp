#include "command/device.h"

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
    case Device::gpu:
      return "no GPU support in this build";
  }
  return {};
}

template <class Real>
BatchStatus collides(const Queries<Real>& queries, unsigned char* results, Method method, const Execution& execution) {
  switch (execution.device) {
    case Device::cpu:
      return collides(
          queries, results,
          BatchOptions{.method = method, .threads = execution.threads, .instructions = execution.instructions});
    case Device::gpu:
      break;
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
