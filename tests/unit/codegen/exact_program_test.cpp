#include "codegen/exact_program.h"

#include <gtest/gtest.h>

#include "codegen/exact_order.h"
#include "codegen/print_staged.h"
#include "tests/unit/codegen/test_program.h"

namespace tightrope::codegen {
namespace {

using testing_support::program;

std::string first_error(const std::string& body, bool staged = false) {
  const dsl::Program p = program("predicate p" + body);
  dsl::Diagnostics errors;
  if (staged) {
    EXPECT_FALSE(staged_predicate(p.predicates.front(), Precision::binary64, errors));
  } else {
    EXPECT_FALSE(exact_program(p.predicates.front(), errors));
  }
  return errors.entries().empty() ? "" : errors.entries().front().message;
}

TEST(ExactProgram, RefusesWhatHasNoSignRule) {
  EXPECT_EQ(first_error("(scalar a, b) { sign sqrt(a) + sqrt(b) as s }"),
            "the exact sign of `sqrt(a) + sqrt(b)` is not supported: it needs more than one square root");
  EXPECT_EQ(first_error("(scalar a, b) { sign b / (1 + sqrt(a)) as s }"),
            "the exact sign of `b / (1 + sqrt(a))` is not supported: it divides by a sum with a square root");
  EXPECT_EQ(first_error("(scalar a) { value sqrt(a) as s }"),
            "the exact value of `sqrt(a)` is not supported: it contains a square root");
  EXPECT_EQ(first_error("(bounded scalar a) { sign a }", true),
            "predicate `p` has no signs in mode `staged`: the exact value of the input `a` is not known");
}

/// The nodes behind the only sign of a predicate.
struct OnlySign {
  ExactProgram program;
  ExactOrder order;
};

OnlySign only_sign(const std::string& body) {
  const dsl::Program p = program("predicate p" + body);
  dsl::Diagnostics errors;
  OnlySign result = {*exact_program(p.predicates.front(), errors), {}};
  result.order = exact_order(p.predicates.front().stages.front(), result.program, 0, ExactPart::signs);
  return result;
}

TEST(ExactProgram, ConstantFactorsCostNothing) {
  const OnlySign s = only_sign("(scalar a, b) { sign (a / 7) * (b * 0.3) * 2 as s }");
  ASSERT_EQ(s.order.nodes.size(), 1U);
  EXPECT_EQ(s.program.graph[s.order.nodes.front()].op, ExactOp::product);
  EXPECT_EQ(s.program.graph[s.order.nodes.front()].growth, 1);
}

TEST(ExactProgram, GrowthOfADeterminantIsThatOfItsMonomials) {
  const OnlySign s = only_sign("(vec3 u, v, w) { sign det(u, v, w) as s }");
  const ExactNode& sign = s.program.graph[s.program.stages[0].outputs[0].elements[0].sign];
  EXPECT_EQ(sign.degree, 3);
  EXPECT_EQ(sign.growth, 6);
  EXPECT_EQ(growth_bits(sign), 3);
  EXPECT_EQ(fixed_input_bits(s.program.graph, s.order, 1), 62);  // 3 * 62 + 3 = 189 bits and the sign: 3 words
  EXPECT_EQ(widest_words(s.program.graph, s.order, 62), 3);
}

TEST(ExactProgram, TermsOfUnlikeDegreesAreRaised) {
  EXPECT_FALSE(only_sign("(scalar a, b) { sign a * a - b * b as s }").order.raises);
  EXPECT_TRUE(only_sign("(scalar a, b) { sign a * a - b as s }").order.raises);
}

}  // namespace
}  // namespace tightrope::codegen
