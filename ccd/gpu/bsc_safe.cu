#include "classification.safe.double.h"
#include "classification.safe.float.h"
#include "edge_edge.safe.double.h"
#include "edge_edge.safe.float.h"
#include "vertex_face.safe.double.h"
#include "vertex_face.safe.float.h"

// After the generated headers:
#include "ccd/gpu/bsc_stages.h"
#include "ccd/gpu/kernels.cuh"

namespace tightrope::ccd::gpu {
template void launch<Method::bsc_safe>(Kind, const Chunk<double>&, int, cudaStream_t);
template void launch<Method::bsc_safe>(Kind, const Chunk<float>&, int, cudaStream_t);
}  // namespace tightrope::ccd::gpu
