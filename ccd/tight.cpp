#include "ccd/classification.h"
#include "ccd/query.h"
#include "classification.tight.double.h"
#include "edge_edge.safe.double.h"
#include "edge_edge.tight.double.h"
#include "vertex_face.safe.double.h"
#include "vertex_face.tight.double.h"

namespace tightrope::ccd {

bool tight_collides(Kind kind, const double* points) {
  SignReader signs;
  return collides<bound::tight>(kind, points, signs);
}

}  // namespace tightrope::ccd
