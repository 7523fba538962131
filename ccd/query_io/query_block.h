#pragma once
/// Blocks of queries, the unit in which files are read and written, and what can be wrong with a file.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tightrope/ccd.h"

namespace tightrope::ccd {

inline constexpr std::size_t coordinates_per_query = 24;  ///< 8 points of x, y, z

/// Queries of one kind, one after another.
struct QueryBlock {
  Kind kind = Kind::vertex_face;
  std::vector<double> points;         ///< 24 a query, in the order of `Kind`
  std::vector<unsigned char> truths;  ///< one a query, 0 or 1; empty if the file does not tell

  std::size_t size() const { return points.size() / coordinates_per_query; }
  bool has_truth() const { return truths.size() == size(); }
  void clear() {
    points.clear();
    truths.clear();
  }
};

/// What is wrong with a file, in one line: "file:line: ..." where the file has lines, "file: ..." else.
struct FileError {
  std::string message;
};

}  // namespace tightrope::ccd
