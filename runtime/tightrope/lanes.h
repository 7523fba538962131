#pragma once
/// What generated code for vector classes (`tightrope compile --target simd`, NAME.BOUND.REAL.simd.h) is included with.
///
/// Before the first of them the includer defines TIGHTROPE_LANES, the name of a namespace below tightrope, and there a
/// class template `Lanes<Real>`: as many numbers of type double or float as an instruction works on. It must convert
/// implicitly from one Real (the same in every lane) and have +, -, /, unary -, and, found by argument-dependent
/// lookup, what arithmetic.h has for single numbers, all with the same results in every lane, NaNs included:
///
///   product  magnitude  minimum  maximum  max_magnitude  certain_nonzero  certain_nonnegative  choose  square_root
///   multiply_add  normalizer
///
/// No more of them than the predicate uses. highway-inl.h has such a class for Highway. If TIGHTROPE_LANES is not
/// defined, there is one lane: the number itself.

#include <tightrope/sign.h>

#if !defined(TIGHTROPE_LANES)
namespace tightrope::generated {
template <class Real>
using Lanes = Real;
}
#define TIGHTROPE_LANES generated
#endif
