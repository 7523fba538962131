#pragma once
/// Queries from files of bare numbers, and many more made from them.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tightrope/method.h"

namespace tightrope::gpu_check {

/// Queries of one kind, 24 numbers each.
struct QuerySet {
  std::string name;  ///< "cloth-fold"
  ccd::Kind kind;
  std::vector<double> points;
  std::size_t count() const { return points.size() / 24; }
};

/// NAME.vertex-face.raw and NAME.edge-edge.raw below a folder, by name.
std::vector<QuerySet> query_sets(const std::string& folder);

/// Query `number` made from one of `pool`: axes permuted, signs changed, scaled by a power of two, and, if `jitter`,
/// some coordinates moved by some ulps. Determined by `seed` and `number`.
void derive(const std::vector<double>& pool, std::uint64_t seed, std::uint64_t number, bool jitter, double* points);

/// The numbers rounded to single precision.
std::vector<float> in_float(const std::vector<double>& points);

}  // namespace tightrope::gpu_check
