#pragma once
/// Rows of an evaluation as a chart: time against false positives.

#include <span>
#include <string>

#include "codegen/charts/chart.h"
#include "command/evaluation.h"

namespace tightrope::ccd {

/// One panel a kind, one marker a row: time per query against the false positives per query without contact, a method
/// that missed contacts crossed out. Per precision the Pareto front of the conservative methods, that is, of those that
/// promise never to miss and did not. `source` names the queries. All rows have mistakes.
charts::Chart evaluation_chart(std::span<const EvaluationRow> rows, const std::string& source);

/// False positives per query without contact; 0 where there is no such query.
double false_positive_rate(const EvaluationRow& row);

}  // namespace tightrope::ccd
