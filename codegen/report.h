#pragma once
/// What `tightrope report` says: degrees, operation counts and bounds, and with measurement how good the bounds are.

#include <string>
#include <vector>

#include "codegen/compile.h"

namespace tightrope::codegen {

struct ReportOptions {
  bool json = false;
  bool table = false;  ///< a Markdown table of bound / true error, one line an output, one column a mode
  bool measure = false;
};

/// The report on `program` in each mode and precision of `bounded`.
std::string report(const dsl::Program& program, const std::vector<BoundedProgram>& bounded,
                   const ReportOptions& options);

}  // namespace tightrope::codegen
