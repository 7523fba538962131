#pragma once
/// Runs gnuplot.

#include <string>
#include <variant>

#include "codegen/charts/layout.h"
#include "codegen/charts/script.h"

namespace tightrope::charts {

struct Failure {
  std::string message;  ///< one line
};

/// The program that $PATH finds, or "".
std::string find_gnuplot();

/// The bytes of the picture.
std::variant<std::string, Failure> draw(const Chart& chart, const Layout& layout, Terminal terminal);

}  // namespace tightrope::charts
