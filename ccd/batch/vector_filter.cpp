/// The vector stages over a chunk: queries into lanes, the tests of the method, and what they leave into the next one's
/// lanes.

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "ccd/batch/filter.h"
#include "ccd/batch/source.h"
#include "ccd/batch/targets.h"
#include "ccd/batch/vector_tests.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ccd/batch/vector_filter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#if TIGHTROPE_HAS_VECTORS
HWY_BEFORE_NAMESPACE();
namespace tightrope::lanes::HWY_NAMESPACE {
namespace {

using namespace ccd;
using batch::Index;
namespace hn = hwy::HWY_NAMESPACE;

template <class Real>
constexpr std::size_t number_of_lanes = hn::MaxLanes(hn::ScalableTag<Real>());

/// Coordinates first: number c of the query in lane i is at [c * lanes + i].
template <class Real>
struct Tile {
  HWY_ALIGN Real numbers[numbers_per_query * number_of_lanes<Real>];
};

/// The 128-bit blocks at p, p + stride, p + 2 stride, ..: as many as the vector has.
template <class D>
HWY_INLINE hn::Vec<D> blocks(D d, const hn::TFromD<D>* p, std::size_t stride) {
  constexpr std::size_t count = hn::MaxLanes(D()) * sizeof(hn::TFromD<D>) / 16;
  if constexpr (count == 1) {
    return hn::LoadU(d, p);
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, blocks(half, p + count / 2 * stride, stride), blocks(half, p, stride));
  }
}

/// Queries that lie one after another: a transposition in registers.
HWY_INLINE void transpose(const double* queries, Tile<double>& tile) {
  const hn::ScalableTag<double> d;
  constexpr std::size_t n = number_of_lanes<double>;
  for (std::size_t c = 0; c < numbers_per_query; c += 2) {
    const auto even = blocks(d, queries + c, 2 * numbers_per_query);
    const auto odd = blocks(d, queries + c + numbers_per_query, 2 * numbers_per_query);
    hn::Store(hn::InterleaveLower(d, even, odd), d, tile.numbers + c * n);
    hn::Store(hn::InterleaveUpper(d, even, odd), d, tile.numbers + (c + 1) * n);
  }
}
HWY_INLINE void transpose(const float* queries, Tile<float>& tile) {
  const hn::ScalableTag<float> d;
  const hn::RepartitionToWide<decltype(d)> pairs;
  constexpr std::size_t n = number_of_lanes<float>;
  const auto store = [&](auto pair_of_lanes, std::size_t c)
                         HWY_ATTR { hn::Store(hn::BitCast(d, pair_of_lanes), d, tile.numbers + c * n); };
  for (std::size_t c = 0; c < numbers_per_query; c += 4) {
    const auto q0 = blocks(d, queries + c, 4 * numbers_per_query);
    const auto q1 = blocks(d, queries + c + numbers_per_query, 4 * numbers_per_query);
    const auto q2 = blocks(d, queries + c + 2 * numbers_per_query, 4 * numbers_per_query);
    const auto q3 = blocks(d, queries + c + 3 * numbers_per_query, 4 * numbers_per_query);
    const auto low_01 = hn::BitCast(pairs, hn::InterleaveLower(d, q0, q1));
    const auto low_23 = hn::BitCast(pairs, hn::InterleaveLower(d, q2, q3));
    const auto high_01 = hn::BitCast(pairs, hn::InterleaveUpper(d, q0, q1));
    const auto high_23 = hn::BitCast(pairs, hn::InterleaveUpper(d, q2, q3));
    store(hn::InterleaveLower(pairs, low_01, low_23), c);
    store(hn::InterleaveUpper(pairs, low_01, low_23), c + 1);
    store(hn::InterleaveLower(pairs, high_01, high_23), c + 2);
    store(hn::InterleaveUpper(pairs, high_01, high_23), c + 3);
  }
}

/// Query i into one lane.
template <template <class> class Source, class Real, class Number>
void place(const Source<Real>& queries, std::size_t i, Tile<Number>& tile, std::size_t lane) {
  std::array<Real, numbers_per_query> copy;
  const Real* points = batch::points_of(queries, i, copy);
  for (std::size_t c = 0; c < numbers_per_query; ++c) {
    tile.numbers[c * number_of_lanes<Number> + lane] = static_cast<Number>(points[c]);
  }
}

/// Asks for what is needed some microseconds later, into the second cache: the hardware foresees few streams, and the
/// transposition leaves its first cache no misses to spare.
template <class Real>
HWY_INLINE void prefetch(const Queries<Real>& queries, std::size_t i) {
  constexpr std::size_t line = 64 / sizeof(Real);
  constexpr int into_second_cache = 2;
  if (queries.layout == Layout::by_coordinate) {
    const std::size_t ahead = std::min(i + 8 * line, queries.count - 1);
    for (std::size_t c = 0; c < numbers_per_query; ++c) {
      __builtin_prefetch(queries.points + c * queries.pitch + ahead, 0, into_second_cache);
    }
  } else {
    constexpr std::size_t numbers = numbers_per_query * number_of_lanes<Real>;
    const std::size_t ahead = std::min(numbers_per_query * i + 256 * line, numbers_per_query * queries.count - numbers);
    for (std::size_t n = 0; n < numbers; n += line) {
      __builtin_prefetch(queries.points + ahead + n, 0, into_second_cache);
    }
  }
}

/// The test of as many queries as there are lanes, from i on.
template <class Real>
HWY_INLINE unsigned run_full(const Queries<Real>& queries, std::size_t i, batch::VectorTest<Real> test) {
  prefetch(queries, i);
  if (queries.layout == Layout::by_coordinate) return test(queries.points + i, queries.pitch);
  Tile<Real> tile;
  transpose(queries.points + numbers_per_query * i, tile);
  return test(tile.numbers, number_of_lanes<Real>);
}

/// The 128-bit blocks at places[0] + offset, places[2] + offset, ..: as many as the vector has.
template <class D>
HWY_INLINE hn::Vec<D> blocks_at(D d, const double* const* places, std::size_t offset) {
  constexpr std::size_t count = hn::MaxLanes(D()) / 2;
  if constexpr (count == 1) {
    return hn::LoadU(d, places[0] + offset);
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, blocks_at(half, places + count, offset), blocks_at(half, places, offset));
  }
}

