#include "ccd/methods/safe_contact.h"
#include "ccd/methods/safe_query.h"
#include "ccd/query.h"
#include "edge_edge.safe.double.h"
#include "edge_edge.safe.float.h"
#include "edge_edge.tight.double.h"
#include "edge_edge.tight.float.h"
#include "safe_cubic.float.double.h"
#include "safe_cubic.float.float.h"
#include "safe_cubic.tight.double.h"
#include "safe_cubic.tight.float.h"
#include "safe_culling.tight.double.h"
#include "safe_culling.tight.float.h"
#include "safe_inside.float.double.h"
#include "safe_inside.float.float.h"
#include "safe_inside.tight.double.h"
#include "safe_inside.tight.float.h"
#include "vertex_face.safe.double.h"
#include "vertex_face.safe.float.h"
#include "vertex_face.tight.double.h"
#include "vertex_face.tight.float.h"

namespace tightrope::ccd {

template <class Real>
bool safe_tight_collides(Kind kind, const Real* points) {
  SignReader signs;
  return safe::collides<bound::tight>(kind, points, signs);
}

template <class Real>
bool safe_tight_collides(Kind kind, const Real* points, CountingSignReader& signs) {
  return safe::collides<bound::tight>(kind, points, signs);
}

template bool safe_tight_collides(Kind, const double*);
template bool safe_tight_collides(Kind, const double*, CountingSignReader&);
template bool safe_tight_collides(Kind, const float*);
template bool safe_tight_collides(Kind, const float*, CountingSignReader&);

template <class Real>
std::optional<Contact<Real>> safe_tight_contact(Kind kind, const Real* points) {
  SignReader signs;
  return safe::contact<bound::tight>(kind, points, signs);
}

template std::optional<Contact<double>> safe_tight_contact(Kind, const double*);
template std::optional<Contact<float>> safe_tight_contact(Kind, const float*);

}  // namespace tightrope::ccd
