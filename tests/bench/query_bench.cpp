/// Nanoseconds per query of every method in double and single precision, one thread: cloth-like queries (the survivors
/// of a broad phase over two folding sheets) and, where they are found, the public benchmark's sample queries. Run:
/// query_bench [Google Benchmark's options].

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "query_io/query_files.h"
#include "scenes/scene.h"
#include "tightrope/ccd.h"

namespace {

using namespace tightrope::ccd;

struct QuerySet {
  std::string name;
  Kind kind;
  std::vector<double> points;
};

constexpr std::size_t numbers_per_query = 24;

QuerySet cloth_like(Kind kind) {
  constexpr std::size_t queries = 20'000;  // 4 MB: as if streamed through the caches
  QuerySet set{"cloth-fold", kind, std::vector<double>(numbers_per_query * queries)};
  generate(Scene::cloth_fold, kind, queries, 1)->fill(set.points);
  return set;
}

std::optional<std::string> sample_queries_path() {
  if (const char* path = std::getenv("TIGHTROPE_SAMPLE_QUERIES")) return path;
  const std::string beside = TIGHTROPE_SOURCE_DIR "/../shared/data/sample-queries";
  if (std::filesystem::exists(beside)) return beside;
  return std::nullopt;
}

/// All queries of the kind below `path`; none if a file cannot be read (said on stderr).
QuerySet read_samples(const std::string& path, Kind kind) {
  QuerySet set{"samples", kind, {}};
  const std::vector<std::string> paths{path};
  auto found = find_query_files(paths, kind);
  if (const auto* error = std::get_if<FileError>(&found)) {
    std::cerr << error->message << '\n';
    return set;
  }
  QueryStream stream(std::get<std::vector<QueryFile>>(found));
  QueryBlock block;
  for (;;) {
    if (const auto error = stream.next(1 << 16, block)) {
      std::cerr << error->message << '\n';
      return {"samples", kind, {}};
    }
    if (block.size() == 0) return set;
    set.points.insert(set.points.end(), block.points.begin(), block.points.end());
  }
}

template <class Real>
void run_queries(benchmark::State& state, const QuerySet& set, Method method) {
  std::vector<Real> points;
  for (const double x : set.points) points.push_back(static_cast<Real>(x));
  const std::size_t count = points.size() / numbers_per_query;
  std::vector<unsigned char> results(count);
  for (auto _ : state) {
    collides(set.kind, points.data(), count, results.data(), method);
    benchmark::DoNotOptimize(results.data());
    benchmark::ClobberMemory();
  }
  std::size_t collisions = 0;
  for (const unsigned char result : results) collisions += result;
  state.SetItemsProcessed(static_cast<std::int64_t>(count) * state.iterations());
  state.counters["per_query"] = benchmark::Counter(
      static_cast<double>(count), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["queries"] = static_cast<double>(count);
  state.counters["reported"] = static_cast<double>(collisions);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<QuerySet> sets;
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) sets.push_back(cloth_like(kind));
  if (const auto path = sample_queries_path()) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) sets.push_back(read_samples(*path, kind));
  }
  for (const QuerySet& set : sets) {
    if (set.points.empty()) continue;
    for (const MethodInfo& info : methods()) {
      const std::string label = set.name + "/" + std::string(name(set.kind)) + "/" + std::string(info.name) + "/";
      benchmark::RegisterBenchmark((label + "double").c_str(), [&set, method = info.method](benchmark::State& state) {
        run_queries<double>(state, set, method);
      })->Unit(benchmark::kMillisecond);
      benchmark::RegisterBenchmark((label + "float").c_str(), [&set, method = info.method](benchmark::State& state) {
        run_queries<float>(state, set, method);
      })->Unit(benchmark::kMillisecond);
    }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
