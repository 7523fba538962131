#pragma once
/// Which values of a graph cannot be negative, whatever the inputs: squares, absolute values, roots, and what is made
/// of them by + * / max.

#include <vector>

#include "dsl/graph.h"

namespace tightrope::codegen {

/// By node: the exact value, where it exists, and the computed one, unless it is NaN, are at least 0. (Rounding is
/// monotone and keeps 0, so one proof serves both.)
std::vector<bool> nonnegative_nodes(const dsl::Graph& graph);

}  // namespace tightrope::codegen
