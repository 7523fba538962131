#include <algorithm>
#include <array>
#include <span>

#include "ccd/geometry.h"
#include "ccd/methods/safe_culling.h"
#include "ccd/query.h"
#include "edge_edge.float.double.h"
#include "edge_edge.float.float.h"
#include "edge_edge.safe.double.h"
#include "edge_edge.safe.float.h"
#include "tightrope/contact.h"
#include "vertex_face.float.double.h"
#include "vertex_face.float.float.h"
#include "vertex_face.safe.double.h"
#include "vertex_face.safe.float.h"

namespace tightrope::ccd {
namespace {

template <class Real>
Real largest_bound(const Bounded<Real> (&k)[4]) {
  return maximum(maximum(k[0].bound, k[1].bound), maximum(k[2].bound, k[3].bound));
}

/// Reads the signs of values of which the scene knows the bound.
template <class Real>
struct SceneSigns {
  Real bound;
  Sign operator()(const Bounded<Real>& x) const { return sign(Bounded<Real>{x.value, bound}); }
};

}  // namespace

/// The generated code derives k and the formula of B; its run-time maxima are B for points of which every difference
/// that it takes is B in every coordinate. So the bound that it gives for these holds for every query of the scene.
template <class Real>
SceneBound<Real>::SceneBound(Real largest_difference) : largest_difference_(largest_difference) {
  const std::array<Real, 3> zero{0, 0, 0}, far{largest_difference, largest_difference, largest_difference};
  const Real *o = zero.data(), *x = far.data();
  using Face = generated::vertex_face<bound::safe, Real>;
  using Edges = generated::edge_edge<bound::safe, Real>;
  typename Face::State face;
  typename Edges::State edges;
  vertex_face_ = largest_bound(Face::coplanarity(o, o, x, x, o, o, x, x, face).k);
  edge_edge_ = largest_bound(Edges::coplanarity(o, o, x, x, x, x, o, o, x, x, o, o, edges).k);
}

template <class Real>
bool SceneBound<Real>::never_coplanar(Kind kind, const Real* points) const {
  if (!has_moderate_coordinates(points) || !(spread(points) <= largest_difference_)) return false;
  const SceneSigns<Real> signs{kind == Kind::vertex_face ? vertex_face_ : edge_edge_};
  return safe::never_coplanar<bound::none>(kind, points, signs);
}

template class SceneBound<double>;
template class SceneBound<float>;

bool collides(Kind kind, const double* points, const SceneBound<double>& scene) {
  return !scene.never_coplanar(kind, points) && safe_collides(kind, points);
}
bool collides(Kind kind, const float* points, const SceneBound<float>& scene) {
  return !scene.never_coplanar(kind, points) && safe_collides(kind, points);
}

}  // namespace tightrope::ccd
