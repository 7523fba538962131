#pragma once
/// Charts as files.

#include <string>

#include "codegen/charts/chart.h"

namespace tightrope::charts {

/// "" if a chart can be written there, as far as can be told before there is one: the extension is .svg, .png or .html
/// (in either case), gnuplot is installed, a file can be made in the folder. Otherwise one line on what is wrong.
std::string check_chart_file(const std::string& file);

/// Writes the chart as what the file's extension says. "", or one line on what went wrong; then a file that was there
/// is as before. The bytes depend on the chart and the version of gnuplot alone.
std::string write_chart(const Chart& chart, const std::string& file);

}  // namespace tightrope::charts
