#pragma once
/// Exact truth of many queries.

#include <span>

#include "tightrope/ccd.h"

namespace tightrope::ccd {

/// Decides the queries in `points` (24 finite doubles each) with the exact oracle, on all cores; `truths` must hold one
/// byte a query and gets 0 or 1.
void exact_truths(Kind kind, std::span<const double> points, std::span<unsigned char> truths);

}  // namespace tightrope::ccd
