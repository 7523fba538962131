#include "query_sets.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string_view>
#include <unordered_map>
#include <variant>

#include "query_io/query_files.h"

namespace tightrope::bench {
namespace {

constexpr std::size_t numbers_per_query = 24;

/// A vertex's coordinates at t = 0 and at t = 1.
template <class Real>
using Vertex = std::array<Real, 6>;

template <class Real>
struct HashOfVertex {
  std::size_t operator()(const Vertex<Real>& vertex) const {
    std::array<char, sizeof(vertex)> bytes;
    std::memcpy(bytes.data(), vertex.data(), bytes.size());
    return std::hash<std::string_view>()({bytes.data(), bytes.size()});
  }
};

}  // namespace

template <class Real>
QuerySet<Real>::QuerySet(ccd::Kind kind, const std::vector<double>& points) : kind_(kind), by_query_(points.size()) {
  std::transform(points.begin(), points.end(), by_query_.begin(), [](double x) { return static_cast<Real>(x); });
}

template <class Real>
ccd::Queries<Real> QuerySet<Real>::by_query(std::size_t first, std::size_t count) const {
  return {kind_, count, by_query_.data() + numbers_per_query * first};
}

template <class Real>
ccd::Queries<Real> QuerySet<Real>::by_coordinate() {
  if (by_coordinate_.empty()) {
    by_coordinate_.resize(by_query_.size());
    for (std::size_t i = 0; i < count(); ++i) {
      for (std::size_t c = 0; c < numbers_per_query; ++c) {
        by_coordinate_[c * count() + i] = by_query_[numbers_per_query * i + c];
      }
    }
  }
  return {kind_, count(), by_coordinate_.data(), ccd::Layout::by_coordinate, count()};
}

template <class Real>
ccd::MeshQueries<Real> QuerySet<Real>::of_mesh() {
  if (indices_.empty()) {
    std::unordered_map<Vertex<Real>, std::uint32_t, HashOfVertex<Real>> known;
    for (std::size_t i = 0; i < count(); ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        const Real* at = by_query_.data() + numbers_per_query * i + 3 * j;
        const Vertex<Real> vertex{at[0], at[1], at[2], at[12], at[13], at[14]};
        const auto [found, is_new] = known.try_emplace(vertex, static_cast<std::uint32_t>(known.size()));
        if (is_new) {
          vertices_t0_.insert(vertices_t0_.end(), vertex.begin(), vertex.begin() + 3);
          vertices_t1_.insert(vertices_t1_.end(), vertex.begin() + 3, vertex.end());
        }
        indices_.push_back(found->second);
      }
    }
  }
  return {kind_, count(), vertices_t0_.data(), vertices_t1_.data(), indices_.data()};
}

template class QuerySet<double>;
template class QuerySet<float>;

std::vector<double> scene_points(ccd::Scene scene, ccd::Kind kind, std::size_t count, const std::string& folder) {
  std::vector<double> points(numbers_per_query * count);
  const auto bytes = static_cast<std::streamsize>(points.size() * sizeof(double));
  std::string name(ccd::name(scene));
  name.append("-").append(ccd::name(kind)).append("-").append(std::to_string(count)).append(".f64");
  const std::filesystem::path path = std::filesystem::path(folder) / name;
  if (!folder.empty()) {
    std::ifstream kept(path, std::ios::binary);
    if (kept.read(reinterpret_cast<char*>(points.data()), bytes)) return points;
  }
  std::cerr << "making " << count << " queries: " << ccd::name(scene) << ", " << ccd::name(kind) << '\n';
  ccd::generate(scene, kind, count, 1)->fill(points);
  if (!folder.empty()) {
    std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(points.data()), bytes);
  }
  return points;
}

std::vector<double> sample_points(ccd::Kind kind) {
  const char* named = std::getenv("TIGHTROPE_SAMPLE_QUERIES");
  const std::string path = named != nullptr ? named : TIGHTROPE_SOURCE_DIR "/../shared/data/sample-queries";
  if (!std::filesystem::exists(path)) return {};
  std::vector<double> points;
  auto found = ccd::find_query_files(std::vector<std::string>{path}, kind);
  if (const auto* error = std::get_if<ccd::FileError>(&found)) {
    std::cerr << error->message << '\n';
    return {};
  }
  ccd::QueryStream stream(std::get<std::vector<ccd::QueryFile>>(found));
  ccd::QueryBlock block;
  for (;;) {
    if (const auto error = stream.next(1 << 16, block)) {
      std::cerr << error->message << '\n';
      return {};
    }
    if (block.size() == 0) return points;
    points.insert(points.end(), block.points.begin(), block.points.end());
  }
}

}  // namespace tightrope::bench
