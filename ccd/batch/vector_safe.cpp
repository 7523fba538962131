/// SafeCCD on vectors (ccd/methods/safe_query.h): culling, and the hulls of the cubic and of the moments with the
/// method's bound.

#include <utility>

#include "ccd/batch/targets.h"
#include "ccd/batch/vector_tests.h"
#include "ccd/geometry.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ccd/batch/vector_safe.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#if TIGHTROPE_HAS_VECTORS
#include <tightrope/highway-inl.h>

HWY_BEFORE_NAMESPACE();
#include "edge_edge.safe.double.simd.h"
#include "edge_edge.safe.float.simd.h"
#include "edge_edge.tight.double.simd.h"
#include "edge_edge.tight.float.simd.h"
#include "vertex_face.safe.double.simd.h"
#include "vertex_face.safe.float.simd.h"
#include "vertex_face.tight.double.simd.h"
#include "vertex_face.tight.float.simd.h"

// After the generated headers:
#include "ccd/batch/vector_tests-inl.h"

namespace tightrope::TIGHTROPE_LANES {
namespace {

using namespace ccd;

template <Kind kind, class Real>
unsigned culling(const Real* numbers, std::size_t pitch) {
  const Tile<Real> tile(numbers, pitch);
  const auto apart = hn::Or(are_never_coplanar<kind, bound::safe>(tile), are_separated_on_axis<kind>(tile));
  return bits_of_others<Real>(hn::And(are_moderate(tile), apart));
}

/// The moments are the quadratics of the inside test, the names of the points the same (ccd/methods/safe_naming.h).
template <Kind kind, class Bound, class Real>
unsigned hulls(const Real* numbers, std::size_t pitch) {
  const Tile<Real> tile(numbers, pitch);
  const auto in_range = hn::And(are_moderate(tile), are_spread(tile));
  return bits_of_others<Real>(hn::And(in_range, are_excluded_by_hulls<kind, Bound>(tile)));
}

template <Kind kind, class Real>
batch::VectorTests<Real> tests(Method method) {
  switch (method) {
    case Method::safe:
      return {culling<kind, Real>, hulls<kind, bound::safe, Real>, nullptr};
    case Method::safe_tight:
      return {culling<kind, Real>, hulls<kind, bound::tight, Real>, nullptr};
    case Method::bsc_float:
    case Method::bsc_safe:
    case Method::tight:
    case Method::bsc_exact:
    case Method::tightrope:
      return {};
  }
  return {};
}

}  // namespace

template <class Real>
batch::VectorTests<Real> safe_tests(Method method, Kind kind) {
  return kind == Kind::vertex_face ? tests<Kind::vertex_face, Real>(method) : tests<Kind::edge_edge, Real>(method);
}

}  // namespace tightrope::TIGHTROPE_LANES
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE
namespace tightrope::ccd {

template <class Real>
batch::VectorTests<Real> batch::safe_tests(Method method, Kind kind, InstructionSet instructions) {
  switch (instructions) { TIGHTROPE_RETURN_FOR_INSTRUCTIONS(safe_tests<Real>(method, kind)) }
  return {};
}
template batch::VectorTests<double> batch::safe_tests(Method, Kind, InstructionSet);
template batch::VectorTests<float> batch::safe_tests(Method, Kind, InstructionSet);

}  // namespace tightrope::ccd
#endif
