/// Mode `static`: constants that cover every error, are no looser than Gappa's, and lack nothing.

#include "codegen/static_bound.h"

#include <chrono>

#include "codegen/compile.h"
#include "codegen/precision.h"
#include "tests/unit/codegen/predicates_of_scalars.h"
#include "tests/unit/codegen/test_program.h"

namespace tightrope::codegen {
namespace {

using dsl::Graph;
using dsl::Op;
using testing_support::Tally;

void expect_sound(const Tally& tally, int least_definite) {
  EXPECT_EQ(tally.violations, 0);
  EXPECT_EQ(tally.wrong_signs, 0);
  EXPECT_GT(tally.definite, least_definite);
  EXPECT_LE(tally.greatest_ratio, 1);
}

TEST(StaticBound, CoversErrorsOfRandomPredicatesInDouble) {
  for (const int operations : {2, 5, 12}) {
    SCOPED_TRACE(operations);
    expect_sound(testing_support::campaign<double>(BoundMode::fixed, 300, 60, operations, -4, 4, false), 5000);
    expect_sound(testing_support::campaign<double>(BoundMode::fixed, 150, 60, operations, -4, 4, true), 0);
  }
}

TEST(StaticBound, CoversErrorsOfRandomPredicatesInFloat) {
  expect_sound(testing_support::campaign<float>(BoundMode::fixed, 300, 60, 6, -4, 4, false), 5000);
}

TEST(StaticBound, CoversErrorsAtAllScales) {
  expect_sound(testing_support::campaign<double>(BoundMode::fixed, 400, 60, 5, -1070, 300, false), 2000);
  expect_sound(testing_support::campaign<float>(BoundMode::fixed, 400, 60, 5, -148, 40, false), 2000);
}

/// u-multiples of the bound of the only output of `text`, its largest element.
double units(const std::string& text, Precision precision = Precision::binary64) {
  const dsl::Program program = testing_support::program(text);
  dsl::Diagnostics diagnostics;
  const auto bounded = bounded_programs(program, {BoundMode::fixed}, {precision}, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors());
  return bounded[0].predicates[0].stages[0].outputs[0].constant / format(precision).unit_roundoff;
}

/// Gappa proves 16 u, 192 u and 768 u, FPTaylor 152 u for the second (MATH 8).
TEST(StaticBound, IsNoLooserThanGappaAndFPTaylor) {
  EXPECT_EQ(units("predicate p(point2 a, b, c) { range |a, b, c| <= 1 sign det(a - c, b - c) as s }"), 16);
  const std::string coplanarity = "predicate p(point a, b, c, d) { range |a, b, c, d| <= 1 sign ";
  EXPECT_LE(units(coplanarity + "det(b - a, c - a, d - a) as s }"), 132.001);
  EXPECT_LE(units(coplanarity + "dot(cross(b - a, c - a), d - a) as s }", Precision::binary32), 132.01);
  EXPECT_LE(units("predicate p(moving point a, b, c, d) { range |a, b, c, d| <= 1\n"
                  "sign 3 * dot(cross(b - a, c - a), d - a) as k }"),
            768);
}

/// A sum of squares is never negative, which plain interval arithmetic of products would not know.
TEST(StaticBound, HasDivisionsAndRootsThatTheRangesMakeCertain) {
  EXPECT_LE(units("predicate p(scalar x, y) { range |x, y| <= 1 sign x / (y * y + 1) as s }"), 4);
  EXPECT_LE(units("predicate p(scalar x, y) { range |x, y| <= 1 sign sqrt(x * x + y * y + 1) as s }"), 4);
  // The root of something that may be 0 has an error of about sqrt(u).
  EXPECT_LE(units("predicate p(scalar x, y) { range |x, y| <= 1 sign sqrt(x * x + y * y) as s }"), 0x1p28);
}

/// |value - sqrt(exact radicand)| <= bound, by squaring.
TEST(StaticBound, CoversErrorsOfRoots) {
  std::mt19937_64 random(1);
  for (const double offset : {0.0, 1.0, 0x1p-40}) {
    const dsl::Predicate p = testing_support::predicate_of_scalars({{1, false}, {1, false}}, [&](Graph& g) {
      const auto squares = g.add(g.mul(g.input(0), g.input(0)), g.mul(g.input(1), g.input(1)));
      return g.unary(Op::sqrt, offset == 0 ? squares : g.add(squares, g.constant(offset)));
    });
    dsl::Diagnostics diagnostics;
    const BoundedPredicate b = add_bounds(p, BoundMode::fixed, Precision::binary64, diagnostics);
    ASSERT_FALSE(diagnostics.has_errors());
    for (int i = 0; i < 3000; ++i) {
      const double x = testing_support::random_input<double>(random, 1, 0);
      const double y = testing_support::random_input<double>(random, 1, x);
      const auto v = dsl::evaluate<double>(b.graph, std::vector<double>{x, y, 0, 0});
      const BoundedNode node = b.stages[0].outputs[0].elements[0];
      const DyadicRatio value(v[static_cast<std::size_t>(node.value)]);
      const DyadicRatio bound(v[static_cast<std::size_t>(node.bound)]);
      const DyadicRatio square =
          DyadicRatio(x) * DyadicRatio(x) + DyadicRatio(y) * DyadicRatio(y) + DyadicRatio(offset);
      EXPECT_LE(square, (value + bound) * (value + bound));
      EXPECT_TRUE(value < bound || (value - bound) * (value - bound) <= square);
    }
  }
}

TEST(StaticBound, EveryDroppedTermIsNoticed) {
  const auto violations = [](Weakening weakening, const std::vector<testing_support::Scalar>& scalars,
                             const std::function<dsl::NodeId(Graph&)>& build) {
    const double range = scalars[0].range;
    EXPECT_EQ(testing_support::weakened_violations(BoundMode::fixed, Weakening::none, scalars, range, build), 0);
    return testing_support::weakened_violations(BoundMode::fixed, weakening, scalars, range, build);
  };
  const std::vector<testing_support::Scalar> two = {{1, false}, {1, false}};
  const std::vector<testing_support::Scalar> three = {{1, false}, {1, false}, {1, false}};
  const auto in = [](Graph& g, int i) { return g.input(i); };
  EXPECT_GT(
      violations(Weakening::drop_rounding_of_differences, two, [&](Graph& g) { return g.sub(in(g, 0), in(g, 1)); }), 0);
  EXPECT_GT(violations(Weakening::drop_rounding_of_products, two, [&](Graph& g) { return g.mul(in(g, 0), in(g, 1)); }),
            0);
  EXPECT_GT(violations(Weakening::halve_unit_roundoff, two, [&](Graph& g) { return g.mul(in(g, 0), in(g, 1)); }), 0);
  EXPECT_GT(violations(Weakening::drop_rounding_of_sums, three,
                       [&](Graph& g) { return g.add(g.mul_pow2(in(g, 0), 1), in(g, 1)); }),
            0);
  EXPECT_GT(violations(Weakening::drop_division_rounding, two,
                       [&](Graph& g) { return g.binary(Op::div, in(g, 0), g.constant(3)); }),
            0);
  // The error of one factor, enlarged by an exact scaling so that the product's own rounding cannot hide its loss.
  const auto enlarged = [&](Graph& g) { return g.mul(g.mul_pow2(g.sub(in(g, 0), in(g, 1)), 2), in(g, 2)); };
  EXPECT_GT(violations(Weakening::drop_first_factor_error, three, enlarged) +
                violations(Weakening::drop_second_factor_error, three, enlarged),
            0);
  const std::vector<testing_support::Scalar> below_a_power = {{0.75, false}, {0.75, false}, {0.75, false}};
  EXPECT_GT(violations(Weakening::drop_operand_error_of_sums, below_a_power,
                       [&](Graph& g) { return g.sub(in(g, 2), g.mul_pow2(g.sub(in(g, 0), in(g, 1)), 2)); }),
            0);
  const std::vector<testing_support::Scalar> uncertain = {{1, true}, {1, true}};
  EXPECT_GT(violations(Weakening::drop_input_bound, uncertain, [&](Graph& g) { return g.add(in(g, 0), in(g, 1)); }), 0);
  EXPECT_GT(
      violations(Weakening::drop_product_of_errors, uncertain, [&](Graph& g) { return g.mul(in(g, 0), in(g, 1)); }), 0);
  const std::vector<testing_support::Scalar> tiny = {{0x1p-530, false}, {0x1p-530, false}};
  EXPECT_GT(violations(Weakening::drop_underflow, tiny, [&](Graph& g) { return g.mul(in(g, 0), in(g, 1)); }), 0);
}

std::string first_error(const std::string& text) {
  const dsl::Program program = testing_support::program(text);
  dsl::Diagnostics diagnostics;
  bounded_programs(program, {BoundMode::fixed}, {Precision::binary64}, diagnostics);
  return diagnostics.has_errors() ? diagnostics.entries().front().message : "";
}

TEST(StaticBound, SaysWhatItLacks) {
  EXPECT_EQ(first_error("predicate p(scalar x, y) { range |x| <= 1 sign x - y as s }"),
            "mode `static` needs a range of every input; `y` of predicate `p` has none");
  EXPECT_EQ(first_error("predicate p(scalar x, y) { range |x, y| <= 1 sign x / y as s }"),
            "the declared ranges do not keep a divisor away from 0");
  EXPECT_EQ(first_error("predicate p(scalar x) { range |x| <= 1 sign sqrt(x + 1/2) as s }"),
            "the declared ranges do not keep the radicand of a square root from being negative");
  EXPECT_EQ(first_error("predicate p(scalar x) { range |x| <= 2^600 sign x * x as s }"),
            "within the declared ranges a value may overflow");
  EXPECT_EQ(first_error("predicate p(scalar x) { range |x| <= 2^500 sign x * x as s }"), "");
}

TEST(StaticBound, OfTheCcdPredicatesTakesLessThanASecond) {
  for (const char* name : {"vertex_face", "edge_edge", "classification"}) {
    dsl::SourceMap sources;
    dsl::Diagnostics diagnostics;
    const std::string file = std::string(TIGHTROPE_SOURCE_DIR "/ccd/predicates/") + name + ".pred";
    const dsl::Program program = dsl::load_program(file, sources, diagnostics);
    const auto start = std::chrono::steady_clock::now();
    bounded_programs(program, {BoundMode::fixed}, {Precision::binary64}, diagnostics);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.render(sources);
    EXPECT_LT(seconds.count(), 4) << name;  // 0.2 on an idle machine of 2026; four times that under sanitizers
  }
}

}  // namespace
}  // namespace tightrope::codegen
