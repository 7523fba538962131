#pragma once
/// Queries for the benchmarks of batches, made or read once and kept, in every layout.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "tightrope/batch.h"

namespace tightrope::bench {

/// Queries of one kind in one precision: by query, and, once asked for, in the other layouts.
template <class Real>
class QuerySet {
 public:
  QuerySet(ccd::Kind kind, const std::vector<double>& points);

  std::size_t count() const { return by_query_.size() / 24; }
  ccd::Queries<Real> by_query() const { return by_query(0, count()); }
  ccd::Queries<Real> by_query(std::size_t first, std::size_t count) const;
  ccd::Queries<Real> by_coordinate();
  /// Vertices that several queries use are stored once.
  ccd::MeshQueries<Real> of_mesh();
  std::size_t vertices() const { return vertices_t0_.size() / 3; }  ///< of the mesh, once it was asked for

 private:
  ccd::Kind kind_;
  std::vector<Real> by_query_, by_coordinate_, vertices_t0_, vertices_t1_;
  std::vector<std::uint32_t> indices_;
};

/// The first `count` queries of a scene, seed 1. They are read from a file in `folder`, if it is given, and written
/// there if it is not there yet: cloth-fold takes 20 s to make 10^6.
std::vector<double> scene_points(ccd::Scene scene, ccd::Kind kind, std::size_t count, const std::string& folder);

/// All queries of the kind in the public benchmark's sample queries, which the environment variable
/// TIGHTROPE_SAMPLE_QUERIES names or which lie beside the repository; empty if they are not found or cannot be read
/// (said on stderr).
std::vector<double> sample_points(ccd::Kind kind);

}  // namespace tightrope::bench
