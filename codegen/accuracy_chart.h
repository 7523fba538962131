#pragma once
/// Bounds against true errors over the magnitude of the inputs, as a chart (as Figure 8 of [Wang et al. 2015]).

#include <string>
#include <vector>

#include "codegen/charts/chart.h"
#include "codegen/compile.h"

namespace tightrope::codegen {

struct AccuracyRequest {
  std::vector<BoundMode> modes = {BoundMode::safe, BoundMode::tight, BoundMode::fixed};  ///< with bounds
  std::vector<Precision> precisions = {Precision::binary64};
  std::string gappa;             ///< the program that finds bounds of its own; empty: they are left out
  double gappa_time_limit = 60;  ///< seconds an output element
  std::string source;            ///< the program's name, for readers
  double assumed_range = 1;      ///< that inputs were given which declare none, for readers
  bool ranges_assumed = false;   ///< whether there are such inputs
};

/// One panel an output or, where there are more than eight, the worst output of each predicate. Inputs are uniform in
/// a part of their ranges that halves and halves again; the constants of mode `static` and Gappa's are for the whole
/// ranges. `program`: all its inputs have ranges. Errors go to `diagnostics`.
charts::Chart accuracy_chart(const dsl::Program& program, const AccuracyRequest& request,
                             dsl::Diagnostics& diagnostics);

}  // namespace tightrope::codegen
