#pragma once
/// A chart as a gnuplot script.

#include <string>

#include "codegen/charts/layout.h"

namespace tightrope::charts {

enum class Terminal { svg, png };

/// A script for gnuplot 5 that draws the chart to its standard output. PNG pictures have two dots a pixel.
std::string gnuplot_script(const Chart& chart, const Layout& layout, Terminal terminal);

}  // namespace tightrope::charts
