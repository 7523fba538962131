/// The flow of batches through a device, on a device that is none: the answers are those of the processor whatever the
/// chunks, layouts, memory and failures.

#include "ccd/gpu/pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/gpu/sample.h"
#include "tests/gpu/simulated_device.h"

namespace tightrope::ccd::gpu {
namespace {

constexpr int callers_stream = 2, callers_other_stream = 3;

template <class Real>
const Sample<Real>& sample(Kind kind) {
  static const Sample<Real> samples[]{Sample<Real>(Kind::vertex_face, 800), Sample<Real>(Kind::edge_edge, 800)};
  return samples[kind == Kind::vertex_face ? 0 : 1];
}

/// Memory of a device and of a caller together: `flow` gets the pipeline.
struct Simulation {
  SimulatedDevice device;
  Report report;
  Result from_host(const auto& queries, std::vector<unsigned char>& results, const Options& options) {
    Pipeline<SimulatedDevice> pipeline(device);
    const Result result = pipeline.from_host(queries, results.data(), options, report);
    EXPECT_TRUE(device.idle()) << "the caller's memory is still in use";
    return result;
  }
  Result on_device(const auto& queries, std::vector<unsigned char>& results, const Options& options) {
    Pipeline<SimulatedDevice> pipeline(device);
    const Result result = pipeline.on_device(queries, results.data(), callers_stream, options, report);
    if (result && (options.leave_open || !is_decided_by_processor(options.method))) device.drain(callers_stream);
    EXPECT_TRUE(device.idle());
    return result;
  }
};

template <class Real>
void expect_answers_of_the_processor() {
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    const Sample<Real>& all = sample<Real>(kind);
    for (const MethodInfo& method : methods()) {
      const std::vector<unsigned char> expected = all.answers(method.method);
      ASSERT_GT(std::count(expected.begin(), expected.end(), 1), 100);
      for (const Layout layout : {Layout::by_query, Layout::by_coordinate}) {
        for (const bool pinned : {false, true}) {
          const Options options{.method = method.method, .threads = 2, .chunk = 1024};
          Simulation host, device;
          host.device.caller_pins = pinned;
          std::vector<unsigned char> results(all.count(), 9);
          EXPECT_TRUE(host.from_host(all.queries(layout), results, options));
          EXPECT_EQ(results, expected) << method.name;
          EXPECT_EQ(host.device.blocks(), 0U) << "not freed";
          std::vector<unsigned char> on_device(all.count(), 9);
          EXPECT_TRUE(device.on_device(all.queries(layout), on_device, options));
          EXPECT_EQ(on_device, expected) << method.name;
          EXPECT_EQ(device.report.open, host.report.open);
          EXPECT_EQ(host.report.open > 0, method.exact) << method.name;
        }
      }
    }
  }
}

TEST(Pipeline, AnswersAreThoseOfTheProcessorInDouble) { expect_answers_of_the_processor<double>(); }
TEST(Pipeline, AnswersAreThoseOfTheProcessorInFloat) { expect_answers_of_the_processor<float>(); }

/// More open queries in a chunk than come back at once.
TEST(Pipeline, CrowdsOfOpenQueriesComeBackInPieces) {
  const std::size_t count = 3 * open_at_once + 7;
  std::vector<double> points(count * numbers);
  for (std::size_t i = 0; i < count; ++i) points[i * numbers + i % numbers] = static_cast<double>(i % 5);
  const Queries<double> queries{Kind::edge_edge, count, points.data()};
  std::vector<unsigned char> expected(count), results(count, 9);
  ccd::collides(Kind::edge_edge, points.data(), count, expected.data(), Method::tightrope);
  Simulation simulation;
  EXPECT_TRUE(simulation.on_device(queries, results, {.chunk = count}));
  EXPECT_EQ(results, expected);
  EXPECT_GT(simulation.report.open, 2 * open_at_once);
}

TEST(Pipeline, AForgottenWaitIsNoticed) {
  const Sample<double>& all = sample<double>(Kind::vertex_face);
  const std::vector<unsigned char> expected = all.answers(Method::tight);
  std::vector<unsigned char> results(all.count(), 9);
  SimulatedDevice device;
  device.forgets_to_wait = true;
  Report report;
  {
    Pipeline<SimulatedDevice> pipeline(device);
    EXPECT_TRUE(pipeline.from_host(all.queries(Layout::by_query), results.data(), {.method = Method::tight}, report));
  }
  EXPECT_FALSE(device.idle());
  EXPECT_NE(results, expected);
}

/// Calls that return with their work enqueued, each followed by one in other streams: are all answers right?
bool are_right_beside_each_other(bool forgets_to_follow) {
  const Sample<double>& all = sample<double>(Kind::vertex_face);
  const Queries<double> queries = all.queries(Layout::by_query);
  SimulatedDevice device;
  device.interleaves = true;
  device.forgets_to_follow = forgets_to_follow;
  Pipeline<SimulatedDevice> pipeline(device);
  Report report;
  std::vector<unsigned char> early(all.count()), late(all.count()), host(all.count());
  const auto enqueue_early = [&] {
    const Options options{.method = Method::tight, .chunk = 1024};
    EXPECT_TRUE(pipeline.on_device(queries, early.data(), callers_stream, options, report));
    EXPECT_FALSE(device.idle());
  };
  enqueue_early();
  EXPECT_TRUE(pipeline.on_device(queries, late.data(), callers_other_stream, {.chunk = 1024}, report));
  enqueue_early();
  EXPECT_TRUE(pipeline.from_host(queries, host.data(), {.chunk = 1024}, report));
  device.drain(callers_stream);
  EXPECT_TRUE(device.idle());
  return device.conflicts == 0 && early == all.answers(Method::tight) && late == all.answers(Method::tightrope) &&
         host == all.answers(Method::tightrope);
}

TEST(Pipeline, CallsInDifferentStreamsFollowEachOther) {
  EXPECT_TRUE(are_right_beside_each_other(false));
  EXPECT_FALSE(are_right_beside_each_other(true));  // a defect: they write to one another's lists
}

TEST(Pipeline, OpenQueriesAreLeftOnRequest) {
  const Sample<double>& all = sample<double>(Kind::vertex_face);
  const std::vector<unsigned char> exact = all.answers(Method::tightrope);
  std::vector<unsigned char> results(all.count(), 9);
  Simulation simulation;
  EXPECT_TRUE(simulation.on_device(all.queries(Layout::by_query), results, {.leave_open = true}));
  EXPECT_GT(std::count(results.begin(), results.end(), 2), 10);
  for (std::size_t i = 0; i < all.count(); ++i) EXPECT_TRUE(results[i] == 2 || results[i] == exact[i]) << i;
}

TEST(Pipeline, LittleMemoryMeansSmallChunksAndNoneIsSaid) {
  const Sample<double>& all = sample<double>(Kind::edge_edge);
  const std::vector<unsigned char> expected = all.answers(Method::tightrope);
  std::vector<unsigned char> results(all.count());
  Simulation enough;
  EXPECT_TRUE(enough.from_host(all.queries(Layout::by_query), results, {.chunk = 1U << 16}));
  EXPECT_EQ(enough.report.chunk, 1U << 16);
  bool gave_up = false;
  for (std::size_t limit = enough.device.most_in_use; limit > 0; limit = limit * 2 / 3) {
    Simulation little;
    little.device.memory_limit = limit;
    std::fill(results.begin(), results.end(), 9);
    const Result result = little.from_host(all.queries(Layout::by_query), results, {.chunk = 1U << 16});
    EXPECT_EQ(little.device.blocks(), 0U);
    EXPECT_LE(little.device.most_in_use, limit);
    if (!result) {
      EXPECT_EQ(result.status, Status::out_of_memory);
      gave_up = true;
    } else {
      EXPECT_FALSE(gave_up) << "more memory was not enough";
      EXPECT_EQ(results, expected);
    }
  }
  EXPECT_TRUE(gave_up);
  // A workspace that could not serve one call serves the next.
  SimulatedDevice device;
  Pipeline<SimulatedDevice> pipeline(device);
  Report report;
  device.memory_limit = 1000;
  EXPECT_EQ(pipeline.from_host(all.queries(Layout::by_query), results.data(), {}, report).status,
            Status::out_of_memory);
  device.memory_limit = std::numeric_limits<std::size_t>::max();
  EXPECT_TRUE(pipeline.from_host(all.queries(Layout::by_query), results.data(), {}, report));
  EXPECT_EQ(results, expected);
}

/// Whatever call of the device fails: the caller is told, nothing leaks, and nothing of his is used any more.
TEST(Pipeline, EveryFailureIsToldAndLeaksNothing) {
  const Sample<double>& all = sample<double>(Kind::vertex_face);
  for (const bool from_host : {true, false}) {
    for (long call = 0;; ++call) {
      Simulation simulation;
      simulation.device.calls_until_failure = call;
      std::vector<unsigned char> results(all.count());
      const Options options{.chunk = 1024};
      const Queries<double> queries = all.queries(Layout::by_query);
      const Result result =
          from_host ? simulation.from_host(queries, results, options) : simulation.on_device(queries, results, options);
      EXPECT_EQ(simulation.device.blocks(), 0U);
      if (simulation.device.calls <= call) {
        EXPECT_TRUE(result);
        EXPECT_GT(call, 15);
        break;
      }
      EXPECT_EQ(result.status, Status::device_error) << call;
    }
  }
}

TEST(Pipeline, AWorkspaceServesCallsOfAllSizesAndPrecisions) {
  SimulatedDevice device;
  Pipeline<SimulatedDevice> pipeline(device);
  Report report;
  for (const std::size_t count : {0U, 1U, 31U, 1025U, 2500U, 7U}) {
    const auto check = [&](auto queries, const auto& expected) {
      queries.count = count;
      std::vector<unsigned char> results(count + 1, 9);
      EXPECT_TRUE(pipeline.from_host(queries, results.data(), {}, report));
      EXPECT_TRUE(std::equal(expected.begin(), expected.begin() + static_cast<std::ptrdiff_t>(count), results.begin()));
      EXPECT_EQ(results.back(), 9);
    };
    check(sample<double>(Kind::edge_edge).queries(Layout::by_query),
          sample<double>(Kind::edge_edge).answers(Method::tightrope));
    check(sample<float>(Kind::vertex_face).queries(Layout::by_coordinate),
          sample<float>(Kind::vertex_face).answers(Method::tightrope));
  }
}

TEST(DecideOpen, ThreadsAndExceptions) {
  std::vector<int> seen(1000);
  EXPECT_TRUE(in_parts(seen.size(), 7, 4, [&](std::size_t first, std::size_t count) {
    for (std::size_t i = first; i < first + count; ++i) ++seen[i];
  }));
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), 1000);
  EXPECT_FALSE(in_parts(100, 1, 3, [](std::size_t first, std::size_t) {
    if (first == 50) throw std::bad_alloc();
  }));
}

}  // namespace
}  // namespace tightrope::ccd::gpu