/// Queries whose vertices lie anywhere.
template <class Real>
HWY_INLINE void gather(const MeshQueries<Real>& queries, std::size_t i, Tile<Real>& tile) {
  for (std::size_t lane = 0; lane < number_of_lanes<Real>; ++lane) place(queries, i + lane, tile, lane);
}
template <>
HWY_INLINE void gather(const MeshQueries<double>& queries, std::size_t i, Tile<double>& tile) {
  const hn::ScalableTag<double> d;
  constexpr std::size_t n = number_of_lanes<double>;
  double* to = tile.numbers;
  for (const double* vertices : {queries.vertices_t0, queries.vertices_t1}) {
    for (std::size_t point = 0; point < 4; ++point, to += 3 * n) {
      const double* places[n];
      for (std::size_t lane = 0; lane < n; ++lane) {
        places[lane] = vertices + std::size_t{3} * queries.indices[4 * (i + lane) + point];
      }
      const auto even_xy = blocks_at(d, places, 0), odd_xy = blocks_at(d, places + 1, 0);
      const auto even_yz = blocks_at(d, places, 1), odd_yz = blocks_at(d, places + 1, 1);
      hn::Store(hn::InterleaveLower(d, even_xy, odd_xy), d, to);
      hn::Store(hn::InterleaveUpper(d, even_xy, odd_xy), d, to + n);
      hn::Store(hn::InterleaveUpper(d, even_yz, odd_yz), d, to + 2 * n);
    }
  }
}
template <class Real>
HWY_INLINE unsigned run_full(const MeshQueries<Real>& queries, std::size_t i, batch::VectorTest<Real> test) {
  Tile<Real> tile;
  gather(queries, i, tile);
  return test(tile.numbers, number_of_lanes<Real>);
}

/// Appends the indices `index(lane)` of the lanes whose bit is set.
template <class IndexOf>
HWY_INLINE void append(unsigned bits, const IndexOf& index, Index* survivors, std::size_t& count) {
  for (; bits != 0; bits &= bits - 1) {
    survivors[count++] = static_cast<Index>(index(static_cast<std::size_t>(std::countr_zero(bits))));
  }
}

