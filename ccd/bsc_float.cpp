#include "ccd/classification.h"
#include "ccd/query.h"
#include "classification.float.double.h"
#include "classification.float.float.h"
#include "edge_edge.float.double.h"
#include "edge_edge.float.float.h"
#include "vertex_face.float.double.h"
#include "vertex_face.float.float.h"

namespace tightrope::ccd {

template <class Real>
bool bsc_float_collides(Kind kind, const Real* points) {
  SignReader signs;
  return collides<bound::none>(kind, points, signs);
}

template <class Real>
bool bsc_float_collides(Kind kind, const Real* points, CountingSignReader& signs) {
  return collides<bound::none>(kind, points, signs);
}

template bool bsc_float_collides(Kind, const double*);
template bool bsc_float_collides(Kind, const double*, CountingSignReader&);
template bool bsc_float_collides(Kind, const float*);
template bool bsc_float_collides(Kind, const float*, CountingSignReader&);

}  // namespace tightrope::ccd
