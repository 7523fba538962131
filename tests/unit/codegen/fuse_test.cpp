#include "codegen/fuse.h"

#include <gtest/gtest.h>

#include "tests/unit/codegen/random_predicate.h"

namespace tightrope::codegen {
namespace {

using namespace testing_support;

dsl::Predicate predicate(NodeId (*build)(dsl::Graph&)) {
  std::mt19937_64 random(1);
  dsl::Predicate p = random_predicate(random, {Inputs::exact, Ranges::none, 0, true});
  p.stages[0].outputs.resize(1);
  p.stages[0].outputs[0].nodes = {build(p.graph)};
  return p;
}

std::string contracted(NodeId (*build)(dsl::Graph&)) { return print(contract_products(predicate(build)).graph); }

TEST(Fuse, ASumOfProductsTakesOneProduct) {
  EXPECT_EQ(contracted([](dsl::Graph& g) {
              const NodeId ab = g.mul(g.input(0), g.input(1));
              const NodeId cd = g.mul(g.input(2), g.input(3));
              return g.add(g.add(ab, cd), g.mul(g.input(4), g.input(5)));
            }),
            "%0 = input 0\n%1 = input 1\n%2 = input 2\n%3 = input 3\n%4 = input 4\n%5 = input 5\n"
            "%6 = mul %0 %1\n%7 = fma %2 %3 %6\n%8 = fma %4 %5 %7\n");
}

TEST(Fuse, ADifferenceNegatesWhatIsSubtracted) {
  EXPECT_EQ(contracted([](dsl::Graph& g) { return g.sub(g.input(0), g.mul(g.input(1), g.input(2))); }),
            "%0 = input 0\n%1 = input 1\n%2 = input 2\n%3 = neg %1\n%4 = fma %3 %2 %0\n");
  EXPECT_EQ(contracted([](dsl::Graph& g) { return g.sub(g.mul(g.input(1), g.input(2)), g.input(0)); }),
            "%0 = input 0\n%1 = input 1\n%2 = input 2\n%3 = neg %0\n%4 = fma %1 %2 %3\n");
}

TEST(Fuse, AProductThatIsUsedTwiceStays) {
  EXPECT_EQ(contracted([](dsl::Graph& g) {
              const NodeId ab = g.mul(g.input(0), g.input(1));
              return g.mul(ab, g.add(ab, g.input(2)));
            }),
            "%0 = input 0\n%1 = input 1\n%2 = input 2\n%3 = mul %0 %1\n%4 = add %2 %3\n%5 = mul %3 %4\n");
}

/// The exact value stays, and the bounds of the fused graph hold.
TEST(Fuse, BoundsOfContractedPredicatesHold) {
  std::mt19937_64 random(5);
  for (const BoundMode mode : {BoundMode::tight, BoundMode::safe}) {
    Tally tally;
    for (int i = 0; i < 100; ++i) {
      const dsl::Predicate p = random_predicate(random, {Inputs::mixed, Ranges::none, 12, true});
      dsl::Diagnostics diagnostics;
      const BoundedPredicate bounded = add_bounds(contract_products(p), mode, Precision::binary64, diagnostics);
      ASSERT_FALSE(diagnostics.has_errors());
      for (int j = 0; j < 20; ++j) {
        check_sample<DyadicRatio>(p, bounded, random_sample<double>(random, p, 1), tally);
      }
    }
    EXPECT_EQ(tally.violations + tally.wrong_signs, 0);
    EXPECT_GT(tally.definite, tally.checked / 4);
  }
}

}  // namespace
}  // namespace tightrope::codegen
