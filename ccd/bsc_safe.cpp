#include "ccd/classification.h"
#include "ccd/query.h"
#include "classification.safe.double.h"
#include "classification.safe.float.h"
#include "edge_edge.safe.double.h"
#include "edge_edge.safe.float.h"
#include "vertex_face.safe.double.h"
#include "vertex_face.safe.float.h"

namespace tightrope::ccd {

template <class Real>
bool bsc_safe_collides(Kind kind, const Real* points) {
  SignReader signs;
  return collides<bound::safe>(kind, points, signs);
}

template <class Real>
bool bsc_safe_collides(Kind kind, const Real* points, CountingSignReader& signs) {
  return collides<bound::safe>(kind, points, signs);
}

template bool bsc_safe_collides(Kind, const double*);
template bool bsc_safe_collides(Kind, const double*, CountingSignReader&);
template bool bsc_safe_collides(Kind, const float*);
template bool bsc_safe_collides(Kind, const float*, CountingSignReader&);

}  // namespace tightrope::ccd
