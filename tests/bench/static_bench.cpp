/// Nanoseconds per query where one feature is at rest: the static query beside the general one with the points
/// repeated. Cloth against an obstacle at rest: the queries of two folding sheets, one feature frozen where it is at t
/// = 0. Run: static_bench [Google Benchmark's options].

#include <benchmark/benchmark.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "tightrope/static_impact.h"

namespace {

using namespace tightrope::ccd;

constexpr std::size_t numbers_per_query = 24;
constexpr std::size_t count = 20'000;

struct Variant {
  StaticPair pair;
  Kind kind;
  std::string name;
  std::vector<std::size_t> points;  ///< of the general query, in the order of the static one
};

template <class Real>
struct Queries {
  std::vector<Real> general;
  std::vector<Real> at_rest;
};

template <class Real>
Queries<Real> cloth_against_rest(const Variant& variant) {
  std::vector<double> points(numbers_per_query * count);
  generate(Scene::cloth_fold, variant.kind, count, 1)->fill(points);
  Queries<Real> queries;
  for (std::size_t q = 0; q < points.size(); q += numbers_per_query) {
    for (const std::size_t point : variant.points) {
      for (std::size_t i = 0; i < 3; ++i) queries.at_rest.push_back(static_cast<Real>(points[q + 3 * point + i]));
    }
    for (std::size_t point = 0; point < 8; ++point) {
      bool moves = point < 4;
      for (const std::size_t p : variant.points) moves = moves || p == point;
      const std::size_t source = moves ? point : point - 4;
      for (std::size_t i = 0; i < 3; ++i) queries.general.push_back(static_cast<Real>(points[q + 3 * source + i]));
    }
  }
  return queries;
}

template <class Decide>
void run(benchmark::State& state, const Decide& decide) {
  std::vector<unsigned char> results(count);
  for (auto _ : state) {
    decide(results.data());
    benchmark::DoNotOptimize(results.data());
    benchmark::ClobberMemory();
  }
  state.counters["per_query"] = benchmark::Counter(
      static_cast<double>(count), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

template <class Real>
void add(const Variant& variant, const std::string& real) {
  const auto queries = std::make_shared<Queries<Real>>(cloth_against_rest<Real>(variant));
  benchmark::RegisterBenchmark((variant.name + "/general/" + real).c_str(), [=](benchmark::State& state) {
    run(state, [&](unsigned char* results) { collides(variant.kind, queries->general.data(), count, results); });
  })->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark((variant.name + "/static/" + real).c_str(), [=](benchmark::State& state) {
    run(state, [&](unsigned char* results) { collides(variant.pair, queries->at_rest.data(), count, results); });
  })->Unit(benchmark::kMillisecond);
}

}  // namespace

int main(int argc, char** argv) {
  const std::array<Variant, 3> variants{
      {{StaticPair::vertex_static_face, Kind::vertex_face, "vertex-static-face", {0, 4, 1, 2, 3}},
       {StaticPair::static_vertex_face, Kind::vertex_face, "static-vertex-face", {1, 2, 3, 5, 6, 7, 0}},
       {StaticPair::edge_static_edge, Kind::edge_edge, "edge-static-edge", {0, 1, 4, 5, 2, 3}}}};
  for (const Variant& variant : variants) {
    add<double>(variant, "double");
    add<float>(variant, "float");
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
