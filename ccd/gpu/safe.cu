#include "edge_edge.safe.double.h"
#include "edge_edge.safe.float.h"
#include "safe_cubic.float.double.h"
#include "safe_cubic.float.float.h"
#include "safe_cubic.safe.double.h"
#include "safe_cubic.safe.float.h"
#include "safe_culling.safe.double.h"
#include "safe_culling.safe.float.h"
#include "safe_inside.float.double.h"
#include "safe_inside.float.float.h"
#include "safe_inside.safe.double.h"
#include "safe_inside.safe.float.h"
#include "vertex_face.safe.double.h"
#include "vertex_face.safe.float.h"

// After the generated headers:
#include "ccd/gpu/kernels.cuh"
#include "ccd/gpu/safe_stages.h"

namespace tightrope::ccd::gpu {
template void launch<Method::safe>(Kind, const Chunk<double>&, int, cudaStream_t);
template void launch<Method::safe>(Kind, const Chunk<float>&, int, cudaStream_t);
}  // namespace tightrope::ccd::gpu
