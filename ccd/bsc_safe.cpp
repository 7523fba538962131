#include "ccd/classification.h"
#include "ccd/query.h"
#include "classification.safe.double.h"
#include "edge_edge.safe.double.h"
#include "vertex_face.safe.double.h"

namespace tightrope::ccd {

bool bsc_safe_collides(Kind kind, const double* points) {
  SignReader signs;
  return collides<bound::safe>(kind, points, signs);
}

}  // namespace tightrope::ccd
