/// Batches: arguments, threads, and the loop over chunks. Vector stages reject in bulk, what they leave is decided
/// one by one by the functions for one query.

#include "tightrope/batch.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <new>

#include "ccd/batch/filter.h"
#include "ccd/batch/source.h"
#include "ccd/impact/query.h"
#include "tightrope/contact.h"

namespace tightrope::ccd {
namespace {

using batch::Index;
using batch::queries_per_chunk;

bool has_times(Method method) {
  switch (method) {
    case Method::safe:
    case Method::safe_tight:
    case Method::tightrope:
      return true;
    case Method::bsc_float:
    case Method::bsc_safe:
    case Method::tight:
    case Method::bsc_exact:
      return false;
  }
  return false;
}

InstructionSet best() { return instruction_sets().back(); }

bool has_fused_form(const BatchOptions& options) {
  switch (options.instructions.value_or(best())) {
    case InstructionSet::scalar:
    case InstructionSet::sse4:
      return false;
    case InstructionSet::neon:
    case InstructionSet::avx2:
    case InstructionSet::avx512:
      return options.method == Method::tightrope;
  }
  return false;
}

bool is_valid(const BatchOptions& options) {
  if (options.threads < 0) return false;
  if (options.arithmetic == Arithmetic::fused && !has_fused_form(options)) return false;
  const auto there = instruction_sets();
  return !options.instructions || std::find(there.begin(), there.end(), *options.instructions) != there.end();
}

/// Runs `chunk(first, count)` for every chunk of 0 .. count - 1, on as many threads as are asked for.
template <class RunChunk>
BatchStatus for_chunks(std::size_t count, int threads, const RunChunk& run_chunk) noexcept {
  const std::size_t chunks = (count + queries_per_chunk - 1) / queries_per_chunk;
  const auto run = [&](std::size_t chunk) {
    const std::size_t first = queries_per_chunk * chunk;
    run_chunk(first, std::min(queries_per_chunk, count - first));
  };
  try {
    if (threads == 1 || chunks <= 1) {
      for (std::size_t chunk = 0; chunk < chunks; ++chunk) run(chunk);
      return BatchStatus::done;
    }
    const int processors = oneapi::tbb::info::default_concurrency();
    oneapi::tbb::task_arena arena(threads == 0 ? processors : std::min(threads, processors));
    arena.execute([&] {
      using Range = oneapi::tbb::blocked_range<std::size_t>;
      oneapi::tbb::parallel_for(Range(0, chunks), [&](const Range& part) {
        for (std::size_t chunk = part.begin(); chunk < part.end(); ++chunk) run(chunk);
      });
    });
  } catch (...) {  // nothing but std::bad_alloc, and what starting a thread throws
    return BatchStatus::out_of_memory;
  }
  return BatchStatus::done;
}

/// Calls `decide(i, points)` for each query of a chunk that the filter does not settle.
template <template <class> class Source, class Real, class Decide>
void decide_survivors(const Source<Real>& queries, const batch::Filter<Source, Real>* filter, std::size_t first,
                      std::size_t count, const Decide& decide) {
  std::array<Real, numbers_per_query> copy;
  if (filter == nullptr) {
    for (std::size_t i = first; i < first + count; ++i) decide(i, batch::points_of(queries, i, copy));
    return;
  }
  std::array<Index, queries_per_chunk> survivors;
  const std::size_t left = (*filter)(queries, first, count, survivors.data());
  for (std::size_t s = 0; s < left; ++s) {
    const std::size_t i = first + survivors[s];
    decide(i, batch::points_of(queries, i, copy));
  }
}

/// The queries of a batch that collide: `begin(first, count)` before the first of a chunk, then `found(i)`.
template <template <class> class Source, class Real, class Begin, class Found>
BatchStatus find_collisions(const Source<Real>& queries, const BatchOptions& options, const Begin& begin,
                            const Found& found) noexcept {
  const batch::Filter<Source, Real> filter(options.method, queries.kind, options.instructions.value_or(best()),
                                           options.arithmetic);
  // The vector stages have asked for separations of what they leave.
  const bool unseparated = filter && options.method == Method::tightrope;
  const auto collides_after_filter = [&](const Real* points) {
    if (!unseparated) return collides(queries.kind, points, options.method);
    const auto& in_double = in_double_precision(points);
    return tightrope_collides_unseparated(queries.kind, in_double.data());
  };
  return for_chunks(queries.count, options.threads, [&](std::size_t first, std::size_t count) {
    begin(first, count);
    decide_survivors(queries, filter ? &filter : nullptr, first, count, [&](std::size_t i, const Real* points) {
      if (collides_after_filter(points)) found(i);
    });
  });
}

template <class Source>
BatchStatus collision_bytes(const Source& queries, unsigned char* results, const BatchOptions& options) noexcept {
  if (!is_valid(options) || !batch::is_valid(queries) || (results == nullptr && queries.count > 0)) {
    return BatchStatus::invalid_argument;
  }
  const auto clear = [&](std::size_t first, std::size_t count) { std::fill_n(results + first, count, 0); };
  return find_collisions(queries, options, clear, [&](std::size_t i) { results[i] = 1; });
}

/// Chunks are multiples of 8 queries: no two threads share a byte.
template <class Source>
BatchStatus collision_bits(const Source& queries, unsigned char* bits, const BatchOptions& options) noexcept {
  static_assert(queries_per_chunk % 8 == 0);
  if (!is_valid(options) || !batch::is_valid(queries) || (bits == nullptr && queries.count > 0)) {
    return BatchStatus::invalid_argument;
  }
  const auto clear = [&](std::size_t first, std::size_t count) { std::fill_n(bits + first / 8, (count + 7) / 8, 0); };
  return find_collisions(queries, options, clear,
                         [&](std::size_t i) { bits[i / 8] |= static_cast<unsigned char>(1U << (i % 8)); });
}

template <class Real>
double time_of_impact(Kind kind, const Real* points, Method method, const ImpactOptions& options) {
  constexpr double never = std::numeric_limits<double>::infinity();
  if (method == Method::tightrope) {
    const auto impact = first_impact(pair_of(kind), points, options);
    return impact ? impact->time : never;
  }
  const auto contact = first_contact(kind, points, method);
  const double earliest = contact ? static_cast<double>(contact->earliest) : never;
  return earliest > options.t_max ? never : earliest;
}

template <template <class> class Source, class Real>
BatchStatus times(const Source<Real>& queries, double* times, const ImpactOptions& impact,
                  const BatchOptions& options) noexcept {
  const bool separation = impact.minimum_separation != 0;  // NaN too
  if (!is_valid(options) || !batch::is_valid(queries) || (times == nullptr && queries.count > 0) ||
      !has_times(options.method) || (separation && options.method != Method::tightrope)) {
    return BatchStatus::invalid_argument;
  }
  // What stays apart by less than the separation is no contact, but has a time.
  const batch::Filter<Source, Real> filter(options.method, queries.kind, options.instructions.value_or(best()),
                                           options.arithmetic);
  const bool filters = filter && !separation;
  return for_chunks(queries.count, options.threads, [&](std::size_t first, std::size_t count) {
    std::fill_n(times + first, count, std::numeric_limits<double>::infinity());
    decide_survivors(queries, filters ? &filter : nullptr, first, count, [&](std::size_t i, const Real* points) {
      times[i] = time_of_impact(queries.kind, points, options.method, impact);
    });
  });
}

}  // namespace

template <class Real>
BatchStatus collides(const Queries<Real>& queries, unsigned char* results, const BatchOptions& options) noexcept {
  return collision_bytes(queries, results, options);
}
template <class Real>
BatchStatus collides(const MeshQueries<Real>& queries, unsigned char* results, const BatchOptions& options) noexcept {
  return collision_bytes(queries, results, options);
}
template <class Real>
BatchStatus collides_bits(const Queries<Real>& queries, unsigned char* bits, const BatchOptions& options) noexcept {
  return collision_bits(queries, bits, options);
}
template <class Real>
BatchStatus collides_bits(const MeshQueries<Real>& queries, unsigned char* bits, const BatchOptions& options) noexcept {
  return collision_bits(queries, bits, options);
}
template <class Real>
BatchStatus impact_times(const Queries<Real>& queries, double* times_of_impact, const ImpactOptions& impact,
                         const BatchOptions& options) noexcept {
  return times(queries, times_of_impact, impact, options);
}
template <class Real>
BatchStatus impact_times(const MeshQueries<Real>& queries, double* times_of_impact, const ImpactOptions& impact,
                         const BatchOptions& options) noexcept {
  return times(queries, times_of_impact, impact, options);
}

template BatchStatus collides(const Queries<double>&, unsigned char*, const BatchOptions&) noexcept;
template BatchStatus collides(const Queries<float>&, unsigned char*, const BatchOptions&) noexcept;
template BatchStatus collides(const MeshQueries<double>&, unsigned char*, const BatchOptions&) noexcept;
template BatchStatus collides(const MeshQueries<float>&, unsigned char*, const BatchOptions&) noexcept;
template BatchStatus collides_bits(const Queries<double>&, unsigned char*, const BatchOptions&) noexcept;
template BatchStatus collides_bits(const Queries<float>&, unsigned char*, const BatchOptions&) noexcept;
template BatchStatus collides_bits(const MeshQueries<double>&, unsigned char*, const BatchOptions&) noexcept;
template BatchStatus collides_bits(const MeshQueries<float>&, unsigned char*, const BatchOptions&) noexcept;
template BatchStatus impact_times(const Queries<double>&, double*, const ImpactOptions&, const BatchOptions&) noexcept;
template BatchStatus impact_times(const Queries<float>&, double*, const ImpactOptions&, const BatchOptions&) noexcept;
template BatchStatus impact_times(const MeshQueries<double>&, double*, const ImpactOptions&,
                                  const BatchOptions&) noexcept;
template BatchStatus impact_times(const MeshQueries<float>&, double*, const ImpactOptions&,
                                  const BatchOptions&) noexcept;

}  // namespace tightrope::ccd
