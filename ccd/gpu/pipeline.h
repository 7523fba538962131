#pragma once
/// The flow of a batch through a device: chunks, staging, the hand-over to exact arithmetic, and less memory than one
/// would like. A template over the device, so that all of it is tested where there is none (tests/gpu).
///
/// Two chunks are under way at a time. While the device works on one, the processor decides what the one before left
/// open and fills pinned memory with the one after.
///
/// A Backend has
///   Stream                                          a handle; Stream stream(slot): two of its own
///   void* device_memory(bytes), free_device(p), pinned_memory(bytes), free_pinned(p)      null: there is none
///   bool is_pinned(p)                               memory of the host that transfers use as it is
///   bool upload(stream, to, to_pitch, from, from_pitch, width, rows), download(..)          in bytes
///   bool run(stream, Method, Kind, chunk)           clears the counters, then all stages
///   bool gather(stream, chunk, first, count, Real* to)           the numbers of open queries first .., 24 together
///   bool scatter(stream, chunk, first, count, const unsigned char* answers)      answers of open queries first ..
///   bool mark(slot, stream), bool wait(slot)        waits for what was enqueued before the slot's last mark
///   bool follow(stream, slot)                       the same wait, by what is enqueued later in the stream
///   void drain(stream)                              waits for all, whatever happened
///   Result error()                                  of the call that gave `false`
/// Each stream works in the order in which it was given work, beside the processor.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

#include "ccd/gpu/chunk.h"
#include "ccd/gpu/decide_open.h"
#include "ccd/gpu/memory.h"
#include "ccd/gpu/stages.h"
#include "tightrope/gpu.h"

namespace tightrope::ccd::gpu {

inline constexpr std::size_t least_chunk = 1024;       ///< with less memory than these need the answer is out_of_memory
inline constexpr std::size_t host_chunk = 1U << 18;    ///< 48 MiB of doubles: about a millisecond on their way
inline constexpr std::size_t device_chunk = 1U << 22;  ///< 48 MiB of lists
inline constexpr std::size_t most_in_chunk = 1U << 30;

constexpr bool is_decided_by_processor(Method method) {
  return method == Method::tightrope || method == Method::bsc_exact;
}

template <class Backend>
class Pipeline {
 public:
  using Stream = typename Backend::Stream;

  explicit Pipeline(Backend& backend) : backend_(backend), slots_{{{backend, 0}, {backend, 1}}} {}

  void release() {
    for (auto& slot : slots_) slot.release();
  }
  std::size_t device_bytes() const { return slots_[0].device_bytes() + slots_[1].device_bytes(); }
  std::size_t pinned_bytes() const { return slots_[0].pinned_bytes() + slots_[1].pinned_bytes(); }

  /// Pointers of the host.
  template <class Real>
  Result from_host(const Queries<Real>& queries, unsigned char* results, const Options& options, Report& report) {
    if (queries.count == 0) return {};
    const HostCall<Real> call{queries, results, options, !backend_.is_pinned(queries.points),
                              !backend_.is_pinned(results)};
    // Several chunks even of few queries: transfers run beside kernels.
    const std::size_t chunk = chunk_with_room(wanted(options, std::min(host_chunk, (queries.count + 7) / 8)),
                                              [&](std::size_t size) { return reserve(call, size); });
    if (chunk == 0) return no_memory();
    report.chunk = chunk;
    if (!backend_.wait(last_mark)) return backend_.error();
    Result result = in_turns(
        queries.count, chunk, [&](Slot<Backend>& slot) { return enqueue(call, slot); },
        [&](Slot<Backend>& slot) { return finish(call, slot, report); });
    // After an error what is under way still reads and writes memory of the caller.
    if (!result) {
      for (const auto& slot : slots_) backend_.drain(backend_.stream(slot.number));
    }
    return result;
  }

