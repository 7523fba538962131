/// Memory: batches of methods without an exact stage take none, and where exact arithmetic gets none the caller is
/// told, whatever it was doing.

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <new>
#include <vector>

#include "scenes/scene.h"
#include "tightrope/batch.h"

namespace {

/// Allocations that are still granted; what was asked for.
std::atomic<std::int64_t> granted = std::numeric_limits<std::int64_t>::max();
std::atomic<std::int64_t> asked = 0;

void* allocate(std::size_t size) {
  asked.fetch_add(1);
  if (granted.fetch_sub(1) <= 0) throw std::bad_alloc();
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace tightrope::ccd {
namespace {

constexpr std::size_t count = 300;

/// Queries that reach the exact stage.
std::vector<double> degenerate(Kind kind) {
  std::vector<double> points(24 * count);
  generate(Scene::double_root, kind, count, 5)->fill(std::span(points).first(12 * count));
  generate(Scene::triple_root, kind, count, 5)->fill(std::span(points).subspan(12 * count));
  return points;
}

/// The status of a call to which `allocations` are granted; `used` becomes what it asked for.
template <class Call>
BatchStatus with_allocations(std::int64_t allocations, std::int64_t& used, const Call& call) {
  asked = 0;
  granted = allocations;
  const BatchStatus status = call();
  granted = std::numeric_limits<std::int64_t>::max();
  used = asked;
  return status;
}

TEST(BatchMemory, OfMethodsWithoutAnExactStageIsNone) {
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    const std::vector<double> points = degenerate(kind);
    std::vector<unsigned char> results(count);
    for (const Method method : {Method::bsc_float, Method::bsc_safe, Method::tight, Method::safe, Method::safe_tight}) {
      std::int64_t used = 0;
      const auto call = [&] {
        return collides(Queries<double>{kind, count, points.data()}, results.data(), {.method = method});
      };
      EXPECT_EQ(with_allocations(0, used, call), BatchStatus::done);
      EXPECT_EQ(used, 0);
    }
  }
}

TEST(BatchMemory, ThatIsRefusedIsTold) {
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    const std::vector<double> points = degenerate(kind);
    const Queries<double> queries{kind, count, points.data()};
    std::vector<unsigned char> results(count), expected(count);
    std::vector<double> times(count);
    ASSERT_EQ(collides(queries, expected.data()), BatchStatus::done);
    for (const Method method : {Method::tightrope, Method::bsc_exact}) {
      const auto decide = [&] { return collides(queries, results.data(), {.method = method}); };
      std::int64_t all = 0, used = 0;
      ASSERT_EQ(with_allocations(std::numeric_limits<std::int64_t>::max(), all, decide), BatchStatus::done);
      ASSERT_GT(all, 10) << "no query reaches the exact stage: this test shows nothing";
      for (std::int64_t granted_ones = 0; granted_ones < all; granted_ones += 1 + granted_ones / 16) {
        ASSERT_EQ(with_allocations(granted_ones, used, decide), BatchStatus::out_of_memory) << granted_ones;
      }
      ASSERT_EQ(with_allocations(all, used, decide), BatchStatus::done);
      EXPECT_EQ(results, expected);
    }
    const auto when = [&] { return impact_times(queries, times.data(), {.tolerance = 0}); };
    std::int64_t all = 0, used = 0;
    ASSERT_EQ(with_allocations(std::numeric_limits<std::int64_t>::max(), all, when), BatchStatus::done);
    for (std::int64_t granted_ones = 0; granted_ones < all; granted_ones += 1 + granted_ones / 16) {
      ASSERT_EQ(with_allocations(granted_ones, used, when), BatchStatus::out_of_memory) << granted_ones;
    }
  }
}

}  // namespace
}  // namespace tightrope::ccd
