#pragma once
/// The stages of method `tightrope`.

namespace tightrope::ccd {

/// What decides a query, in the order of their turns.
enum class Stage : unsigned char {
  first_look,   ///< a plane along the face (both edges) as at t = 0 separates the features, by SafeBound
  separation,   ///< an axis does, or a plane along the features as at t = 1
  hull,         ///< Y or the quadratics, in the best geometry and with TightBound, on the whole step
  subdivision,  ///< the same on parts of the step
  exact,        ///< exact arithmetic
};

/// What is asked.
enum class Question : unsigned char { whether, when };

}  // namespace tightrope::ccd
