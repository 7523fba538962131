/// Bernstein sign classification on vectors (ccd/classification.h): points never coplanar, and the hulls with the
/// method's bound. `bsc_exact` begins as `tight` does.

#include <utility>

#include "ccd/batch/targets.h"
#include "ccd/batch/vector_tests.h"
#include "ccd/geometry.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ccd/batch/vector_bsc.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#if TIGHTROPE_HAS_VECTORS
#include <tightrope/highway-inl.h>

HWY_BEFORE_NAMESPACE();
#include "edge_edge.float.double.simd.h"
#include "edge_edge.float.float.simd.h"
#include "edge_edge.safe.double.simd.h"
#include "edge_edge.safe.float.simd.h"
#include "edge_edge.tight.double.simd.h"
#include "edge_edge.tight.float.simd.h"
#include "vertex_face.float.double.simd.h"
#include "vertex_face.float.float.simd.h"
#include "vertex_face.safe.double.simd.h"
#include "vertex_face.safe.float.simd.h"
#include "vertex_face.tight.double.simd.h"
#include "vertex_face.tight.float.simd.h"

// After the generated headers:
#include "ccd/batch/vector_tests-inl.h"

namespace tightrope::TIGHTROPE_LANES {
namespace {

using namespace ccd;

template <Kind kind, class FirstLook, class Real>
unsigned first_look(const Real* numbers, std::size_t pitch) {
  const Tile<Real> tile(numbers, pitch);
  return bits_of_others<Real>(hn::And(are_moderate(tile), are_never_coplanar<kind, FirstLook>(tile)));
}

/// The scalar code asks these one after another, with the decision tables between them; each is a reason of its own for
/// the answer `false`. Moderate coordinates that are spread leave it no earlier reason to answer `true`.
template <Kind kind, class Bound, class Real>
unsigned hulls(const Real* numbers, std::size_t pitch) {
  const Tile<Real> tile(numbers, pitch);
  const auto in_range = hn::And(are_moderate(tile), are_spread(tile));
  const auto excluded = hn::Or(are_excluded_by_hulls<kind, Bound>(tile), are_separated_on_axis<kind>(tile));
  return bits_of_others<Real>(hn::And(in_range, excluded));
}

template <Kind kind, class Real>
batch::VectorTests<Real> tests(Method method) {
  switch (method) {
    case Method::bsc_float:
      return {first_look<kind, bound::none, Real>, hulls<kind, bound::none, Real>, nullptr};
    case Method::bsc_safe:
      return {first_look<kind, bound::safe, Real>, hulls<kind, bound::safe, Real>, nullptr};
    case Method::tight:
      return {first_look<kind, bound::safe, Real>, hulls<kind, bound::tight, Real>, nullptr};
    case Method::bsc_exact:
      if constexpr (sizeof(Real) == 8) {
        return {first_look<kind, bound::safe, Real>, hulls<kind, bound::tight, Real>, nullptr};
      } else {  // exact: any proof will do, and those in double are sharper
        return {first_look<kind, bound::safe, Real>, nullptr, hulls<kind, bound::tight, double>};
      }
    case Method::safe:
    case Method::safe_tight:
    case Method::tightrope:
      return {};
  }
  return {};
}

}  // namespace

template <class Real>
batch::VectorTests<Real> bsc_tests(Method method, Kind kind) {
  return kind == Kind::vertex_face ? tests<Kind::vertex_face, Real>(method) : tests<Kind::edge_edge, Real>(method);
}

}  // namespace tightrope::TIGHTROPE_LANES
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE
namespace tightrope::ccd {

template <class Real>
batch::VectorTests<Real> batch::bsc_tests(Method method, Kind kind, InstructionSet instructions) {
  switch (instructions) { TIGHTROPE_RETURN_FOR_INSTRUCTIONS(bsc_tests<Real>(method, kind)) }
  return {};
}
template batch::VectorTests<double> batch::bsc_tests(Method, Kind, InstructionSet);
template batch::VectorTests<float> batch::bsc_tests(Method, Kind, InstructionSet);

}  // namespace tightrope::ccd
#endif
