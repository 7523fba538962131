// Generated functions as a caller sees them, for the checks of the assembly: nothing here may become a fused
// multiply-add. The caller's own sums are of values that left generated code as products.
#include "features.float.double.h"
#include "features.safe.double.h"
#include "features.safe.float.h"
#include "features.tight.double.h"
#include "features.tight.float.h"

using namespace tightrope;

template <class Bound, class Real>
void evaluate_stages(const Real* x, Bounded<Real>* y) {
  using Code = generated::stages<Bound, Real>;
  typename Code::State state;
  const auto first = Code::first(x, x + 3, x + 6, x + 9, x + 12, x + 15, state);
  const auto second = Code::second(x, x + 3, x + 6, x + 9, x + 12, x + 15, state);
  const auto third = Code::third_in_range(x, x + 3, x + 6, x + 9, x + 12, x + 15, state);
  for (int i = 0; i < 4; ++i) *y++ = first.Y[i];
  for (int i = 0; i < 3; ++i) *y++ = first.slope[i];
  for (int i = 0; i < 3; ++i) *y++ = second.n[1][i];
  for (int i = 0; i < 4; ++i) *y++ = second.weight[i];
  for (int i = 0; i < 3; ++i) *y++ = third.length2[i];
}

template <class Bound, class Real>
void evaluate_incircle(const Real* x, Bounded<Real>* y) {
  *y = generated::incircle<Bound, Real>::evaluate(x, x + 2, x + 4, x + 6).side;
}

template <class Bound, class Real>
void evaluate_bounded(const Bounded<Real>* x, Real s, Bounded<Real>* y) {
  using Code = generated::bounded_inputs<Bound, Real>;
  typename Code::State state;
  const auto one = Code::one(x, x + 3, x + 6, s, state);
  const auto two = Code::two(x, x + 3, x + 6, s, state);
  y[0] = one.d, y[1] = one.volume, y[2] = two.gap, y[3] = two.determinant;
}

/// A product that leaves generated code, and a sum of the caller's.
template <class Bound, class Real>
Real shifted_area(const Real* x, Real shift) {
  typename generated::testing<Bound, Real>::State state;
  const auto result = generated::testing<Bound, Real>::collect_in_range(x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7],
                                                                        x[8], x[9], state);
  return result.real.value + shift;
}

/// Arguments that are products of the caller's: they are rounded before anything is added to them.
template <class Bound, class Real>
void evaluate_scaled(const Real* x, Real s, Bounded<Real>* y) {
  const Real p[] = {s * x[0], s * x[1], s * x[2], s * x[3], s * x[4], s * x[5], s * x[6], s * x[7]};
  y[0] = generated::incircle<Bound, Real>::evaluate(p, p + 2, p + 4, p + 6).side;
}

#define INSTANTIATE(BOUND, REAL)                                                                  \
  template void evaluate_stages<bound::BOUND, REAL>(const REAL*, Bounded<REAL>*);                 \
  template void evaluate_incircle<bound::BOUND, REAL>(const REAL*, Bounded<REAL>*);               \
  template void evaluate_bounded<bound::BOUND, REAL>(const Bounded<REAL>*, REAL, Bounded<REAL>*); \
  template REAL shifted_area<bound::BOUND, REAL>(const REAL*, REAL);                              \
  template void evaluate_scaled<bound::BOUND, REAL>(const REAL*, REAL, Bounded<REAL>*);

INSTANTIATE(none, double)
INSTANTIATE(safe, double)
INSTANTIATE(tight, double)
INSTANTIATE(safe, float)
INSTANTIATE(tight, float)