  /// Pointers of the device.
  template <class Real>
  Result on_device(const Queries<Real>& queries, unsigned char* results, Stream stream, const Options& options,
                   Report& report) {
    if (queries.count == 0) return {};
    const bool comes_back = is_decided_by_processor(options.method) && !options.leave_open;
    const DeviceCall<Real> call{queries, results, options, stream, comes_back};
    const std::size_t chunk =
        chunk_with_room(wanted(options, std::min(device_chunk, queries.count)), [&](std::size_t size) {
          return std::all_of(slots_.begin(), slots_.end(), [&](Slot<Backend>& slot) {
            return slot.reserve_lists(size) && (!comes_back || slot.template reserve_open<Real>());
          });
        });
    if (chunk == 0) return no_memory();
    report.chunk = chunk;
    if (!backend_.follow(stream, last_mark)) return backend_.error();
    Result result = in_turns(
        queries.count, chunk, [&](Slot<Backend>& slot) { return enqueue(call, slot); },
        [&](Slot<Backend>& slot) { return finish(call, slot, report); });
    if (result && !(backend_.mark(last_mark, stream) && (!comes_back || backend_.wait(last_mark)))) {
      result = backend_.error();
    }
    if (!result) backend_.drain(stream);
    return result;
  }

 private:
  /// The slot whose mark is the end of a call that returned before its work was done: the next one follows it, for it
  /// writes to the same lists, perhaps in another stream.
  static constexpr int last_mark = 0;

  template <class Real>
  struct HostCall {
    const Queries<Real>& queries;
    unsigned char* results;
    const Options& options;
    bool stages_points, stages_results;  ///< by way of pinned memory
  };
  template <class Real>
  struct DeviceCall {
    const Queries<Real>& queries;
    unsigned char* results;
    const Options& options;
    Stream stream;
    bool comes_back;  ///< open queries do, to be decided
  };

  static Result no_memory() { return {Status::out_of_memory, "no memory for chunks of 1024 queries"}; }

  static std::size_t wanted(const Options& options, std::size_t otherwise) {
    return std::clamp(options.chunk != 0 ? options.chunk : otherwise, least_chunk, most_in_chunk);
  }

  /// Halves the chunk until `reserve` finds room for it; 0: there is none for the least.
  template <class Reserve>
  std::size_t chunk_with_room(std::size_t chunk, const Reserve& reserve) {
    for (; chunk >= least_chunk; chunk /= 2) {
      if (reserve(chunk)) return chunk;
      release();
    }
    return 0;
  }

  /// Gives each chunk to a slot, then finishes the one before.
  template <class Enqueue, class Finish>
  Result in_turns(std::size_t count, std::size_t chunk, const Enqueue& enqueue, const Finish& finish) {
    Result result;
    std::size_t turn = 0;
    for (std::size_t first = 0; first < count && result; first += chunk, ++turn) {
      Slot<Backend>& slot = slots_[turn % 2];
      slot.first = first;
      slot.count = std::min(chunk, count - first);
      result = enqueue(slot);
      if (turn > 0 && result) result = finish(slots_[(turn - 1) % 2]);
    }
    return result ? finish(slots_[(turn - 1) % 2]) : result;
  }

  template <class Real>
  bool reserve(const HostCall<Real>& call, std::size_t size) {
    const std::size_t bytes = size * numbers_of_query * sizeof(Real);
    return std::all_of(slots_.begin(), slots_.end(), [&](Slot<Backend>& slot) {
      return slot.points.reserve(bytes) && slot.results.reserve(size) && slot.reserve_lists(size) &&
             (!call.stages_points || slot.pinned_points.reserve(bytes)) &&
             (!call.stages_results || slot.pinned_results.reserve(size));
    });
  }

  /// The queries of the slot: to pinned memory unless they are there, to the device, through the stages, back.
  template <class Real>
  Result enqueue(const HostCall<Real>& call, Slot<Backend>& slot) {
    const bool together = call.queries.layout == Layout::by_query;
    const std::size_t rows = together ? 1 : numbers_of_query;
    const std::size_t width = numbers_of_query / rows * slot.count * sizeof(Real);
    const Real* from = call.queries.points + slot.first * (numbers_of_query / rows);
    std::size_t from_pitch = together ? width : call.queries.pitch * sizeof(Real);
    if (call.stages_points) {
      auto* pinned = slot.pinned_points.template as<char>();
      if (!copy_rows(pinned, width, from, from_pitch, rows, call.options.threads)) return no_memory();
      from = slot.pinned_points.template as<const Real>();
      from_pitch = width;
    }
    const Stream stream = backend_.stream(slot.number);
    auto* results = slot.results.template as<unsigned char>();
    Real* points = slot.points.template as<Real>();
    const Queries<Real> placed{call.queries.kind, slot.count, points, call.queries.layout, slot.count};
    const Chunk<Real> chunk = slot.chunk(placed, 0, results, call.options.method);
    unsigned char* back =
        call.stages_results ? slot.pinned_results.template as<unsigned char>() : call.results + slot.first;
    const bool enqueued = backend_.upload(stream, points, width, from, from_pitch, width, rows) &&
                          backend_.run(stream, call.options.method, call.queries.kind, chunk) &&
                          backend_.download(stream, back, slot.count, results, slot.count, slot.count, 1) &&
                          backend_.mark(slot.number, stream);
    return enqueued ? Result{} : backend_.error();
  }

