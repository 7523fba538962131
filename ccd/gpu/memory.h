#pragma once
/// Memory of a batch on its way through a device.

#include <cstddef>
#include <cstdint>

#include "ccd/gpu/chunk.h"
#include "tightrope/gpu.h"

namespace tightrope::ccd::gpu {

inline constexpr std::size_t numbers_of_query = 24;
inline constexpr std::size_t open_at_once = 1U << 12;  ///< open queries that come back together: 768 KiB

/// Memory that a backend gave, of the device or pinned. Frees it.
template <class Backend, bool Pinned>
class Memory {
 public:
  explicit Memory(Backend& backend) : backend_(backend) {}
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  ~Memory() { release(); }

  /// Makes room for `bytes`; what was in it is lost. False if there is none: it is empty then.
  bool reserve(std::size_t bytes) {
    if (bytes <= bytes_) return true;
    release();
    start_ = Pinned ? backend_.pinned_memory(bytes) : backend_.device_memory(bytes);
    bytes_ = start_ != nullptr ? bytes : 0;
    return start_ != nullptr;
  }
  void release() {
    if (start_ != nullptr) Pinned ? backend_.free_pinned(start_) : backend_.free_device(start_);
    start_ = nullptr;
    bytes_ = 0;
  }
  std::size_t bytes() const { return bytes_; }
  template <class T>
  T* as() const {
    return static_cast<T*>(start_);
  }

 private:
  Backend& backend_;
  void* start_ = nullptr;
  std::size_t bytes_ = 0;
};

/// Pinned memory for open queries on their way back.
template <class Real>
struct OpenQueries {
  Counters counters;
  unsigned char answers[open_at_once];
  Real points[open_at_once * numbers_of_query];
};

/// What one chunk under way needs, on both sides.
template <class Backend>
struct Slot {
  Slot(Backend& b, int slot_number)
      : number(slot_number),
        points(b),
        results(b),
        lists(b),
        counters(b),
        open_points(b),
        open_answers(b),
        pinned_points(b),
        pinned_results(b),
        pinned_open(b) {}

  int number;
  std::size_t first = 0, count = 0;  ///< the queries under way; none: 0
  Memory<Backend, false> points, results, lists, counters, open_points, open_answers;
  Memory<Backend, true> pinned_points, pinned_results, pinned_open;

  /// Lists and counters for chunks of so many queries.
  bool reserve_lists(std::size_t queries) {
    return lists.reserve(3 * queries * sizeof(Index)) && counters.reserve(sizeof(Counters));
  }
  /// For open queries that come back from memory of the device.
  template <class Real>
  bool reserve_open() {
    return open_points.reserve(open_at_once * numbers_of_query * sizeof(Real)) && open_answers.reserve(open_at_once) &&
           pinned_open.reserve(sizeof(OpenQueries<Real>));
  }
  void release() {
    for (auto* m : {&points, &results, &lists, &counters, &open_points, &open_answers}) m->release();
    for (auto* m : {&pinned_points, &pinned_results, &pinned_open}) m->release();
  }
  std::size_t device_bytes() const {
    std::size_t sum = 0;
    for (const auto* m : {&points, &results, &lists, &counters, &open_points, &open_answers}) sum += m->bytes();
    return sum;
  }
  std::size_t pinned_bytes() const { return pinned_points.bytes() + pinned_results.bytes() + pinned_open.bytes(); }

  /// The queries under way, lying on the device at `placed`; their result bytes from `to` on.
  template <class Real>
  Chunk<Real> chunk(const Queries<Real>& placed, std::size_t from, unsigned char* to, Method method) const {
    const bool together = placed.layout == Layout::by_query;
    Chunk<Real> c{};
    c.query_stride = together ? numbers_of_query : 1;
    c.coordinate_stride = together ? 1 : placed.pitch;
    c.points = placed.points + from * c.query_stride;
    c.count = static_cast<Index>(count);
    c.results = to;
    const std::size_t length = lists.bytes() / (3 * sizeof(Index));
    c.lists[0] = lists.template as<Index>();
    c.lists[1] = c.lists[0] + length;
    c.open = c.lists[1] + length;
    c.counters = counters.template as<Counters>();
    c.touching_is_open = method == Method::bsc_exact;
    return c;
  }
};

}  // namespace tightrope::ccd::gpu
