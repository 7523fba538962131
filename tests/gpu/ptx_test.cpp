/// What nvcc makes of the kernels, run on the processor (ptx_to_cpp.py): answers and lists are those of the methods'
/// functions compiled for the processor. Finds what a device compiler gets wrong, or leaves out, without a device.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/gpu/host_stages.h"
#include "tests/gpu/ptx_machine.h"
#include "tests/gpu/sample.h"

namespace tightrope::ccd::gpu {
namespace {

constexpr std::size_t queries_a_scene = 400;
constexpr std::uint32_t threads = 128;

/// Results and lists of a chunk.
template <class Real>
struct Memory {
  explicit Memory(const Queries<Real>& queries, bool touching_is_open = false)
      : results(queries.count, 9), first(queries.count), second(queries.count), open(queries.count) {
    const bool together = queries.layout == Layout::by_query;
    chunk = {.points = queries.points,
             .query_stride = together ? numbers : 1,
             .coordinate_stride = together ? 1 : queries.pitch,
             .count = static_cast<Index>(queries.count),
             .results = results.data(),
             .lists = {first.data(), second.data()},
             .open = open.data(),
             .counters = &counters,
             .touching_is_open = touching_is_open};
  }
  std::vector<unsigned char> results;
  std::vector<Index> first, second, open;
  Counters counters{};
  Chunk<Real> chunk{};
};

/// None: these kernels were not made.
template <class Real>
ptx::Run kernel(Method method, Kind kind, int stage) {
  if (method == Method::bsc_exact) method = Method::tight;  // and touching is open
  const std::string name = "_ZN9tightrope3ccd3gpu11" + std::string(stage == 0 ? "first" : "later") +
                           "_stageILNS0_6MethodE" + std::to_string(static_cast<int>(method)) + "E" +
                           (sizeof(Real) == 8 ? "d" : "f") + "LNS0_4KindE" + std::to_string(static_cast<int>(kind)) +
                           "E" + (stage == 0 ? "" : "Li" + std::to_string(stage) + "E") + "EEvNS1_5ChunkIT0_EE";
  for (const ptx::Kernel& k : ptx::kernels()) {
    if (k.name == name) return k.run;
  }
  return nullptr;
}

template <class Real>
void run_on_host(Method method, Kind kind, const Chunk<Real>& chunk) {
  switch (method) {
    case Method::bsc_float:
      return run_on_host<Method::bsc_float>(kind, chunk);
    case Method::bsc_safe:
      return run_on_host<Method::bsc_safe>(kind, chunk);
    case Method::tight:
    case Method::bsc_exact:
      return run_on_host<Method::tight>(kind, chunk);
    case Method::safe:
      return run_on_host<Method::safe>(kind, chunk);
    case Method::safe_tight:
      return run_on_host<Method::safe_tight>(kind, chunk);
    case Method::tightrope:
      return run_on_host<Method::tightrope>(kind, chunk);
  }
}

/// Runs the kernels of all stages that were made; false: none was.
template <class Real>
bool run_kernels(Method method, Kind kind, const Chunk<Real>& chunk) {
  for (int stage = 0; stage < most_stages; ++stage) {
    const ptx::Run run = kernel<Real>(method, kind, stage);
    if (run == nullptr) return stage > 0;
    const std::uint32_t all = (chunk.count + threads - 1) / threads;
    ptx::launch(run, &chunk, sizeof(chunk), stage == 0 ? all : 2, threads);
  }
  return true;
}

template <class Real>
bool expect_equal(Method method, const Sample<Real>& sample, Layout layout) {
  const Queries<Real> queries = sample.queries(layout);
  const bool touching_is_open = method == Method::bsc_exact;
  Memory<Real> expected(queries, touching_is_open), found(queries, touching_is_open);
  if (!run_kernels(method, sample.kind, found.chunk)) return false;
  run_on_host(method, sample.kind, expected.chunk);
  EXPECT_EQ(found.results, expected.results) << name(method) << " " << name(sample.kind);
  EXPECT_EQ(std::count(found.results.begin(), found.results.end(), 9), 0);
  EXPECT_TRUE(std::equal(std::begin(found.counters.left), std::end(found.counters.left), expected.counters.left));
  EXPECT_EQ(found.counters.open, expected.counters.open);
  found.open.resize(found.counters.open);
  std::sort(found.open.begin(), found.open.end());
  for (const Index i : found.open) EXPECT_EQ(found.results[i], 2);
  // And the library says the same, but where it is left open.
  const std::vector<unsigned char> library = sample.answers(method);
  for (std::size_t i = 0; i < library.size(); ++i) {
    EXPECT_TRUE(found.results[i] == 2 || found.results[i] == library[i]) << name(method) << " query " << i;
  }
  return true;
}

TEST(Ptx, AnswersAreThoseOfTheProcessor) {
  int tested = 0;
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    const Sample<double> in_double(kind, queries_a_scene);
    const Sample<float> in_float(kind, queries_a_scene);
    for (const MethodInfo& method : methods()) {
      for (const Layout layout : {Layout::by_query, Layout::by_coordinate}) {
        tested += expect_equal(method.method, in_double, layout) ? 1 : 0;
        tested += expect_equal(method.method, in_float, layout) ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(tested, 8 * TIGHTROPE_METHODS_IN_PTX);
}

TEST(Ptx, AWrongInstructionIsNoticed) {
  const Sample<double> sample(Kind::vertex_face, queries_a_scene);
  const Queries<double> queries = sample.queries(Layout::by_coordinate);
  Memory<double> expected(queries), found(queries);
  run_on_host(Method::tightrope, sample.kind, expected.chunk);
  ptx::forgets_magnitudes = true;
  EXPECT_TRUE(run_kernels(Method::tightrope, sample.kind, found.chunk));
  ptx::forgets_magnitudes = false;
  EXPECT_FALSE(std::equal(std::begin(found.counters.left), std::end(found.counters.left), expected.counters.left));
  EXPECT_NE(found.results, expected.results);
}

}  // namespace
}  // namespace tightrope::ccd::gpu
