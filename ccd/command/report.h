#pragma once
/// Rows of an evaluation as text.

#include <span>
#include <string>

#include "command/evaluation.h"

namespace tightrope::ccd {

/// For people: aligned columns.
std::string table(std::span<const EvaluationRow> rows);

/// One array of objects: method, kind, real, device, threads, queries, collisions, false_positives, false_negatives,
/// uncertain (signs met), ns_per_query, time_ratio_to_tight, instructions. collisions and false_* are null without
/// truth.
std::string json(std::span<const EvaluationRow> rows);

/// The same fields, a header line first; null is empty.
std::string csv(std::span<const EvaluationRow> rows);

}  // namespace tightrope::ccd
