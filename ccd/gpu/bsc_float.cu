#include "classification.float.double.h"
#include "classification.float.float.h"
#include "edge_edge.float.double.h"
#include "edge_edge.float.float.h"
#include "vertex_face.float.double.h"
#include "vertex_face.float.float.h"

// After the generated headers:
#include "ccd/gpu/bsc_stages.h"
#include "ccd/gpu/kernels.cuh"

namespace tightrope::ccd::gpu {
template void launch<Method::bsc_float>(Kind, const Chunk<double>&, int, cudaStream_t);
template void launch<Method::bsc_float>(Kind, const Chunk<float>&, int, cudaStream_t);
}  // namespace tightrope::ccd::gpu
