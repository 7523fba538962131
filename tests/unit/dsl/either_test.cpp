/// `either`: what is shared, what is selected, and that only equal alternatives are let through.

#include "dsl/either.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/unit/dsl/compile.h"

namespace tightrope::dsl {
namespace {

using testing::compile;
using testing::Compiled;
using testing::Exact;

Predicate predicate_of(const std::string& parameters, const std::string& expression) {
  Compiled c = compile("predicate f(" + parameters + ") { sign " + expression + " as s }");
  EXPECT_EQ(c.errors(), "") << expression;
  return c.program.predicates.front();
}

struct Count {
  int selections = 0, products = 0, conditions = 0;
};

/// Of the nodes that the outputs need as values.
Count count(const Predicate& predicate) {
  std::set<NodeId> needed(predicate.stages[0].outputs[0].nodes.begin(), predicate.stages[0].outputs[0].nodes.end());
  std::set<NodeId> conditions;
  Count result;
  for (NodeId id = predicate.graph.size() - 1; id >= 0; --id) {
    if (!needed.contains(id)) continue;
    const Node& n = predicate.graph[id];
    if (n.op == Op::mul) ++result.products;
    if (n.op == Op::select) {
      ++result.selections;
      conditions.insert(n.a);
    }
    for (const NodeId operand : {n.op == Op::select ? no_node : n.a, n.b, n.c}) {
      if (operand != no_node) needed.insert(operand);
    }
  }
  result.conditions = static_cast<int>(conditions.size());
  return result;
}

TEST(Either, SelectsTheDifferencesAndMultipliesOnce) {
  const Count one = count(predicate_of("point p, a, b", "either(cross(a - p, b - a), cross(b - p, b - a))"));
  EXPECT_EQ(one.selections, 3);
  EXPECT_EQ(one.products, 6);
  EXPECT_EQ(one.conditions, 1);
  const Count moving = count(predicate_of("moving point p, a, b", "either(cross(a - p, b - a), cross(b - p, b - a))"));
  EXPECT_EQ(moving.selections, 6);
  EXPECT_EQ(moving.products, 24);
  EXPECT_EQ(moving.conditions, 1);
}

TEST(Either, SelectsAtTheEndWhereFormsDiffer) {
  const Count c = count(predicate_of("scalar x, y, z", "either(x * (y - z), x * y - x * z)"));
  EXPECT_EQ(c.selections, 1);
  EXPECT_EQ(c.products, 3);
}

TEST(Either, TakesSeveralAlternativesByOneConditionEach) {
  const Count c =
      count(predicate_of("vec2 u, v, w", "either(det(u - w, v - w), det(v - u, w - u), det(w - v, u - v))"));
  EXPECT_EQ(c.conditions, 2);
  EXPECT_EQ(c.products, 2);
}

TEST(Either, OfNumbersOrOfOneExpressionSelectsNothing) {
  for (const char* expression : {"either(1/2, 0.5) * x", "either(x * y, y * x)", "either(x, x, x)"}) {
    EXPECT_EQ(count(predicate_of("scalar x, y", expression)).selections, 0) << expression;
  }
}

TEST(Either, TakesTheShorterVector) {
  const Predicate p = predicate_of("point p, a, b", "either(cross(a - p, b - a), cross(b - p, b - a))");
  const auto value = [&](double ax, double bx) {  // p = 0, a and b near the axis: the last bits tell which was taken
    const std::vector<double> slots = {0, 0, 0, ax, 0.1, 0.7, bx, 0.3, 1e-3};
    const std::vector<double> v = evaluate<double>(p.graph, slots);
    return v[static_cast<std::size_t>(p.stages[0].outputs[0].nodes[0])];
  };
  const auto product = [](double x, double y, double z, double w) { return x * w - y * z; };
  // The first component is y z' - z y', of the pivot and b - a.
  EXPECT_EQ(value(1, 2), product(0.1, 0.7, 0.3 - 0.1, 1e-3 - 0.7));
  EXPECT_EQ(value(2, 1), product(0.3, 1e-3, 0.3 - 0.1, 1e-3 - 0.7));
  EXPECT_EQ(value(2, -2), product(0.1, 0.7, 0.3 - 0.1, 1e-3 - 0.7)) << "of equal sizes the first is taken";
}

/// `predicate`'s only output where conditions are as `taken` says, one bit each, whatever the inputs are.
Exact value_if(const Predicate& predicate, std::span<const Exact> slots, unsigned taken) {
  std::map<NodeId, int> conditions;
  for (NodeId id = 0; id < predicate.graph.size(); ++id) {
    const Node& n = predicate.graph[id];
    if (n.op == Op::select) conditions.emplace(n.a, static_cast<int>(conditions.size()));
  }
  std::vector<Exact> v;
  const auto at = [&](NodeId id) -> const Exact& { return v[static_cast<std::size_t>(id)]; };
  for (NodeId id = 0; id < predicate.graph.size(); ++id) {
    const Node& n = predicate.graph[id];
    const bool first = n.op != Op::select || (taken >> conditions.at(n.a) & 1U) != 0;
    v.push_back(n.op == Op::select ? at(first ? n.b : n.c) : evaluate_node<Exact>(n, slots, at));
  }
  return at(predicate.stages[0].outputs[0].nodes[0]);
}

TEST(Either, IsRightWhateverIsTaken) {
  std::mt19937_64 random(13);
  for (const char* expression :
       {"either(x * (y - z), x * y - x * z)",
        "either((x - y) * (z - x) * y, (y - x) * (x - z) * y, y * (x - y) * (z - x))",
        "either(either(x * (y + z), x * y + x * z) * x, x * (x * y + x * z)) - either((x - z) * y, x * y - z * y)",
        "3 * either(2 * (x - y) * z, (2 * x - 2 * y) * z) + either(x * x - y * y, (x - y) * (x + y))",
        "either(fma(x, y, z) * x, x * x * y + x * z)", "either((x * y) / 3, 1/3 * y * x, x * (y / 3))"}) {
    const Predicate p = predicate_of("scalar x, y, z", expression);
    for (int round = 0; round < 20; ++round) {
      std::vector<Exact> slots;
      for (int i = 0; i < 3; ++i) slots.emplace_back(testing::random_rational(random));
      const Exact truth = value_if(p, slots, ~0U);
      for (unsigned taken = 0; taken < 16; ++taken)
        EXPECT_EQ(value_if(p, slots, taken).value, truth.value) << expression;
    }
  }
}

/// The test above can fail.
TEST(Either, ThatWereUnequalWouldShow) {
  const Predicate p = predicate_of("scalar x, y, z", "either(sqrt(x * x) * y, x * y)");
  const Exact slots[] = {-2.0, 3.0, 1.0};
  EXPECT_NE(value_if(p, slots, 0).value, value_if(p, slots, 1).value);
}

std::string errors(const std::string& expression) {
  return compile("predicate f(scalar x, y, z) { sign " + expression + " as s }").errors();
}

TEST(Either, RefusesUnequalAlternatives) {
  EXPECT_NE(errors("either(x * y, x * y + 1/1000000)"), "");
  EXPECT_NE(errors("either(x * y, y * y)"), "");
  EXPECT_NE(errors("either(x * y, x * y, x * z)"), "");
  EXPECT_NE(errors("either(x, -x)").find("negative"), std::string::npos);
  EXPECT_NE(errors("either(x / y, x / z)"), "");
  EXPECT_NE(errors("either(2^200 * x, 2^200 * x + y)"), "");
  EXPECT_NE(errors("either([x, y], [x, x])"), "");
}

TEST(Either, AcceptsEqualOnesOfEveryForm) {
  EXPECT_EQ(errors("either((x + y) ^ 7, (x + y) ^ 3 * (x * x + 2 * x * y + y * y) ^ 2)"), "");
  EXPECT_EQ(errors("either(x / y / z, x / (y * z), 1 / y / z * x)"), "");
  EXPECT_EQ(errors("either((x * x - y * y) / (x + y), x - y)"), "");
  EXPECT_EQ(errors("either(abs(x - y), abs(y - x))"), "");
  EXPECT_EQ(errors("either(max(x, y) + z, z + max(y, x))"), "");
  EXPECT_EQ(errors("either(1/3 * x, x / 3)"), "");
}

TEST(Either, LeavesWhatPolynomialsCannotTellToTheGeneratedTests) {
  EXPECT_EQ(errors("either(sqrt(x * x), x)"), "");
  EXPECT_EQ(errors("either(max(x, y), min(x, y))"), "");
}

}  // namespace
}  // namespace tightrope::dsl
