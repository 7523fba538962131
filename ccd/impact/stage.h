#pragma once
/// The stages of method `tightrope`.

namespace tightrope::ccd {

/// What decides a query, in the order of their turns.
enum class Stage : unsigned char {
  first_look,   ///< the coefficients of Y have one sign, by SafeBound
  separation,   ///< one feature is beyond the other in a coordinate all the time
  hull,         ///< Y or the quadratics, in the best geometry and with TightBound, on the whole step
  subdivision,  ///< the same on parts of the step
  exact,        ///< exact arithmetic
};

/// What is asked.
enum class Question : unsigned char { whether, when };

}  // namespace tightrope::ccd
