#pragma once
/// Where a batch's queries lie, as the loops over it see it.

#include <algorithm>
#include <array>
#include <cstddef>

#include "ccd/geometry.h"
#include "tightrope/batch.h"

namespace tightrope::ccd::batch {

/// The 24 numbers of query i: in place where they lie together, else copied to `copy`.
template <class Real>
const Real* points_of(const Queries<Real>& queries, std::size_t i, std::array<Real, numbers_per_query>& copy) {
  if (queries.layout == Layout::by_query) return queries.points + numbers_per_query * i;
  for (std::size_t c = 0; c < copy.size(); ++c) copy[c] = queries.points[c * queries.pitch + i];
  return copy.data();
}

template <class Real>
const Real* points_of(const MeshQueries<Real>& queries, std::size_t i, std::array<Real, numbers_per_query>& copy) {
  Real* next = copy.data();
  for (const Real* vertices : {queries.vertices_t0, queries.vertices_t1}) {
    for (std::size_t j = 0; j < 4; ++j) {
      next = std::copy_n(vertices + std::size_t{3} * queries.indices[4 * i + j], 3, next);
    }
  }
  return copy.data();
}

template <class Real>
bool is_valid(const Queries<Real>& queries) {
  if (queries.count == 0) return true;
  return queries.points != nullptr && (queries.layout == Layout::by_query || queries.pitch >= queries.count);
}
template <class Real>
bool is_valid(const MeshQueries<Real>& queries) {
  if (queries.count == 0) return true;
  return queries.vertices_t0 != nullptr && queries.vertices_t1 != nullptr && queries.indices != nullptr;
}

}  // namespace tightrope::ccd::batch
