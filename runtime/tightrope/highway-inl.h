/// Lanes of Highway's vectors, for generated code of `tightrope compile --target simd`. The one header here that needs
/// more than the standard library: Highway 1.0 or newer, and only of those who include it.
///
/// Included after hwy/highway.h and before HWY_BEFORE_NAMESPACE (what it includes is for every machine), the generated
/// headers between that and HWY_AFTER_NAMESPACE, once for each target of hwy/foreach_target.h:
///
///   #include <hwy/highway.h>
///   #include <tightrope/highway-inl.h>
///   HWY_BEFORE_NAMESPACE();
///   #include "door.tight.double.simd.h"      // tightrope::lanes::HWY_NAMESPACE::door<bound::tight, double>
///   ...
///   HWY_AFTER_NAMESPACE();
///
/// Every operation gives each lane the bits that arithmetic.h gives the single number, NaNs' payloads excepted: Highway
/// never fuses or reorders, and products pass a barrier, for g++ contracts vector arithmetic as it does scalar.

#if defined(TIGHTROPE_HIGHWAY_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TIGHTROPE_HIGHWAY_INL_H
#undef TIGHTROPE_HIGHWAY_INL_H
#else
#define TIGHTROPE_HIGHWAY_INL_H
#endif

#ifndef TIGHTROPE_LANES
#define TIGHTROPE_LANES lanes::HWY_NAMESPACE
#endif
#include <tightrope/lanes.h>

HWY_BEFORE_NAMESPACE();
namespace tightrope::TIGHTROPE_LANES {

namespace hn = hwy::HWY_NAMESPACE;

/// One number a lane. HWY_ATTR: g++ does not give friends of a template the instruction set of the lines around them.
template <class Real>
struct Lanes {
  using Tag = hn::ScalableTag<Real>;
  using Vector = hn::Vec<Tag>;

  Lanes() = default;
  /// From outside: a product is rounded before it comes in, else the compiler would fuse it with the first difference.
  HWY_INLINE HWY_ATTR Lanes(Vector vector) : v(rounded(vector)) {}
  HWY_INLINE HWY_ATTR Lanes(Real x) : v(hn::Set(Tag(), x)) {}
  /// From memory, of any alignment.
  HWY_INLINE HWY_ATTR static Lanes load(const Real* numbers) { return Lanes(hn::LoadU(Tag(), numbers), Known()); }

  friend HWY_INLINE HWY_ATTR Lanes operator+(Lanes a, Lanes b) { return {hn::Add(a.v, b.v), Known()}; }
  friend HWY_INLINE HWY_ATTR Lanes operator-(Lanes a, Lanes b) { return {hn::Sub(a.v, b.v), Known()}; }
  friend HWY_INLINE HWY_ATTR Lanes operator/(Lanes a, Lanes b) { return {hn::Div(a.v, b.v), Known()}; }
  friend HWY_INLINE HWY_ATTR Lanes operator-(Lanes a) { return {hn::Neg(a.v), Known()}; }

  friend HWY_INLINE HWY_ATTR Lanes product(Lanes a, Lanes b) { return {rounded(hn::Mul(a.v, b.v)), Known()}; }
  friend HWY_INLINE HWY_ATTR Lanes magnitude(Lanes a) { return {hn::Abs(a.v), Known()}; }
  friend HWY_INLINE HWY_ATTR Lanes square_root(Lanes a) { return {hn::Sqrt(a.v), Known()}; }

  /// b > a ? b : a. On x86 that is the instruction: it gives its second operand where either is NaN. (Highway's plain
  /// C++ gives its first.)
  friend HWY_INLINE HWY_ATTR Lanes max_magnitude(Lanes a, Lanes b) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR
    return {hn::Max(b.v, a.v), Known()};
#else
    return {hn::IfThenElse(hn::Gt(b.v, a.v), b.v, a.v), Known()};
#endif
  }
  friend HWY_INLINE HWY_ATTR Lanes minimum(Lanes a, Lanes b) {
    return {hn::IfThenElse(hn::Lt(a.v, b.v), a.v, hn::IfThenElse(hn::Le(b.v, a.v), b.v, hn::Add(a.v, b.v))), Known()};
  }
  friend HWY_INLINE HWY_ATTR Lanes maximum(Lanes a, Lanes b) {
    return {hn::IfThenElse(hn::Gt(a.v, b.v), a.v, hn::IfThenElse(hn::Ge(b.v, a.v), b.v, hn::Add(a.v, b.v))), Known()};
  }
  friend HWY_INLINE HWY_ATTR Lanes certain_nonzero(Lanes a, Lanes bound) {
    return {hn::IfThenElse(hn::Gt(hn::Abs(a.v), bound.v), a.v, not_a_number().v), Known()};
  }
  friend HWY_INLINE HWY_ATTR Lanes certain_nonnegative(Lanes a, Lanes bound) {
    return {hn::IfThenElse(hn::Ge(a.v, bound.v), a.v, not_a_number().v), Known()};
  }
  friend HWY_INLINE HWY_ATTR Lanes choose(Lanes condition, Lanes first, Lanes second) {
    return {hn::IfThenElse(hn::Ge(condition.v, hn::Zero(Tag())), first.v, second.v), Known()};
  }
  friend HWY_INLINE HWY_ATTR Lanes multiply_add(Lanes a, Lanes b, Lanes c) {
#if HWY_NATIVE_FMA
    return {hn::MulAdd(a.v, b.v, c.v), Known()};
#else  // the same numbers, slowly
    HWY_ALIGN Real x[hn::MaxLanes(Tag())], y[hn::MaxLanes(Tag())], z[hn::MaxLanes(Tag())];
    hn::Store(a.v, Tag(), x);
    hn::Store(b.v, Tag(), y);
    hn::Store(c.v, Tag(), z);
    for (std::size_t i = 0; i < hn::MaxLanes(Tag()); ++i) z[i] = tightrope::multiply_add(x[i], y[i], z[i]);
    return {hn::Load(Tag(), z), Known()};
#endif
  }
  friend HWY_INLINE HWY_ATTR Lanes normalizer(Lanes largest) {
    HWY_ALIGN Real x[hn::MaxLanes(Tag())];
    hn::Store(largest.v, Tag(), x);
    for (Real& lane : x) lane = tightrope::normalizer(lane);
    return {hn::Load(Tag(), x), Known()};
  }

  Vector v;

 private:
  /// What is no product of the caller's.
  struct Known {};
  HWY_INLINE HWY_ATTR Lanes(Vector vector, Known) : v(vector) {}

  HWY_INLINE HWY_ATTR static Vector rounded(Vector x) {
#if HWY_TARGET == HWY_EMU128
    for (Real& lane : x.raw) asm("" : "+m"(lane));
#elif HWY_ARCH_X86
    asm("" : "+v"(x.raw));
#elif HWY_ARCH_ARM
    asm("" : "+w"(x.raw));
#else
    asm("" : "+m"(x.raw));
#endif
    return x;
  }
  HWY_INLINE HWY_ATTR static Lanes not_a_number() { return static_cast<Real>(__builtin_nan("")); }
};

/// Lanes whose sign is definite: `sign` of single numbers (sign.h).
template <class Real>
HWY_INLINE HWY_ATTR auto is_positive(const Bounded<Lanes<Real>>& x) {
  return hn::Gt(x.value.v, x.bound.v);
}
template <class Real>
HWY_INLINE HWY_ATTR auto is_negative(const Bounded<Lanes<Real>>& x) {
  return hn::Lt(x.value.v, hn::Neg(x.bound.v));
}

}  // namespace tightrope::TIGHTROPE_LANES
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h turns over
