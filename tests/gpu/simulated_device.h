#pragma once
/// A device that is none: memory with a limit, streams whose work waits until somebody waits for it, and failures on
/// demand. What is wrong with the order of transfers, kernels and reuse of memory shows here as on a device that is
/// slow.

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <functional>
#include <iterator>
#include <limits>
#include <map>

#include "tests/gpu/host_stages.h"
#include "tightrope/gpu.h"

namespace tightrope::ccd::gpu {

class SimulatedDevice {
 public:
  using Stream = int;  ///< 0, 1: its own; 2, 3: callers'

  std::size_t memory_limit = std::numeric_limits<std::size_t>::max();  ///< of device and pinned memory together
  long calls_until_failure = -1;                                       ///< negative: none fails
  bool caller_pins = false;                                            ///< memory of the caller is pinned
  bool forgets_to_wait = false;                                        ///< defects: the tests must notice
  bool forgets_to_follow = false;
  bool interleaves = false;  ///< streams take turns, as far as they do not wait for each other
  long calls = 0;
  long conflicts = 0;  ///< a stream began to use counters and lists before another had done with them
  std::size_t in_use = 0, most_in_use = 0;

  SimulatedDevice() = default;
  SimulatedDevice(const SimulatedDevice&) = delete;
  SimulatedDevice& operator=(const SimulatedDevice&) = delete;
  ~SimulatedDevice() {
    for (auto& [memory, bytes] : blocks_) std::free(memory);
  }
  std::size_t blocks() const { return blocks_.size(); }
  bool idle() const {
    return std::all_of(std::begin(work_), std::end(work_), [](const auto& work) { return work.empty(); });
  }

  Stream stream(int slot) const { return slot; }
  void* device_memory(std::size_t bytes) { return allocate(bytes); }
  void* pinned_memory(std::size_t bytes) { return allocate(bytes); }
  void free_device(void* memory) { release(memory); }
  void free_pinned(void* memory) { release(memory); }
  bool is_pinned(const void*) const { return caller_pins; }

  bool upload(Stream stream, void* to, std::size_t to_pitch, const void* from, std::size_t from_pitch,
              std::size_t width, std::size_t rows) {
    return enqueue(stream, [=] {
      for (std::size_t row = 0; row < rows; ++row) {
        std::memcpy(static_cast<char*>(to) + row * to_pitch, static_cast<const char*>(from) + row * from_pitch, width);
      }
    });
  }
  bool download(Stream stream, void* to, std::size_t to_pitch, const void* from, std::size_t from_pitch,
                std::size_t width, std::size_t rows) {
    return upload(stream, to, to_pitch, from, from_pitch, width, rows);
  }

  template <class Real>
  bool run(Stream stream, Method method, Kind kind, const Chunk<Real>& chunk) {
    if (!enqueue(stream, [=, this] { user_[chunk.counters] = stream; })) return false;
    work_[stream].emplace_back([=, this] {
      if (user_[chunk.counters] != stream) ++conflicts;
      *chunk.counters = {};
      switch (method) {
        case Method::bsc_float:
          return run_on_host<Method::bsc_float>(kind, chunk);
        case Method::bsc_safe:
          return run_on_host<Method::bsc_safe>(kind, chunk);
        case Method::tight:
        case Method::bsc_exact:
          return run_on_host<Method::tight>(kind, chunk);
        case Method::safe:
          return run_on_host<Method::safe>(kind, chunk);
        case Method::safe_tight:
          return run_on_host<Method::safe_tight>(kind, chunk);
        case Method::tightrope:
          return run_on_host<Method::tightrope>(kind, chunk);
      }
    });
    return true;
  }
  template <class Real>
  bool gather(Stream stream, const Chunk<Real>& chunk, std::size_t first, std::size_t count, Real* to) {
    return enqueue(stream, [=] {
      for (std::size_t k = first; k < first + count && k < chunk.counters->open; ++k) {
        for (std::size_t c = 0; c < numbers_a_query; ++c) {
          to[(k - first) * numbers_a_query + c] =
              chunk.points[chunk.open[k] * chunk.query_stride + c * chunk.coordinate_stride];
        }
      }
    });
  }
  template <class Real>
  bool scatter(Stream stream, const Chunk<Real>& chunk, std::size_t first, std::size_t count,
               const unsigned char* answers) {
    return enqueue(stream, [=] {
      for (std::size_t k = 0; k < count; ++k) chunk.results[chunk.open[first + k]] = answers[k];
    });
  }

  bool mark(int slot, Stream stream) {
    marks_[slot] = {stream, done_[stream] + work_[stream].size()};
    return succeeds();
  }
  /// Does what was enqueued before the mark, and nothing more.
  bool wait(int slot) {
    const auto [stream, until] = marks_[slot];
    while (done_[stream] < until && !forgets_to_wait) step(stream);
    return succeeds();
  }
  bool follow(Stream stream, int slot) {
    return enqueue(stream, [this, mark = marks_[slot]] {
      while (done_[mark.stream] < mark.until && !forgets_to_follow) step(mark.stream);
    });
  }
  void drain(Stream stream) {
    while (!work_[stream].empty()) step(stream);
  }
  Result error() const { return {Status::device_error, "simulated"}; }

 private:
  struct Mark {
    Stream stream = 0;
    std::size_t until = 0;
  };

  bool succeeds() { return calls++ != calls_until_failure; }
  bool enqueue(Stream stream, std::function<void()> work) {
    if (!succeeds()) return false;
    work_[stream].push_back(std::move(work));
    return true;
  }
  void step(Stream stream) {
    const std::function<void()> work = std::move(work_[stream].front());
    work_[stream].pop_front();
    busy_[stream] = true;
    work();
    ++done_[stream];
    for (Stream other = 0; other < streams && interleaves; ++other) {
      if (!busy_[other] && !work_[other].empty()) step(other);
    }
    busy_[stream] = false;
  }

  void* allocate(std::size_t bytes) {
    if (bytes > memory_limit - in_use) return nullptr;
    void* memory = std::malloc(bytes);
    std::memset(memory, 0xab, bytes);
    blocks_[memory] = bytes;
    in_use += bytes;
    most_in_use = most_in_use > in_use ? most_in_use : in_use;
    return memory;
  }
  void release(void* memory) {
    const auto block = blocks_.find(memory);
    if (block == blocks_.end()) std::abort();  // freed twice, or none of ours
    in_use -= block->second;
    blocks_.erase(block);
    std::free(memory);
  }

  static constexpr int streams = 4;
  std::deque<std::function<void()>> work_[streams];
  std::size_t done_[streams] = {};
  bool busy_[streams] = {};  ///< what is under way there waits for something, or has just been done
  Mark marks_[2];
  std::map<const Counters*, Stream> user_;
  std::map<void*, std::size_t> blocks_;
};

}  // namespace tightrope::ccd::gpu
