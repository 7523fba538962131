#pragma once
/// A query in a test's message, ready to be pasted into a plain CSV file.

#include <cstdio>
#include <string>

namespace tightrope::ccd {

/// 24 hexadecimal floats with commas between.
inline std::string show_query(const double* points) {
  std::string text;
  for (int i = 0; i < 24; ++i) {
    char number[40];
    std::snprintf(number, sizeof number, "%s%a", i > 0 ? "," : "", points[i]);
    text += number;
  }
  return text;
}

}  // namespace tightrope::ccd
