/// Compile-time ranges: rounded outwards, exact where they can be, and found at vertices (lemma V).

#include "codegen/range.h"

#include <gtest/gtest.h>
#include <tightrope/exact.h>

#include <cmath>
#include <random>

#include "codegen/range_analysis.h"
#include "dsl/evaluate.h"

namespace tightrope::codegen {
namespace {

using dsl::Graph;
using dsl::NodeId;

double random_double(std::mt19937_64& random) {
  const double mantissa = std::ldexp(static_cast<double>(static_cast<std::int64_t>(random()) >> 10), -52);
  const int spread = random() % 2 != 0 ? 4 : 500;
  return std::ldexp(mantissa, static_cast<int>(random() % static_cast<unsigned>(2 * spread)) - spread);
}

TEST(DirectedArithmetic, IsOnItsSideAndExactWhereItCanBe) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const double x = random_double(random);
    const double y = random() % 4 != 0 ? random_double(random) : std::ldexp(1.0, static_cast<int>(random() % 9) - 4);
    const DyadicRatio a(x), b(y);
    const auto check = [&](const DyadicRatio& exact, double down, double up) {
      ASSERT_TRUE(DyadicRatio(down) <= exact && exact <= DyadicRatio(up)) << x << " " << y;
      ASSERT_TRUE(down == up || std::nextafter(down, INFINITY) == up || std::abs(up) < 0x1p-800 ||
                  std::nextafter(std::nextafter(down, INFINITY), INFINITY) == up);
      const bool representable = std::abs(up) > 0x1p-800 && DyadicRatio(exact.to_double()) == exact;
      ASSERT_TRUE(!representable || down == up) << x << " " << y;
    };
    check(a + b, sum_down(x, y), sum_up(x, y));
    check(a * b, product_down(x, y), product_up(x, y));
    if (y != 0) check(a / b, quotient_down(x, y), quotient_up(x, y));
    const double z = std::abs(x);
    ASSERT_TRUE(DyadicRatio(root_down(z)) * DyadicRatio(root_down(z)) <= DyadicRatio(z));
    ASSERT_TRUE(DyadicRatio(root_up(z)) * DyadicRatio(root_up(z)) >= DyadicRatio(z));
  }
  EXPECT_EQ(root_up(9), 3);
  EXPECT_EQ(root_down(9), 3);
  EXPECT_EQ(product_up(INFINITY, 0), 0);
}

/// (b - a) x (c - a) in the plane.
NodeId determinant(Graph& g) {
  const auto difference = [&](int from, int axis) { return g.sub(g.input(from + axis), g.input(axis)); };
  return g.sub(g.mul(difference(2, 0), difference(4, 1)), g.mul(difference(2, 1), difference(4, 0)));
}

TEST(RangeAnalysis, FindsAtVerticesWhatIntervalsLose) {
  Graph g;
  const NodeId det = determinant(g);
  EXPECT_EQ(RangeAnalysis(g, std::vector<double>(6, 1), false).of(det), symmetric(8));
  EXPECT_EQ(RangeAnalysis(g, std::vector<double>(6, 1)).of(det), symmetric(4));
  EXPECT_EQ(RangeAnalysis(g, {1, 1, 1, 1, 1, 0}).of(det), symmetric(4));
}

TEST(RangeAnalysis, ContainsEveryValue) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 200; ++i) {
    Graph g;
    std::vector<NodeId> values;
    std::vector<double> limits;
    for (int slot = 0; slot < 5; ++slot) {
      values.push_back(g.input(slot));
      limits.push_back(std::abs(random_double(random)) + 0x1p-30);
    }
    for (int n = 0; n < 9; ++n) {
      const NodeId a = values[random() % values.size()];
      const NodeId b = values[random() % values.size()];
      const int op = static_cast<int>(random() % 4);
      values.push_back(op == 0 ? g.add(a, b) : op == 1 ? g.sub(a, b) : op == 2 ? g.mul(a, b) : g.fma(a, b, values[0]));
    }
    RangeAnalysis ranges(g, limits);
    const std::vector<WeightedNode> terms = {{values.back(), 3}, {values[values.size() - 2], 0.7}};
    const auto sum = ranges.largest_sum(terms);
    for (int sample = 0; sample < 50; ++sample) {
      std::vector<DyadicRatio> slots;
      for (const double limit : limits) {
        const double t = std::ldexp(static_cast<double>(random() % 33), -4) - 1;
        slots.push_back(DyadicRatio(limit) * DyadicRatio(t));
      }
      const auto v = dsl::evaluate<DyadicRatio>(g, slots);
      for (NodeId id = 0; id < g.size(); ++id) {
        const Range range = ranges.of(id);
        if (!std::isfinite(magnitude(range))) continue;
        const DyadicRatio& value = v[static_cast<std::size_t>(id)];
        ASSERT_TRUE(DyadicRatio(range.lo) <= value && value <= DyadicRatio(range.hi)) << dsl::print(g) << id;
      }
      if (!sum) continue;
      DyadicRatio total;
      for (const WeightedNode& term : terms) {
        total += DyadicRatio(term.weight) * abs(v[static_cast<std::size_t>(term.node)]);
      }
      ASSERT_TRUE(total <= DyadicRatio(*sum)) << dsl::print(g);
    }
  }
}

/// x x - x over [-1, 1] has its least value inside: vertices say nothing, and are not asked.
TEST(RangeAnalysis, AsksNoVerticesWhereAnInputIsSquared) {
  Graph g;
  const NodeId x = g.input(0);
  const NodeId f = g.sub(g.mul(x, x), x);
  RangeAnalysis ranges(g, {1});
  EXPECT_EQ(ranges.of(f), (Range{-1, 2}));
  const std::vector<WeightedNode> terms = {{f, 1}};
  EXPECT_FALSE(ranges.largest_sum(terms).has_value());
}

}  // namespace
}  // namespace tightrope::codegen
