#include <gtest/gtest.h>

#include "codegen/explore/balance.h"
#include "codegen/explore/factor.h"
#include "codegen/explore/sums.h"
#include "codegen/simplify.h"
#include "tests/unit/codegen/random_predicate.h"
#include "tests/unit/explore/predicates.h"

namespace tightrope::codegen::explore {
namespace {

using namespace codegen::testing_support;
using explore::testing_support::everything;
using explore::testing_support::lowerings;
using Pass = dsl::Predicate (*)(const dsl::Predicate&);

/// The graph that a pass makes of one output over six scalars.
std::string passed(Pass pass, dsl::NodeId (*build)(dsl::Graph&)) {
  std::mt19937_64 random(1);
  dsl::Predicate p = random_predicate(random, {Inputs::exact, Ranges::none, 0, true});
  p.stages[0].outputs.resize(1);
  p.stages[0].outputs[0].nodes = {build(p.graph)};
  return print(pass(p).graph);
}

dsl::NodeId product(dsl::Graph& g, int a, int b) { return g.mul(g.input(a), g.input(b)); }

TEST(BalanceSums, SumsInHalves) {
  EXPECT_EQ(passed(balance_sums,
                   [](dsl::Graph& g) { return g.sub(g.sub(g.add(g.input(0), g.input(1)), g.input(2)), g.input(3)); }),
            "%0 = input 0\n%1 = input 1\n%2 = input 2\n%3 = input 3\n%4 = add %0 %1\n%5 = add %2 %3\n%6 = sub %4 %5\n");
}

TEST(BalanceSums, LeavesDifferencesOfInputsAndSharedSums) {
  const auto difference = [](dsl::Graph& g) {
    return g.add(g.add(g.sub(g.input(0), g.input(1)), g.input(2)), g.input(3));
  };
  EXPECT_EQ(passed(balance_sums, difference),
            "%0 = input 0\n%1 = input 1\n%2 = input 2\n%3 = input 3\n%4 = sub %0 %1\n%5 = add %2 %4\n%6 = add %3 %5\n");
  const auto shared = [](dsl::Graph& g) {
    const dsl::NodeId sum = g.add(g.add(g.input(0), g.input(1)), g.input(2));
    return g.mul(g.add(g.add(sum, g.input(3)), g.input(4)), sum);
  };
  EXPECT_EQ(passed(balance_sums, shared), passed(simplify, shared));
}

TEST(FactorSums, TakesTheMostFrequentFactorOutFirst) {
  EXPECT_EQ(passed(factor_sums,
                   [](dsl::Graph& g) {  // ab - ca + bd + ae = a (b - c + e) + bd
                     return g.add(g.add(g.sub(product(g, 0, 1), product(g, 2, 0)), product(g, 1, 3)), product(g, 0, 4));
                   }),
            "%0 = input 0\n%1 = input 1\n%2 = input 2\n%3 = input 3\n%4 = input 4\n%5 = mul %1 %3\n%6 = sub %1 %2\n"
            "%7 = add %4 %6\n%8 = mul %0 %7\n%9 = add %5 %8\n");
}

TEST(FactorSums, LeavesProductsThatAreUsedTwice) {
  const auto twice = [](dsl::Graph& g) {
    const dsl::NodeId ab = product(g, 0, 1);
    return g.mul(g.add(ab, product(g, 0, 2)), ab);
  };
  EXPECT_EQ(passed(factor_sums, twice), passed(simplify, twice));
}

/// Whether the outputs are the same exact numbers, at scales from 2^-1000 to 2^1000.
bool equal_at_all_scales(const dsl::Predicate& a, const dsl::Predicate& b, std::mt19937_64& random, int samples) {
  for (int i = 0; i < samples; ++i) {
    const auto sample = random_sample<double>(random, a, random_scale<double>(random, false));
    std::vector<Enclosure> slots(sample.exact.begin(), sample.exact.end());
    const auto of_a = dsl::evaluate<Enclosure>(a.graph, slots);
    const auto of_b = dsl::evaluate<Enclosure>(b.graph, slots);
    for (std::size_t o = 0; o < a.stages[0].outputs.size(); ++o) {
      const Enclosure& x = of_a[static_cast<std::size_t>(a.stages[0].outputs[o].nodes[0])];
      const Enclosure& y = of_b[static_cast<std::size_t>(b.stages[0].outputs[o].nodes[0])];
      if (x.lower() != y.lower()) return false;
    }
  }
  return true;
}

TEST(Passes, KeepExactValuesOfRandomGraphs) {
  std::mt19937_64 random(6);
  int changed = 0;
  for (int i = 0; i < 200; ++i) {
    const dsl::Predicate p = random_predicate(random, {Inputs::exact, Ranges::none, 24, false});
    for (const Pass pass : {balance_sums, factor_sums}) {
      const dsl::Predicate q = pass(p);
      changed += print(q.graph) != print(simplify(p).graph);
      ASSERT_TRUE(equal_at_all_scales(p, q, random, 5)) << print(p.graph) << "\n" << print(q.graph);
    }
  }
  EXPECT_GT(changed, 100) << "the passes hardly do anything: the test says little";
}

/// Passes that are wrong, each in its own way: one loses a sign, one a term, one takes a factor out of a term that has
/// not got it.
TEST(Passes, AWrongOneIsNoticed) {
  const dsl::Predicate p = lowerings(everything).written();
  EXPECT_TRUE(equal_at_random_points(p, balance_sums(p), 2));
  const auto left_to_right = [](dsl::Graph& graph, const std::vector<Term>& terms) {
    Term total = terms.front();
    for (std::size_t i = 1; i < terms.size(); ++i) total = sum(graph, total, terms[i]);
    return total;
  };
  EXPECT_TRUE(equal_at_random_points(p, with_sums(p, left_to_right), 2));
  const auto loses_sign = [&](dsl::Graph& graph, std::vector<Term> terms) {
    terms.back().negative = false;
    return left_to_right(graph, terms);
  };
  EXPECT_FALSE(equal_at_random_points(p, with_sums(p, loses_sign), 2));
  const auto loses_term = [&](dsl::Graph& graph, std::vector<Term> terms) {
    if (terms.size() > 4) terms.pop_back();
    return left_to_right(graph, terms);
  };
  EXPECT_FALSE(equal_at_random_points(p, with_sums(p, loses_term), 2));
}

}  // namespace
}  // namespace tightrope::codegen::explore
