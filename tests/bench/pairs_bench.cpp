/// Nanoseconds per query of the other pairs and of minimum separation: vertex-edge in the plane and in space and
/// vertex-vertex on random motion near contact; separation beside contact on cloth-like queries, with a distance of a
/// thousandth and of a hundredth of the sheets' extent. Run: pairs_bench [Google Benchmark's options].

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "ccd/impact/separation.h"
#include "ccd/impact/vertex_edge.h"
#include "ccd/impact/vertex_vertex.h"
#include "ccd/scenes/random.h"
#include "scenes/scene.h"
#include "tightrope/ccd.h"

namespace {

using namespace tightrope::ccd;

constexpr std::size_t queries = 20'000;

void count_per_query(benchmark::State& state, std::size_t reported) {
  state.counters["per_query"] = benchmark::Counter(
      static_cast<double>(queries), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["reported"] = static_cast<double>(reported);
}

/// Runs `decide` (1: contact) on every query of `numbers` coordinates.
template <class Decide>
void run(benchmark::State& state, const std::vector<double>& points, const Decide& decide) {
  const std::size_t numbers = points.size() / queries;
  std::size_t reported = 0;
  for (auto _ : state) {
    reported = 0;
    for (std::size_t i = 0; i < queries; ++i) reported += decide(points.data() + numbers * i) ? 1 : 0;
    benchmark::DoNotOptimize(reported);
  }
  count_per_query(state, reported);
}

/// The vertex passes the other feature, of size 1, within about `miss`.
std::vector<double> near_contact(std::size_t count, std::size_t dimension, double miss) {
  std::vector<double> points;
  Random random(1);
  for (std::size_t query = 0; query < queries; ++query) {
    std::vector<double> x(2 * count * dimension);
    for (double& coordinate : x) coordinate = random.between(-1, 1);
    const double weight = random.uniform(), time = random.between(0.1, 1);
    for (std::size_t axis = 0; axis < dimension; ++axis) {
      const auto at = [&](std::size_t i) {
        const double from = x[dimension * i + axis], to = x[dimension * (count + i) + axis];
        return from + time * (to - from);
      };
      const double target = at(1) + weight * (at(count - 1) - at(1)) + random.between(-miss, miss);
      x[dimension * count + axis] = x[axis] + (target - x[axis]) / time;
    }
    points.insert(points.end(), x.begin(), x.end());
  }
  return points;
}

struct PairCase {
  const char* name;
  std::size_t count, dimension;
  std::optional<Impact> (*impact)(const double*, double, double);
  bool (*collides)(const double*);
};
constexpr std::array<PairCase, 3> pair_cases{{{"vertex-edge-2d", 3, 2, vertex_edge_impact_2d, vertex_edge_collides_2d},
                                              {"vertex-edge", 3, 3, vertex_edge_impact, vertex_edge_collides},
                                              {"vertex-vertex", 2, 3, vertex_vertex_impact, vertex_vertex_collides}}};

void register_pairs() {
  for (const PairCase& c : pair_cases) {
    for (const double miss : {1.0, 1e-2, 1e-6}) {
      const auto points = std::make_shared<std::vector<double>>(near_contact(c.count, c.dimension, miss));
      const std::string label = std::string(c.name) + "/miss:" + std::to_string(miss) + "/";
      benchmark::RegisterBenchmark((label + "bool").c_str(), [points, c](benchmark::State& state) {
        run(state, *points, c.collides);
      })->Unit(benchmark::kMillisecond);
      benchmark::RegisterBenchmark((label + "impact").c_str(), [points, c](benchmark::State& state) {
        run(state, *points, [&](const double* x) { return c.impact(x, 1e-6, 1).has_value(); });
      })->Unit(benchmark::kMillisecond);
    }
  }
}

void register_separation() {
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    const auto points = std::make_shared<std::vector<double>>(24 * queries);
    generate(Scene::cloth_fold, kind, queries, 1)->fill(*points);
    const auto [low, high] = std::minmax_element(points->begin(), points->end());
    const double extent = *high - *low;
    const Pair pair = kind == Kind::vertex_face ? Pair::vertex_face : Pair::edge_edge;
    const std::string label = "cloth-fold/" + std::string(name(kind)) + "/";
    benchmark::RegisterBenchmark((label + "contact, tight").c_str(), [points, kind](benchmark::State& state) {
      run(state, *points, [&](const double* x) { return collides(kind, x, Method::tight); });
    })->Unit(benchmark::kMillisecond);
    for (const double relative : {1e-3, 1e-2}) {
      benchmark::RegisterBenchmark((label + "separation:" + std::to_string(relative)).c_str(),
                                   [points, pair, distance = relative * extent](benchmark::State& state) {
                                     run(state, *points, [&](const double* x) {
                                       return first_approach(pair, x, distance, 1e-6, 1).has_value();
                                     });
                                   })
          ->Unit(benchmark::kMillisecond);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  register_pairs();
  register_separation();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
