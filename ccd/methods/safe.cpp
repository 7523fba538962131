#include "ccd/methods/safe_contact.h"
#include "ccd/methods/safe_query.h"
#include "ccd/query.h"
#include "edge_edge.safe.double.h"
#include "edge_edge.safe.float.h"
#include "safe_cubic.float.double.h"
#include "safe_cubic.float.float.h"
#include "safe_cubic.safe.double.h"
#include "safe_cubic.safe.float.h"
#include "safe_culling.safe.double.h"
#include "safe_culling.safe.float.h"
#include "safe_inside.float.double.h"
#include "safe_inside.float.float.h"
#include "safe_inside.safe.double.h"
#include "safe_inside.safe.float.h"
#include "safe_inside.tight.double.h"
#include "safe_inside.tight.float.h"
#include "vertex_face.safe.double.h"
#include "vertex_face.safe.float.h"

namespace tightrope::ccd {

template <class Real>
bool safe_collides(Kind kind, const Real* points) {
  SignReader signs;
  return safe::collides<bound::safe>(kind, points, signs);
}

template <class Real>
bool safe_collides(Kind kind, const Real* points, CountingSignReader& signs) {
  return safe::collides<bound::safe>(kind, points, signs);
}

template bool safe_collides(Kind, const double*);
template bool safe_collides(Kind, const double*, CountingSignReader&);
template bool safe_collides(Kind, const float*);
template bool safe_collides(Kind, const float*, CountingSignReader&);

template <class Real>
std::optional<Contact<Real>> safe_contact(Kind kind, const Real* points) {
  SignReader signs;
  return safe::contact<bound::safe>(kind, points, signs);
}

template std::optional<Contact<double>> safe_contact(Kind, const double*);
template std::optional<Contact<float>> safe_contact(Kind, const float*);

}  // namespace tightrope::ccd
