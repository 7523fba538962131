#include "dsl/graph.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>
#include <span>

#include "dsl/evaluate.h"

namespace tightrope::dsl {
namespace {

TEST(Graph, GivesEqualNodesOneNumber) {
  Graph g;
  const NodeId x = g.input(0);
  const NodeId y = g.input(1);
  EXPECT_EQ(g.input(0), x);
  EXPECT_NE(x, y);
  EXPECT_EQ(g.sub(x, y), g.sub(x, y));
  EXPECT_NE(g.sub(x, y), g.sub(y, x));
  EXPECT_EQ(g.constant(0.5), g.constant(0.5));
  EXPECT_NE(g.constant(0.5), g.constant(0.25));
  EXPECT_EQ(g.mul_pow2(x, 3), g.mul_pow2(x, 3));
  EXPECT_NE(g.mul_pow2(x, 3), g.mul_pow2(x, -3));
  EXPECT_NE(g.fma(x, y, x), g.fma(x, y, y));
}

TEST(Graph, OrdersTheOperandsOfCommutativeOperationsOnly) {
  Graph g;
  const NodeId x = g.input(0);
  const NodeId y = g.input(1);
  for (const Op op : {Op::add, Op::mul, Op::min, Op::max}) EXPECT_EQ(g.binary(op, x, y), g.binary(op, y, x));
  for (const Op op : {Op::sub, Op::div, Op::max_magnitude}) EXPECT_NE(g.binary(op, x, y), g.binary(op, y, x));
}

TEST(Graph, FoldsNothing) {
  Graph g;
  const NodeId x = g.input(0);
  const NodeId zero = g.constant(0);
  EXPECT_EQ(g[g.add(x, zero)].op, Op::add);
  EXPECT_EQ(g[g.sub(x, x)].op, Op::sub);
  EXPECT_EQ(g[g.mul(zero, zero)].op, Op::mul);
  EXPECT_EQ(g[g.neg(g.neg(x))].op, Op::neg);
}

TEST(Graph, StoresOneZero) {
  Graph g;
  EXPECT_EQ(g.constant(-0.0), g.constant(0.0));
  EXPECT_FALSE(std::signbit(g[g.constant(-0.0)].value));
}

TEST(Graph, FindsEveryNodeAgainAmongMany) {
  Graph g;
  std::mt19937 random(3);
  std::vector<Node> made;
  for (int i = 0; i < 50; ++i) g.input(i);
  for (int i = 0; i < 20000; ++i) {
    const auto pick = [&] { return std::uniform_int_distribution<NodeId>(0, g.size() - 1)(random); };
    made.push_back({.op = i % 2 == 0 ? Op::sub : Op::mul, .a = pick(), .b = pick()});
    const NodeId id = g.intern(made.back());
    made.back() = g[id];
  }
  const NodeId size = g.size();
  for (const Node& node : made) EXPECT_EQ(g[g.intern(node)], node);
  EXPECT_EQ(g.size(), size);
  for (NodeId id = 0; id < size; ++id) {
    EXPECT_LT(g[id].a, id);
    EXPECT_LT(g[id].b, id);
  }
}

TEST(Graph, CopiesKeepTheirNodesApart) {
  Graph g;
  g.input(0);
  Graph copy = g;
  copy.input(1);
  EXPECT_EQ(g.size(), 1);
  EXPECT_EQ(copy.size(), 2);
  EXPECT_EQ(g.input(7), 1);
}

TEST(Graph, PrintsOneLineANode) {
  Graph g;
  const NodeId x = g.input(0);
  const NodeId y = g.input(4);
  const NodeId tenth = g.constant(0.1);
  const NodeId sum = g.add(y, x);
  g.mul_pow2(g.mul(sum, tenth), -2);
  g.fma(x, y, g.neg(sum));
  g.binary(Op::max_magnitude, g.abs(x), g.unary(Op::sqrt, y));
  EXPECT_EQ(print(g),
            "%0 = input 0\n"
            "%1 = input 4\n"
            "%2 = constant 0.1\n"
            "%3 = add %0 %1\n"
            "%4 = mul %2 %3\n"
            "%5 = mul_pow2 %4 -2\n"
            "%6 = neg %3\n"
            "%7 = fma %0 %1 %6\n"
            "%8 = sqrt %1\n"
            "%9 = abs %0\n"
            "%10 = max_magnitude %9 %8\n");
}

TEST(Graph, NamesAndCountsOperandsOfEveryOperation) {
  const std::array operations = {Op::input,
                                 Op::constant,
                                 Op::add,
                                 Op::sub,
                                 Op::neg,
                                 Op::mul,
                                 Op::mul_pow2,
                                 Op::div,
                                 Op::sqrt,
                                 Op::abs,
                                 Op::min,
                                 Op::max,
                                 Op::fma,
                                 Op::max_magnitude,
                                 Op::certain_nonzero,
                                 Op::certain_nonnegative};
  const std::array counts = {0, 0, 2, 2, 1, 2, 1, 2, 1, 1, 2, 2, 3, 2, 2, 2};
  for (std::size_t i = 0; i < operations.size(); ++i) {
    EXPECT_EQ(operand_count(operations[i]), counts[i]);
    for (std::size_t j = 0; j < i; ++j) EXPECT_STRNE(op_name(operations[i]), op_name(operations[j]));
  }
}

TEST(Evaluate, ComputesEveryOperationInFloatingPoint) {
  Graph g;
  const NodeId x = g.input(0);
  const NodeId y = g.input(1);
  const std::array<std::pair<NodeId, double>, 16> expected = {{{g.add(x, y), 1.5},
                                                               {g.sub(x, y), -4.5},
                                                               {g.mul(x, y), -4.5},
                                                               {g.binary(Op::div, x, y), -0.5},
                                                               {g.neg(x), 1.5},
                                                               {g.abs(x), 1.5},
                                                               {g.mul_pow2(x, 4), -24.0},
                                                               {g.unary(Op::sqrt, g.mul(y, y)), 3.0},
                                                               {g.binary(Op::min, x, y), -1.5},
                                                               {g.binary(Op::max, x, y), 3.0},
                                                               {g.fma(x, y, y), -1.5},
                                                               {g.binary(Op::max_magnitude, x, y), 3.0},
                                                               {g.binary(Op::certain_nonzero, y, x), 3.0},
                                                               {g.binary(Op::certain_nonzero, x, g.constant(1)), -1.5},
                                                               {g.binary(Op::certain_nonnegative, y, y), 3.0},
                                                               {g.binary(Op::certain_nonnegative, y, x), 3.0}}};
  const std::array<double, 2> inputs = {-1.5, 3.0};
  const std::vector<double> values = evaluate<double>(g, inputs);
  for (const auto& [node, value] : expected) EXPECT_EQ(values[static_cast<std::size_t>(node)], value) << node;
}

TEST(Evaluate, GuardsThatFailGiveNaN) {
  Graph g;
  const NodeId x = g.input(0);
  const NodeId y = g.input(1);
  const NodeId zero = g.constant(0);
  const std::array<double, 2> inputs = {-1.5, 1.5};
  for (const NodeId node : {g.binary(Op::certain_nonzero, x, y), g.binary(Op::certain_nonnegative, x, zero)}) {
    EXPECT_TRUE(std::isnan(evaluate<double>(g, inputs)[static_cast<std::size_t>(node)]));
  }
}

TEST(Evaluate, MinAndMaxLetNoNaNPass) {
  Graph g;
  const NodeId x = g.input(0);
  const NodeId y = g.input(1);
  const NodeId nodes[] = {g.binary(Op::min, x, y), g.binary(Op::max, x, y)};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::array<double, 2>& inputs : {std::array{nan, 1.0}, std::array{1.0, nan}}) {
    const std::vector<double> values = evaluate<double>(g, inputs);
    for (const NodeId node : nodes) EXPECT_TRUE(std::isnan(values[static_cast<std::size_t>(node)]));
  }
}

}  // namespace
}  // namespace tightrope::dsl
