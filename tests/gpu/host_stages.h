#pragma once
/// The stages of a method, run by the processor as the kernels run them: list after list.

#include "ccd/gpu/chunk.h"
#include "ccd/gpu/stages.h"

namespace tightrope::ccd::gpu {

inline constexpr int numbers_a_query = 24;

template <class Real>
void note_on_host(const Chunk<Real>& chunk, int stage, Index i, Answer answer) {
  if (answer == Answer::touches && chunk.touching_is_open) answer = Answer::open;
  if (answer == Answer::next) {
    chunk.lists[stage % 2][chunk.counters->left[stage]++] = i;
  } else {
    chunk.results[i] = static_cast<unsigned char>(answer);
    if (answer == Answer::open) chunk.open[chunk.counters->open++] = i;
  }
}

template <Method M, int Stage, class Real>
void run_on_host_from(Kind kind, const Chunk<Real>& chunk) {
  if constexpr (Stage < Stages<M, Real>::count) {
    const Index count = Stage == 0 ? chunk.count : chunk.counters->left[Stage == 0 ? 0 : Stage - 1];
    for (Index entry = 0; entry < count; ++entry) {
      const Index i = Stage == 0 ? entry : chunk.lists[(Stage + 1) % 2][entry];
      Real x[numbers_a_query];
      for (std::size_t c = 0; c < numbers_a_query; ++c) {
        x[c] = chunk.points[i * chunk.query_stride + c * chunk.coordinate_stride];
      }
      note_on_host(chunk, Stage, i, Stages<M, Real>::template look<Stage>(kind, x));
    }
    run_on_host_from<M, Stage + 1>(kind, chunk);
  }
}

/// All stages; the counters are 0. Defined for each method in host_*.cpp.
template <Method M, class Real>
void run_on_host(Kind kind, const Chunk<Real>& chunk);

}  // namespace tightrope::ccd::gpu