  template <class Real>
  Result finish(const HostCall<Real>& call, Slot<Backend>& slot, Report& report) {
    if (!backend_.wait(slot.number)) return backend_.error();
    if (call.stages_results) {
      std::memcpy(call.results + slot.first, slot.pinned_results.template as<const unsigned char>(), slot.count);
    }
    if (!is_decided_by_processor(call.options.method)) return {};
    std::size_t open = 0;
    if (!decide_open(call.queries, slot.first, slot.count, call.results, call.options.method, call.options.threads,
                     open)) {
      return {Status::out_of_memory, "no memory for exact arithmetic"};
    }
    report.open += open;
    return {};
  }

  /// The stages on the queries of the slot, and the first of those that they leave open on their way back.
  template <class Real>
  Result enqueue(const DeviceCall<Real>& call, Slot<Backend>& slot) {
    const Chunk<Real> chunk = chunk_of(call, slot);
    bool enqueued = backend_.run(call.stream, call.options.method, call.queries.kind, chunk);
    if (enqueued && call.comes_back) {
      auto* back = slot.pinned_open.template as<OpenQueries<Real>>();
      constexpr std::size_t size = sizeof(Counters);
      enqueued = backend_.download(call.stream, &back->counters, size, chunk.counters, size, size, 1) &&
                 bring_back(call, slot, chunk, 0, std::min(open_at_once, slot.count));
    }
    return enqueued ? Result{} : backend_.error();
  }

  template <class Real>
  static Chunk<Real> chunk_of(const DeviceCall<Real>& call, const Slot<Backend>& slot) {
    return slot.chunk(call.queries, slot.first, call.results + slot.first, call.options.method);
  }

  /// Open queries first .. to pinned memory; there may be fewer of them.
  template <class Real>
  bool bring_back(const DeviceCall<Real>& call, Slot<Backend>& slot, const Chunk<Real>& chunk, std::size_t first,
                  std::size_t count) {
    Real* gathered = slot.open_points.template as<Real>();
    const std::size_t bytes = count * numbers_of_query * sizeof(Real);
    auto* back = slot.pinned_open.template as<OpenQueries<Real>>();
    return backend_.gather(call.stream, chunk, first, count, gathered) &&
           backend_.download(call.stream, back->points, bytes, gathered, bytes, bytes, 1) &&
           backend_.mark(slot.number, call.stream);
  }

  template <class Real>
  Result finish(const DeviceCall<Real>& call, Slot<Backend>& slot, Report& report) {
    if (!call.comes_back) return {};
    if (!backend_.wait(slot.number)) return backend_.error();
    const Chunk<Real> chunk = chunk_of(call, slot);
    auto* back = slot.pinned_open.template as<OpenQueries<Real>>();
    auto* answers = slot.open_answers.template as<unsigned char>();
    const std::size_t all = back->counters.open;
    for (std::size_t first = 0; first < all; first += open_at_once) {
      const std::size_t count = std::min(open_at_once, all - first);
      if (first > 0 && !(bring_back(call, slot, chunk, first, count) && backend_.wait(slot.number))) {
        return backend_.error();
      }
      std::fill_n(back->answers, count, static_cast<unsigned char>(Answer::open));
      const Queries<Real> open{call.queries.kind, count, back->points};
      std::size_t decided = 0;
      if (!decide_open(open, 0, count, back->answers, call.options.method, call.options.threads, decided)) {
        return {Status::out_of_memory, "no memory for exact arithmetic"};
      }
      if (!backend_.upload(call.stream, answers, count, back->answers, count, count, 1) ||
          !backend_.scatter(call.stream, chunk, first, count, answers)) {
        return backend_.error();
      }
    }
    report.open += all;
    return {};
  }

  Backend& backend_;
  std::array<Slot<Backend>, 2> slots_;
};

}  // namespace tightrope::ccd::gpu
