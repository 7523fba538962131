#pragma once
/// All queries below a folder, by kind.

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "query_io/query_files.h"

namespace tightrope::ccd {

/// vertex-face, edge-edge; a failure of the test if a file is not readable.
inline std::array<QueryBlock, 2> queries_below(const std::string& folder) {
  std::array<QueryBlock, 2> all;
  all[1].kind = Kind::edge_edge;
  auto files = find_query_files(std::span(&folder, 1), {});
  if (const auto* wrong = std::get_if<FileError>(&files)) {
    ADD_FAILURE() << wrong->message;
    return all;
  }
  QueryStream stream(std::get<std::vector<QueryFile>>(files));
  QueryBlock block;
  while (true) {
    if (const auto wrong = stream.next(1000, block)) {
      ADD_FAILURE() << wrong->message;
      return all;
    }
    if (block.size() == 0) break;
    QueryBlock& sum = all[block.kind == Kind::vertex_face ? 0 : 1];
    sum.points.insert(sum.points.end(), block.points.begin(), block.points.end());
    sum.truths.insert(sum.truths.end(), block.truths.begin(), block.truths.end());
  }
  EXPECT_EQ(stream.rounded(), 0U) << "coordinates are no doubles";
  return all;
}

}  // namespace tightrope::ccd
