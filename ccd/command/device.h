#pragma once
/// Where batches of queries run: the one place that knows of processors and GPUs.

#include <string>
#include <string_view>

#include "tightrope/batch.h"

namespace tightrope::ccd {

enum class Device { cpu, gpu };
std::string_view name(Device device);  ///< "cpu", "gpu"

struct Execution {
  Device device = Device::cpu;
  int threads = 1;                                       ///< at least 1
  InstructionSet instructions = InstructionSet::scalar;  ///< on the CPU

  bool operator==(const Execution&) const = default;
};

/// The best instructions of this machine, one thread.
Execution default_execution();

/// Why nothing can run on `device` here; empty: it can.
std::string why_unusable(Device device);

/// results[i] = 1 if query i collides, else 0. Same answers on every device that is usable.
template <class Real>
[[nodiscard]] BatchStatus collides(const Queries<Real>& queries, unsigned char* results, Method method,
                                   const Execution& execution);

/// One line for people; `done` has none.
std::string_view explanation(BatchStatus status);

}  // namespace tightrope::ccd
