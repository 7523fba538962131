#pragma once
/// What a device works on at a time, as kernels see it.

#include <cstddef>
#include <cstdint>

#include "tightrope/batch.h"

namespace tightrope::ccd::gpu {

/// Queries of a chunk, by their number in it.
using Index = std::uint32_t;

inline constexpr int most_stages = 4;

/// Counters of a chunk; 0 before the first stage.
struct Counters {
  Index left[most_stages];  ///< by stage: queries that it leaves to the next
  Index open;
};

/// Memory of the device.
template <class Real>
struct Chunk {
  const Real* points;
  std::size_t query_stride;       ///< number c of query i is points[i * query_stride + c * coordinate_stride]
  std::size_t coordinate_stride;  ///< one of the strides is 1
  Index count;
  unsigned char* results;  ///< `count` bytes
  Index* lists[2];         ///< `count` each, by turns: what a stage gets, and what it leaves
  Index* open;             ///< `count`: queries for exact arithmetic; their result bytes are 2
  Counters* counters;
  bool touching_is_open;  ///< exact arithmetic decides where bounds say `touches`
};

}  // namespace tightrope::ccd::gpu
