#pragma once
/// Queries as methods in single precision get them.

#include <cstdint>
#include <vector>

#include "query_io/query_block.h"

namespace tightrope::ccd {

/// Queries with every coordinate rounded to the nearest float: other queries, with a truth of their own.
struct SingleBlock {
  std::vector<float> points;          ///< 24 a query
  std::vector<unsigned char> truths;  ///< one a query; empty if not known
  std::uint64_t changed = 0;          ///< queries of which a coordinate changed
  std::uint64_t left_out = 0;         ///< queries with a coordinate beyond the range of float: not in `points`
};

/// The truths of queries that change are decided by exact arithmetic anew; where `truth_known` is false there are none.
SingleBlock in_single_precision(const QueryBlock& block, bool truth_known);

}  // namespace tightrope::ccd
