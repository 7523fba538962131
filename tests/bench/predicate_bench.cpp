/// Nanoseconds per call of orient3d and insphere: plain, with each bound, staged, exact, and, where CGAL is installed,
/// its exact-predicates kernel beside them. Random points, and points within an ulp of a zero of the predicate. Run:
/// predicate_bench [Google Benchmark's options].

#include <benchmark/benchmark.h>

#include <string>

#include "circles.exact.double.h"
#include "circles.float.double.h"
#include "circles.safe.double.h"
#include "circles.staged.double.h"
#include "circles.tight.double.h"
#include "orientation.exact.double.h"
#include "orientation.float.double.h"
#include "orientation.safe.double.h"
#include "orientation.staged.double.h"
#include "orientation.tight.double.h"
#include "points.h"
#ifdef TIGHTROPE_BENCH_CGAL
#include "cgal_predicates.h"
#endif

namespace {

using namespace tightrope;
using bench::PointTuples;

constexpr std::size_t calls = 4096;  // 400 kB: in the second-level cache

int number(ExactSign s) { return static_cast<int>(s); }
template <class Real>
int number(const Bounded<Real>& x) {
  return static_cast<int>(sign(x));
}

template <class Bound>
int orient3d(const PointTuples& p) {
  int sum = 0;
  for (std::size_t i = 0; i < calls; ++i) {
    sum += number(generated::orient3d<Bound, double>::evaluate(p(i, 0), p(i, 1), p(i, 2), p(i, 3)).volume);
  }
  return sum;
}

template <class Bound>
int insphere(const PointTuples& p) {
  int sum = 0;
  for (std::size_t i = 0; i < calls; ++i) {
    sum += number(generated::insphere<Bound, double>::evaluate(p(i, 0), p(i, 1), p(i, 2), p(i, 3), p(i, 4)).inside);
  }
  return sum;
}

template <class Function>
void time(const std::string& name, Function function) {
  benchmark::RegisterBenchmark(name.c_str(), [function](benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(function());
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(calls));
    state.counters["ns_per_call"] = benchmark::Counter(
        static_cast<double>(calls) * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  });
}

void register_points(const std::string& name, const PointTuples& points, bool sphere) {
  const auto both = [&]<class Bound>(Bound, const char* mode) {
    time(name + "/" + mode, [&points, sphere] { return sphere ? insphere<Bound>(points) : orient3d<Bound>(points); });
  };
  both(bound::none{}, "float");
  both(bound::safe{}, "safe");
  both(bound::tight{}, "tight");
  both(bound::exact{}, "exact");
  both(bound::staged{}, "staged");
#ifdef TIGHTROPE_BENCH_CGAL
  const auto cgal = std::make_shared<bench::CgalPoints>(points);
  time(name + "/CGAL", [cgal, sphere] { return sphere ? cgal->insphere() : cgal->orient3d(); });
#endif
}

}  // namespace

int main(int argc, char** argv) {
  const PointTuples random4 = bench::random_points(4, calls, 1);
  const PointTuples random5 = bench::random_points(5, calls, 2);
  const PointTuples coplanar = bench::near_coplanar_points(calls, 3);
  const PointTuples cospherical = bench::near_cospherical_points(calls, 4);
  register_points("orient3d/random", random4, false);
  register_points("orient3d/near_coplanar", coplanar, false);
  register_points("insphere/random", random5, true);
  register_points("insphere/near_cospherical", cospherical, true);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
