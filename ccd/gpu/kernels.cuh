#pragma once
/// One kernel a stage. The first runs over all queries of a chunk, the others over what the stage before has left;
/// lists are appended to by whole warps, one atomic addition each, so that no further pass packs them. Their order
/// differs from run to run, answers do not.

#include "ccd/gpu/chunk.h"
#include "ccd/gpu/launch.h"
#include "ccd/gpu/stages.h"

namespace tightrope::ccd::gpu {

inline constexpr int threads_per_block = 128;
inline constexpr int numbers = 24;
inline constexpr int lanes = 32;

/// Appends `i` to the list where `wanted`. All lanes of the warp call this together.
__device__ inline void append(bool wanted, Index i, Index* list, Index* count) {
  const unsigned asking = __ballot_sync(0xffffffffU, wanted);
  if (asking == 0) return;
  const int lane = static_cast<int>(threadIdx.x % lanes);
  const int leader = __ffs(static_cast<int>(asking)) - 1;
  Index first = 0;
  if (lane == leader) first = atomicAdd(count, static_cast<Index>(__popc(asking)));
  first = __shfl_sync(0xffffffffU, first, leader);
  if (wanted) list[first + static_cast<Index>(__popc(asking & ((1U << lane) - 1)))] = i;
}

/// Notes what a stage says of query i; `active`: there is one.
template <class Real, int Stage>
__device__ void note(const Chunk<Real>& chunk, bool active, Index i, Answer answer) {
  if (answer == Answer::touches && chunk.touching_is_open) answer = Answer::open;
  if (active && answer != Answer::next) chunk.results[i] = static_cast<unsigned char>(answer);
  append(active && answer == Answer::next, i, chunk.lists[Stage % 2], &chunk.counters->left[Stage]);
  append(active && answer == Answer::open, i, chunk.open, &chunk.counters->open);
}

/// The first stage. Queries that lie together are read by whole warps, in order, and turned round in shared memory, a
/// warp's queries 25 numbers apart: no two lanes of a half warp use one bank.
template <Method M, class Real, Kind K>
__global__ void __launch_bounds__(threads_per_block) first_stage(const Chunk<Real> chunk) {
  constexpr int padded = numbers + 1;
  __shared__ Real turned[threads_per_block * padded];
  const Index i = blockIdx.x * threads_per_block + threadIdx.x;
  const bool active = i < chunk.count;
  Answer answer = Answer::apart;
  if (chunk.coordinate_stride == 1) {
    const int lane = static_cast<int>(threadIdx.x % lanes);
    const Index first = i - static_cast<Index>(lane);
    Real* own = turned + (threadIdx.x - static_cast<unsigned>(lane)) * padded;
    const Real* from = chunk.points + static_cast<std::size_t>(first) * numbers;
    const int queries = first >= chunk.count          ? 0
                        : chunk.count - first < lanes ? static_cast<int>(chunk.count - first)
                                                      : lanes;
#pragma unroll
    for (int part = 0; part < numbers; ++part) {
      const int j = part * lanes + lane;
      if (j < queries * numbers) own[j / numbers * padded + j % numbers] = from[j];
    }
    __syncwarp();
    if (active) answer = Stages<M, Real>::template look<0>(K, own + lane * padded);
  } else if (active) {
    Real x[numbers];
#pragma unroll
    for (int c = 0; c < numbers; ++c) x[c] = chunk.points[static_cast<std::size_t>(c) * chunk.coordinate_stride + i];
    answer = Stages<M, Real>::template look<0>(K, x);
  }
  note<Real, 0>(chunk, active, i, answer);
}

/// A later stage, on what stage - 1 has left. Each warp takes the next 32 of them that are a whole grid farther.
template <Method M, class Real, Kind K, int Stage>
__global__ void __launch_bounds__(threads_per_block) later_stage(const Chunk<Real> chunk) {
  const Index* left = chunk.lists[(Stage - 1) % 2];
  const Index count = chunk.counters->left[Stage - 1];
  const Index lane = threadIdx.x % lanes;
  for (Index warp = blockIdx.x * threads_per_block + threadIdx.x - lane; warp < count;
       warp += gridDim.x * threads_per_block) {
    const bool active = warp + lane < count;
    const Index i = active ? left[warp + lane] : 0;
    Answer answer = Answer::apart;
    if (active) {
      Real x[numbers];
      const Real* from = chunk.points + static_cast<std::size_t>(i) * chunk.query_stride;
#pragma unroll
      for (int c = 0; c < numbers; ++c) x[c] = from[static_cast<std::size_t>(c) * chunk.coordinate_stride];
      answer = Stages<M, Real>::template look<Stage>(K, x);
    }
    __syncwarp();
    note<Real, Stage>(chunk, active, i, answer);
  }
}

/// Enqueues stages `Stage` .. of a chunk. `blocks`: as many as the device runs at a time.
template <Method M, class Real, Kind K, int Stage>
void launch_from(const Chunk<Real>& chunk, int blocks, cudaStream_t stream) {
  if constexpr (Stage < Stages<M, Real>::count) {
    if constexpr (Stage == 0) {
      const Index all = (chunk.count + threads_per_block - 1) / threads_per_block;
      first_stage<M, Real, K><<<all, threads_per_block, 0, stream>>>(chunk);
    } else {
      const Index most = (chunk.count + threads_per_block - 1) / threads_per_block;
      const Index some = most < static_cast<Index>(blocks) ? most : static_cast<Index>(blocks);
      later_stage<M, Real, K, Stage><<<some, threads_per_block, 0, stream>>>(chunk);
    }
    launch_from<M, Real, K, Stage + 1>(chunk, blocks, stream);
  }
}

template <Method M, class Real>
void launch(Kind kind, const Chunk<Real>& chunk, int blocks, cudaStream_t stream) {
  static_assert(Stages<M, Real>::count <= most_stages);
  switch (kind) {
    case Kind::vertex_face:
      launch_from<M, Real, Kind::vertex_face, 0>(chunk, blocks, stream);
      break;
    case Kind::edge_edge:
      launch_from<M, Real, Kind::edge_edge, 0>(chunk, blocks, stream);
      break;
  }
}

}  // namespace tightrope::ccd::gpu
