#pragma once
/// All stages of a method on a chunk, enqueued; its counters are 0. `blocks`: as many as the device runs at a time.
/// Defined for each method in a file of its own.

#include <cuda_runtime.h>

#include "ccd/gpu/chunk.h"
#include "tightrope/method.h"

namespace tightrope::ccd::gpu {

template <Method M, class Real>
void launch(Kind kind, const Chunk<Real>& chunk, int blocks, cudaStream_t stream);

}  // namespace tightrope::ccd::gpu
