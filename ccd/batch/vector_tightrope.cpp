/// Method `tightrope` on vectors (ccd/impact/filter.h): its first look, and the later filters in one.

#include <limits>
#include <utility>

#include "ccd/batch/targets.h"
#include "ccd/batch/vector_tests.h"
#include "ccd/geometry.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ccd/batch/vector_tightrope.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#if TIGHTROPE_HAS_VECTORS
#include <tightrope/highway-inl.h>

HWY_BEFORE_NAMESPACE();
#include "edge_edge.tight.double.simd.h"
#include "separating_plane.safe.double.simd.h"
#include "separating_plane.safe.float.simd.h"
#include "vertex_face.tight.double.simd.h"

// After the generated headers:
#include "ccd/batch/vector_tests-inl.h"

#if HWY_NATIVE_FMA
#undef TIGHTROPE_LANES
#define TIGHTROPE_LANES lanes::HWY_NAMESPACE::fused  // Lanes is that of the namespace around it
#include "fused/separating_plane.safe.double.simd.h"
#include "fused/separating_plane.safe.float.simd.h"
#undef TIGHTROPE_LANES
#define TIGHTROPE_LANES lanes::HWY_NAMESPACE
#endif

namespace tightrope::TIGHTROPE_LANES {
namespace {

using namespace ccd;

template <Kind kind, class Real>
unsigned first_look(const Real* numbers, std::size_t pitch) {
  return bits_of_others<Real>(are_separated_by_plane<kind, true>(Tile<Real>(numbers, pitch)));
}

#if HWY_NATIVE_FMA
/// The predicates of the first look with products contracted into sums, and bounds of their own (codegen/fuse.h).
template <Kind kind, class Real>
unsigned fused_first_look(const Real* numbers, std::size_t pitch) {
  return bits_of_others<Real>(are_separated_by_plane<kind, true, Real, fused::plane_of_face, fused::plane_of_edges>(
      Tile<Real>(numbers, pitch)));
}
#endif

template <Kind kind>
unsigned later_filters(const double* numbers, std::size_t pitch) {
  const Tile<double> tile(numbers, pitch);
  const auto finite = are_within<double>(tile, std::numeric_limits<double>::max());
  const auto separated = hn::Or(are_separated_on_axis<kind>(tile), are_separated_by_plane<kind, false>(tile));
  const auto in_range = hn::And(are_moderate(tile), are_spread(tile));
  const auto excluded = hn::And(in_range, are_excluded_by_hulls<kind, bound::tight>(tile));
  return bits_of_others<double>(hn::Or(hn::And(finite, separated), excluded));
}

template <Kind kind, class Real>
batch::VectorTest<Real> first_look_in(Arithmetic arithmetic) {
  if (arithmetic == Arithmetic::separate) return first_look<kind, Real>;
#if HWY_NATIVE_FMA
  return fused_first_look<kind, Real>;
#else
  return nullptr;
#endif
}

template <Kind kind, class Real>
batch::VectorTests<Real> tests(Arithmetic arithmetic) {
  if constexpr (sizeof(Real) == 8) {
    return {first_look_in<kind, Real>(arithmetic), later_filters<kind>, nullptr};
  } else {
    return {first_look_in<kind, Real>(arithmetic), nullptr, later_filters<kind>};
  }
}

}  // namespace

template <class Real>
batch::VectorTests<Real> tightrope_tests(Kind kind, Arithmetic arithmetic) {
  return kind == Kind::vertex_face ? tests<Kind::vertex_face, Real>(arithmetic)
                                   : tests<Kind::edge_edge, Real>(arithmetic);
}

}  // namespace tightrope::TIGHTROPE_LANES
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE
namespace tightrope::ccd {

template <class Real>
batch::VectorTests<Real> batch::tightrope_tests(Kind kind, InstructionSet instructions, Arithmetic arithmetic) {
  switch (instructions) { TIGHTROPE_RETURN_FOR_INSTRUCTIONS(tightrope_tests<Real>(kind, arithmetic)) }
  return {};
}
template batch::VectorTests<double> batch::tightrope_tests(Kind, InstructionSet, Arithmetic);
template batch::VectorTests<float> batch::tightrope_tests(Kind, InstructionSet, Arithmetic);

}  // namespace tightrope::ccd
#endif
