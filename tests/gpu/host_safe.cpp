#include "edge_edge.safe.double.h"
#include "edge_edge.safe.float.h"
#include "edge_edge.tight.double.h"
#include "edge_edge.tight.float.h"
#include "safe_cubic.float.double.h"
#include "safe_cubic.float.float.h"
#include "safe_cubic.safe.double.h"
#include "safe_cubic.safe.float.h"
#include "safe_cubic.tight.double.h"
#include "safe_cubic.tight.float.h"
#include "safe_culling.safe.double.h"
#include "safe_culling.safe.float.h"
#include "safe_culling.tight.double.h"
#include "safe_culling.tight.float.h"
#include "safe_inside.float.double.h"
#include "safe_inside.float.float.h"
#include "safe_inside.safe.double.h"
#include "safe_inside.safe.float.h"
#include "safe_inside.tight.double.h"
#include "safe_inside.tight.float.h"
#include "vertex_face.safe.double.h"
#include "vertex_face.safe.float.h"
#include "vertex_face.tight.double.h"
#include "vertex_face.tight.float.h"

// After the generated headers:
#include "ccd/gpu/safe_stages.h"
#include "tests/gpu/host_stages.h"

namespace tightrope::ccd::gpu {

template <Method M, class Real>
void run_on_host(Kind kind, const Chunk<Real>& chunk) {
  run_on_host_from<M, 0>(kind, chunk);
}

template void run_on_host<Method::safe>(Kind, const Chunk<double>&);
template void run_on_host<Method::safe>(Kind, const Chunk<float>&);
template void run_on_host<Method::safe_tight>(Kind, const Chunk<double>&);
template void run_on_host<Method::safe_tight>(Kind, const Chunk<float>&);

}  // namespace tightrope::ccd::gpu
