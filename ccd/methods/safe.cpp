#include "ccd/methods/safe_query.h"
#include "ccd/query.h"
#include "edge_edge.safe.double.h"
#include "edge_edge.safe.float.h"
#include "safe_cubic.float.double.h"
#include "safe_cubic.float.float.h"
#include "safe_cubic.safe.double.h"
#include "safe_cubic.safe.float.h"
#include "safe_inside.float.double.h"
#include "safe_inside.float.float.h"
#include "safe_inside.safe.double.h"
#include "safe_inside.safe.float.h"
#include "vertex_face.safe.double.h"
#include "vertex_face.safe.float.h"

namespace tightrope::ccd {

template <class Real>
bool safe_collides(Kind kind, const Real* points) {
  SignReader signs;
  return safe::first_contact<bound::safe>(kind, points, signs).has_value();
}

template <class Real>
bool safe_collides(Kind kind, const Real* points, CountingSignReader& signs) {
  return safe::first_contact<bound::safe>(kind, points, signs).has_value();
}

template bool safe_collides(Kind, const double*);
template bool safe_collides(Kind, const double*, CountingSignReader&);
template bool safe_collides(Kind, const float*);
template bool safe_collides(Kind, const float*, CountingSignReader&);

}  // namespace tightrope::ccd
