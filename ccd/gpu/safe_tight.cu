#include "edge_edge.safe.double.h"
#include "edge_edge.safe.float.h"
#include "edge_edge.tight.double.h"
#include "edge_edge.tight.float.h"
#include "safe_cubic.float.double.h"
#include "safe_cubic.float.float.h"
#include "safe_cubic.tight.double.h"
#include "safe_cubic.tight.float.h"
#include "safe_culling.tight.double.h"
#include "safe_culling.tight.float.h"
#include "safe_inside.float.double.h"
#include "safe_inside.float.float.h"
#include "safe_inside.tight.double.h"
#include "safe_inside.tight.float.h"
#include "vertex_face.safe.double.h"
#include "vertex_face.safe.float.h"
#include "vertex_face.tight.double.h"
#include "vertex_face.tight.float.h"

// After the generated headers:
#include "ccd/gpu/kernels.cuh"
#include "ccd/gpu/safe_stages.h"

namespace tightrope::ccd::gpu {
template void launch<Method::safe_tight>(Kind, const Chunk<double>&, int, cudaStream_t);
template void launch<Method::safe_tight>(Kind, const Chunk<float>&, int, cudaStream_t);
}  // namespace tightrope::ccd::gpu
