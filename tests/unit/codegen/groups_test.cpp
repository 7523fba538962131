/// `group`: which inputs share a maximum, what that makes of B, of the cost and of the bound.

#include <gtest/gtest.h>

#include "codegen/count.h"
#include "codegen/measure.h"
#include "test_program.h"

namespace tightrope::codegen {
namespace {

struct Result {
  std::string magnitude;
  int bound_operations = 0;
  double median_ratio = 0;  ///< bound / true error
};

/// The first output of the only predicate, mode safe; sound, or the test fails.
Result safe(const std::string& text) {
  const dsl::Program program = testing_support::program(text);
  dsl::Diagnostics diagnostics;
  const dsl::Predicate& predicate = program.predicates.front();
  const BoundedPredicate bounded = add_bounds(predicate, BoundMode::safe, Precision::binary64, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors());
  const OutputBound& output = bounded.stages.front().outputs.front();
  const auto measured = measure(predicate, bounded, Precision::binary64, Sampling::spread, 500);
  EXPECT_TRUE(measured.front().outputs.front().sound);
  return {output.magnitude, output_cost(bounded, output).bound.total(), measured.front().outputs.front().median_ratio};
}

std::string insphere(const std::string& group) {
  return "predicate f(point a, b, c, d) { " + group +
         " let p = a - d let q = b - d let r = c - d"
         " sign dot(p, p) * det(q, r, p + q) + dot(q, q) * det(p, r, q + r) as y }";
}

TEST(Groups, OneForAllIsCheaperAndLooser) {
  const Result axes = safe(insphere(""));
  const Result all = safe(insphere("group all"));
  EXPECT_NE(axes.magnitude.find("d_x d_y^3 d_z"), std::string::npos) << axes.magnitude;
  EXPECT_NE(all.magnitude.find("b^5"), std::string::npos) << all.magnitude;
  EXPECT_LT(all.bound_operations, axes.bound_operations);
  EXPECT_GT(all.median_ratio, axes.median_ratio);
  EXPECT_EQ(safe(insphere("group axis")).magnitude, axes.magnitude);
}

TEST(Groups, DisplacementsApartFromPositionsAreTighter) {
  const std::string text = " sign dot(p - a, diff(p)) as y }";
  const Result together = safe("predicate f(moving point p, a) {" + text);
  const Result apart = safe("predicate f(moving point p, a) { group displacements" + text);
  EXPECT_EQ(together.magnitude, "d_z^2 + d_y^2 + d_x^2");
  EXPECT_EQ(apart.magnitude, "d_z s_z + d_y s_y + d_x s_x");
  EXPECT_LT(apart.median_ratio, together.median_ratio);
  EXPECT_EQ(safe("predicate f(moving point p, a) { group all, displacements" + text).magnitude, "3 b s");
}

TEST(Groups, ListedParametersHaveMaximaOfTheirOwn) {
  const Result apart =
      safe("predicate f(vec2 a, b, scalar s, t) { group (a), (s, t) sign (s + s * t) * det(a, b) as y }");
  EXPECT_NE(apart.magnitude.find("v_x_group_1"), std::string::npos) << apart.magnitude;
  EXPECT_NE(apart.magnitude.find("b_group_2^2"), std::string::npos) << apart.magnitude;
}

}  // namespace
}  // namespace tightrope::codegen
