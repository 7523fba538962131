#include "edge_edge.safe.double.h"
#include "edge_edge.tight.double.h"
#include "separating_plane.safe.double.h"
#include "separating_plane.safe.float.h"
#include "subdivision.float.double.h"
#include "subdivision.tight.double.h"
#include "vertex_face.safe.double.h"
#include "vertex_face.tight.double.h"

// After the generated headers:
#include "ccd/gpu/kernels.cuh"
#include "ccd/gpu/tightrope_stages.h"

namespace tightrope::ccd::gpu {
template void launch<Method::tightrope>(Kind, const Chunk<double>&, int, cudaStream_t);
template void launch<Method::tightrope>(Kind, const Chunk<float>&, int, cudaStream_t);
}  // namespace tightrope::ccd::gpu
