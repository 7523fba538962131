#include "edge_edge.safe.double.h"
#include "edge_edge.tight.double.h"
#include "separating_plane.safe.double.h"
#include "separating_plane.safe.float.h"
#include "subdivision.float.double.h"
#include "subdivision.tight.double.h"
#include "vertex_face.safe.double.h"
#include "vertex_face.tight.double.h"

// After the generated headers:
#include "ccd/gpu/tightrope_stages.h"
#include "tests/gpu/host_stages.h"

namespace tightrope::ccd::gpu {

template <Method M, class Real>
void run_on_host(Kind kind, const Chunk<Real>& chunk) {
  run_on_host_from<M, 0>(kind, chunk);
}

template void run_on_host<Method::tightrope>(Kind, const Chunk<double>&);
template void run_on_host<Method::tightrope>(Kind, const Chunk<float>&);

}  // namespace tightrope::ccd::gpu
