#include "ccd/classification.h"
#include "ccd/query.h"
#include "classification.float.double.h"
#include "edge_edge.float.double.h"
#include "vertex_face.float.double.h"

namespace tightrope::ccd {

bool bsc_float_collides(Kind kind, const double* points) {
  SignReader signs;
  return collides<bound::none>(kind, points, signs);
}

}  // namespace tightrope::ccd
