#include "classification.float.double.h"
#include "classification.float.float.h"
#include "classification.safe.double.h"
#include "classification.safe.float.h"
#include "classification.tight.double.h"
#include "classification.tight.float.h"
#include "edge_edge.float.double.h"
#include "edge_edge.float.float.h"
#include "edge_edge.safe.double.h"
#include "edge_edge.safe.float.h"
#include "edge_edge.tight.double.h"
#include "edge_edge.tight.float.h"
#include "vertex_face.float.double.h"
#include "vertex_face.float.float.h"
#include "vertex_face.safe.double.h"
#include "vertex_face.safe.float.h"
#include "vertex_face.tight.double.h"
#include "vertex_face.tight.float.h"

// After the generated headers:
#include "ccd/gpu/bsc_stages.h"
#include "tests/gpu/host_stages.h"

namespace tightrope::ccd::gpu {

template <Method M, class Real>
void run_on_host(Kind kind, const Chunk<Real>& chunk) {
  run_on_host_from<M, 0>(kind, chunk);
}

template void run_on_host<Method::bsc_float>(Kind, const Chunk<double>&);
template void run_on_host<Method::bsc_float>(Kind, const Chunk<float>&);
template void run_on_host<Method::bsc_safe>(Kind, const Chunk<double>&);
template void run_on_host<Method::bsc_safe>(Kind, const Chunk<float>&);
template void run_on_host<Method::tight>(Kind, const Chunk<double>&);
template void run_on_host<Method::tight>(Kind, const Chunk<float>&);

}  // namespace tightrope::ccd::gpu
