#pragma once
/// The queries of method.h on a GPU (CUDA), with the answers that batch.h gives: the same bytes.
///
/// `bsc_float`, `bsc_safe`, `tight`, `safe` and `safe_tight` run on the device from end to end. `tightrope` and
/// `bsc_exact` are decided there as far as error bounds go; what they leave open comes back and is decided by the exact
/// arithmetic of the processor, while the device works on the next queries. Needs no header of CUDA; in a library that
/// was built without it every call says so. Nothing is thrown.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "tightrope/batch.h"
#include "tightrope/method.h"

namespace tightrope::ccd::gpu {

enum class Status : unsigned char {
  done,
  built_without_cuda,  ///< the library has no device code
  no_device,           ///< no driver, or no device of that number that this code runs on
  invalid_argument,    ///< a null pointer, a pitch below `count`, an empty workspace; nothing is written
  out_of_memory,       ///< the device (or the host) has no room even for small chunks
  device_error,        ///< the device failed: `text` is what CUDA says
};

/// What became of a call. `text` is of static storage, empty if the status is `done`.
struct [[nodiscard]] Result {
  Status status = Status::done;
  const char* text = "";
  explicit operator bool() const { return status == Status::done; }
};

struct Device {
  int number;
  char name[256];
  int compute_capability;  ///< 10 * major + minor
  int multiprocessors;
  std::size_t memory;  ///< bytes
};

/// The number of devices that this library can use; why there is none: `result`.
struct DeviceCount {
  int count;
  Result result;
};
DeviceCount device_count() noexcept;
/// Device `number`, counted from 0; none if there is no such device.
std::optional<Device> device(int number) noexcept;

/// A stream of CUDA: a cudaStream_t. Null: the default stream.
using Stream = void*;

struct Options {
  Method method = Method::tightrope;
  int threads = 1;  ///< of the processor, for exact arithmetic and for copies to pinned memory; 0: as many as it has
  /// Queries that are on the device at a time, 1024 or more; 0: as many as are worth it. Fewer where memory is short.
  std::size_t chunk = 0;
  /// collides_on_device: leave results[i] = 2 where exact arithmetic would have to decide, and do not wait.
  bool leave_open = false;
};

/// Memory on one device and pinned memory of the host, kept from call to call and freed at the end, whatever happened.
/// One call at a time; its device memory is that of two chunks at most. Empty after having been moved from.
class Workspace {
 public:
  /// On device `device`; nothing is allocated until it is needed.
  explicit Workspace(int device = 0) noexcept;
  Workspace(Workspace&& other) noexcept;
  Workspace& operator=(Workspace&& other) noexcept;
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;
  ~Workspace();

  /// Frees the memory now.
  void release() noexcept;
  std::size_t device_bytes() const noexcept;
  std::size_t pinned_bytes() const noexcept;

  struct State;
  State* state() noexcept { return state_; }  ///< for the library

 private:
  State* state_ = nullptr;
};

/// How a call went, for those who measure.
struct Report {
  std::size_t chunk = 0;  ///< queries on the device at a time
  std::size_t open = 0;   ///< queries that exact arithmetic decided (collides_on_device with leave_open: not counted)
};

/// results[i] = 1 if query i collides, else 0. Pointers of the host; transfers run beside the kernels, from pinned
/// memory of the caller at once, from other memory by way of pinned memory of the workspace. Returns when the results
/// are there. If it fails, what they hold is not said.
template <class Real>
Result collides(const Queries<Real>& queries, unsigned char* results, Workspace& workspace, const Options& options = {},
                Report* report = nullptr) noexcept;

/// The same for queries and results in the memory of the workspace's device, in the order of `stream`. Returns when the
/// work is enqueued; but with `tightrope` and `bsc_exact`, unless leave_open is set, when it is done. The workspace
/// must stay until then. On the device a call begins when the workspace's one before is done, whatever their streams.
template <class Real>
Result collides_on_device(const Queries<Real>& queries, unsigned char* results, Workspace& workspace, Stream stream,
                          const Options& options = {}, Report* report = nullptr) noexcept;

}  // namespace tightrope::ccd::gpu