/// The survivors of one more test, in place: those of a group of lanes are written where its indices have been read.
template <class Number, class Source>
std::size_t filter_again(const Source& queries, std::size_t first, batch::VectorTest<Number> test, Index* survivors,
                         std::size_t count) {
  constexpr std::size_t lanes = number_of_lanes<Number>;
  std::size_t left = 0;
  Tile<Number> tile;
  for (std::size_t s = 0; s < count; s += lanes) {
    const std::size_t here = std::min(lanes, count - s);
    std::array<Index, lanes> group{};
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      group[lane] = survivors[s + std::min(lane, here - 1)];  // idle lanes repeat the last query
      place(queries, first + group[lane], tile, lane);
    }
    const unsigned bits = test(tile.numbers, lanes) & ((1U << here) - 1);
    append(
        bits, [&](std::size_t lane) HWY_ATTR { return group[lane]; }, survivors, left);
  }
  return left;
}

template <template <class> class Source, class Real>
std::size_t filter(const Source<Real>& queries, const batch::VectorTests<Real>& tests, std::size_t first,
                   std::size_t count, Index* survivors) {
  constexpr std::size_t lanes = number_of_lanes<Real>;
  std::size_t left = 0;
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    append(
        run_full(queries, first + i, tests.first), [&](std::size_t lane) HWY_ATTR { return i + lane; }, survivors,
        left);
  }
  if (i < count) {
    Tile<Real> tile;
    for (std::size_t lane = 0; lane < lanes; ++lane) place(queries, first + std::min(i + lane, count - 1), tile, lane);
    const unsigned bits = tests.first(tile.numbers, lanes) & ((1U << (count - i)) - 1);
    append(
        bits, [&](std::size_t lane) HWY_ATTR { return i + lane; }, survivors, left);
  }
  if (tests.second != nullptr) left = filter_again<Real>(queries, first, tests.second, survivors, left);
  if (tests.second_in_double != nullptr) {
    left = filter_again<double>(queries, first, tests.second_in_double, survivors, left);
  }
  return left;
}

}  // namespace

template <template <class> class Source, class Real>
batch::RunFilter<Source, Real> run_filter() {
  return filter<Source, Real>;
}

}  // namespace tightrope::lanes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE
namespace tightrope::ccd::batch {
namespace {

template <template <class> class Source, class Real>
RunFilter<Source, Real> run_filter(InstructionSet instructions) {
  switch (instructions) { TIGHTROPE_RETURN_FOR_INSTRUCTIONS(run_filter<Source, Real>()) }
  return nullptr;
}

template <class Real>
VectorTests<Real> tests(Method method, Kind kind, InstructionSet instructions, Arithmetic arithmetic) {
  if (arithmetic == Arithmetic::fused && method != Method::tightrope) return {};
  switch (method) {
    case Method::bsc_float:
    case Method::bsc_safe:
    case Method::tight:
    case Method::bsc_exact:
      return bsc_tests<Real>(method, kind, instructions);
    case Method::safe:
    case Method::safe_tight:
      return safe_tests<Real>(method, kind, instructions);
    case Method::tightrope:
      return tightrope_tests<Real>(kind, instructions, arithmetic);
  }
  return {};
}

}  // namespace

template <template <class> class Source, class Real>
Filter<Source, Real>::Filter(Method method, Kind kind, InstructionSet instructions, Arithmetic arithmetic)
    : run_(run_filter<Source, Real>(instructions)), tests_(tests<Real>(method, kind, instructions, arithmetic)) {}

template class Filter<Queries, double>;
template class Filter<Queries, float>;
template class Filter<MeshQueries, double>;
template class Filter<MeshQueries, float>;

}  // namespace tightrope::ccd::batch

namespace tightrope::ccd {

std::span<const InstructionSet> instruction_sets() {
  struct There {
    std::array<InstructionSet, 5> sets{InstructionSet::scalar};
    std::size_t count = 1;
  };
  static const There there = [] {
    There result;
    const std::int64_t targets = hwy::SupportedTargets() & HWY_TARGETS;
    const auto add = [&](std::int64_t target, InstructionSet set) {
      if (targets & target) result.sets[result.count++] = set;
    };
    add(HWY_SSE4, InstructionSet::sse4);
    add(HWY_NEON, InstructionSet::neon);
    add(HWY_AVX2, InstructionSet::avx2);
    add(HWY_AVX3, InstructionSet::avx512);
    return result;
  }();
  return std::span(there.sets).first(there.count);
}

}  // namespace tightrope::ccd
#endif
