#pragma once
/// Doubles as decimal rationals and back, exactly.

#include <string>
#include <string_view>

namespace tightrope::ccd {

struct Rational {
  double value = 0;
  bool exact = true;         ///< false: `value` is the double nearest to the rational, ties to even
  std::string_view fault{};  ///< not empty: why the text is no finite double ("zero denominator"); `value` is then 0
};

/// The double nearest to numerator / denominator; both decimal integers of any length, with an optional sign.
Rational parse_rational(std::string_view numerator, std::string_view denominator);

/// Appends "numerator,denominator" in lowest terms, denominator > 0; `value` must be finite. -0 becomes "0,1".
void append_rational(std::string& text, double value);

}  // namespace tightrope::ccd
