#include "ccd/classification.h"
#include "ccd/query.h"
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

namespace tightrope::ccd {

template <class Real>
bool tight_collides(Kind kind, const Real* points) {
  SignReader signs;
  return collides<bound::tight>(kind, points, signs);
}

template <class Real>
bool tight_collides(Kind kind, const Real* points, CountingSignReader& signs) {
  return collides<bound::tight>(kind, points, signs);
}

template bool tight_collides(Kind, const double*);
template bool tight_collides(Kind, const double*, CountingSignReader&);
template bool tight_collides(Kind, const float*);
template bool tight_collides(Kind, const float*, CountingSignReader&);

}  // namespace tightrope::ccd
