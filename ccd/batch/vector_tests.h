#pragma once
/// The tests that a method has on vectors: what vector_tightrope.cpp, vector_bsc.cpp and vector_safe.cpp define for
/// every instruction set.

#include <cstddef>

#include "tightrope/batch.h"

namespace tightrope::ccd::batch {

/// Looks at as many queries as there are lanes: number c of query i is numbers[c * pitch + i]. Bit i of the result is
/// set unless the method certainly answers `false` to query i.
template <class Real>
using VectorTest = unsigned (*)(const Real* numbers, std::size_t pitch);

/// In the order of their turns; null: there is none.
template <class Real>
struct VectorTests {
  VectorTest<Real> first = nullptr;
  VectorTest<Real> second = nullptr;
  VectorTest<double> second_in_double = nullptr;  ///< in place of `second`
};

/// Of one family of methods. None: not this family's method, or no vectors for these instructions.
template <class Real>
VectorTests<Real> tightrope_tests(Kind kind, InstructionSet instructions, Arithmetic arithmetic);
template <class Real>
VectorTests<Real> bsc_tests(Method method, Kind kind, InstructionSet instructions);
template <class Real>
VectorTests<Real> safe_tests(Method method, Kind kind, InstructionSet instructions);

}  // namespace tightrope::ccd::batch
