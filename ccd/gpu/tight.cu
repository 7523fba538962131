#include "classification.tight.double.h"
#include "classification.tight.float.h"
#include "edge_edge.safe.double.h"
#include "edge_edge.safe.float.h"
#include "edge_edge.tight.double.h"
#include "edge_edge.tight.float.h"
#include "vertex_face.safe.double.h"
#include "vertex_face.safe.float.h"
#include "vertex_face.tight.double.h"
#include "vertex_face.tight.float.h"

// After the generated headers:
#include "ccd/gpu/bsc_stages.h"
#include "ccd/gpu/kernels.cuh"

namespace tightrope::ccd::gpu {
template void launch<Method::tight>(Kind, const Chunk<double>&, int, cudaStream_t);
template void launch<Method::tight>(Kind, const Chunk<float>&, int, cudaStream_t);
}  // namespace tightrope::ccd::gpu
