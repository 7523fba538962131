#include <gtest/gtest.h>

#include "tests/unit/dsl/compile.h"

namespace tightrope::dsl {
namespace {

TEST(Rounded, MultipliesTheFactorInWhereItStands) {
  const auto graph = [](const std::string& expression) {
    return print(
        testing::compile("predicate f(scalar a, b) { sign " + expression + " as y }").program.predicates.front().graph);
  };
  EXPECT_EQ(graph("3 * a * b"), "%0 = input 0\n%1 = input 1\n%2 = mul %0 %1\n%3 = constant 3\n%4 = mul %2 %3\n");
  EXPECT_EQ(graph("rounded(3 * a) * b"),
            "%0 = input 0\n%1 = input 1\n%2 = constant 3\n%3 = mul %0 %2\n%4 = mul %1 %3\n");
  EXPECT_EQ(graph("rounded(3) * a"), graph("3 * a"));
}

}  // namespace
}  // namespace tightrope::dsl
