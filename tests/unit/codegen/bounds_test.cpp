/// The bounds of random predicates against exact arithmetic: |value - exact| <= bound for every output, in every mode
/// and precision, at all scales; and with each term of the bound left out, violations are found.

#include "codegen/bounds.h"

#include <gtest/gtest.h>
#include <tightrope/exact.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "codegen/simplify.h"
#include "dsl/evaluate.h"
#include "tests/unit/codegen/random_predicate.h"
#include "tests/unit/codegen/test_program.h"

namespace tightrope::codegen {
namespace {

using namespace testing_support;

template <class Real>
void expect_sound(BoundMode mode) {
  for (const Inputs inputs : {Inputs::exact, Inputs::bounded, Inputs::mixed}) {
    for (const Ranges ranges : {Ranges::none, Ranges::all, Ranges::uneven}) {
      for (const bool uneven_scales : {false, true}) {
        if (ranges == Ranges::uneven && !uneven_scales) continue;
        SCOPED_TRACE(testing::Message() << "inputs " << static_cast<int>(inputs) << " ranges "
                                        << static_cast<int>(ranges) << " uneven " << uneven_scales);
        const Tally tally = campaign<Real>(mode, {inputs, ranges, 14, false, uneven_scales}, 250, 40);
        EXPECT_EQ(tally.violations, 0);
        EXPECT_EQ(tally.wrong_signs, 0);
        EXPECT_GT(tally.definite, tally.checked / 20);
      }
    }
  }
}

TEST(TightBound, HoldsForRandomPredicatesInDouble) { expect_sound<double>(BoundMode::tight); }
TEST(TightBound, HoldsForRandomPredicatesInFloat) { expect_sound<float>(BoundMode::tight); }
TEST(SafeBound, HoldsForRandomPredicatesInDouble) { expect_sound<double>(BoundMode::safe); }
TEST(SafeBound, HoldsForRandomPredicatesInFloat) { expect_sound<float>(BoundMode::safe); }

TEST(TightBound, EveryDroppedTermIsNoticed) {
  const std::pair<Weakening, const char*> weakenings[] = {
      {Weakening::drop_rounding_of_sums, "u |a + b|"},
      {Weakening::drop_rounding_of_products, "u |a b|"},
      {Weakening::drop_rounding_of_differences, "u |x - y|"},
      {Weakening::drop_first_factor_error, "Ra |b|"},
      {Weakening::drop_second_factor_error, "|a| Rb"},
      {Weakening::drop_operand_error_of_sums, "Rb of a sum"},
      {Weakening::drop_division_rounding, "u |a / c|"},
      {Weakening::drop_input_bound, "bound of an input"},
      {Weakening::drop_underflow, "underflow"},
      {Weakening::halve_unit_roundoff, "u / 2"},
      {Weakening::drop_product_of_errors, "Ra Rb"},
  };
  for (const auto& [weakening, name] : weakenings) {
    int violations = 0;
    for (const Inputs inputs : {Inputs::exact, Inputs::bounded}) {
      violations += campaign<double>(BoundMode::tight, {inputs, Ranges::none, 8, true}, 300, 60, weakening).violations;
    }
    EXPECT_GT(violations, 0) << name;
  }
}

TEST(Bounds, HoldForWhateverEitherSelects) {
  for (const BoundMode mode : {BoundMode::tight, BoundMode::safe, BoundMode::interval, BoundMode::fixed}) {
    for (const Inputs inputs : {Inputs::exact, Inputs::mixed}) {
      for (const Ranges ranges : {Ranges::none, Ranges::all}) {
        if (mode == BoundMode::fixed && ranges == Ranges::none) continue;
        Shape shape{inputs, ranges, 12};
        shape.selections = true;
        const Tally tally = campaign<double>(mode, shape, 150, 40);
        EXPECT_EQ(tally.violations, 0) << name(mode);
        EXPECT_EQ(tally.wrong_signs, 0) << name(mode);
        EXPECT_GT(tally.definite, tally.checked / 20) << name(mode);
        EXPECT_GT(campaign<double>(mode, shape, 300, 60, Weakening::drop_second_alternative).violations, 0)
            << name(mode);
      }
    }
  }
}

TEST(TightBound, UnderflowFloorOfRangesIsNeeded) {
  const Shape shape{Inputs::exact, Ranges::all, 8, true};
  EXPECT_GT(campaign<double>(BoundMode::tight, shape, 300, 60, Weakening::drop_underflow).violations, 0);
}

TEST(SafeBound, DroppedInputBoundAndUnderflowAreNoticed) {
  const Shape bounded{Inputs::bounded, Ranges::none, 6, true};
  EXPECT_GT(campaign<double>(BoundMode::safe, bounded, 200, 60, Weakening::drop_input_bound).violations, 0);
  const Shape exact{Inputs::exact, Ranges::none, 6, true};
  EXPECT_GT(campaign<double>(BoundMode::safe, exact, 300, 60, Weakening::drop_underflow).violations, 0);
  EXPECT_GT(campaign<double>(BoundMode::safe, {Inputs::exact, Ranges::none, 3, true}, 600, 60,
                             Weakening::drop_rounding_of_differences)
                .violations,
            0);
}

/// A predicate with one output over scalar parameters that have the given ranges (0: none).
dsl::Predicate scalar_predicate(const std::vector<double>& ranges, const std::function<NodeId(dsl::Graph&)>& build) {
  dsl::Predicate p;
  p.name = "scalars";
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    dsl::Parameter parameter;
    parameter.name = std::string(1, static_cast<char>('a' + i));
    if (ranges[i] > 0) parameter.range = ranges[i];
    parameter.first_slot = static_cast<int>(i);
    p.parameters.push_back(parameter);
    p.slots.push_back({static_cast<int>(i), 0, 0, 0});
    p.graph.input(static_cast<std::int32_t>(i));
  }
  dsl::Output output;
  output.name = "out";
  output.nodes = {build(p.graph)};
  p.stages.push_back({"evaluate", {output}});
  return p;
}

/// (x y) x - (z w) z with x, z near 2^-540 and y, w near 2^190: no product of the value underflows, but x x, which the
/// bound computes, does.
TEST(SafeBound, UnderflowOfItsOwnEvaluationIsPartOfIt) {
  std::mt19937_64 random(3);
  for (const bool ranges : {true, false}) {
    const double small = ranges ? 1 : 0;
    const double large = ranges ? 0x1p200 : 0;
    const dsl::Predicate p = scalar_predicate({small, large, small, large}, [](dsl::Graph& g) {
      const NodeId left = g.mul(g.mul(g.input(0), g.input(1)), g.input(0));
      const NodeId right = g.mul(g.mul(g.input(2), g.input(3)), g.input(2));
      return g.sub(left, right);
    });
    dsl::Diagnostics diagnostics;
    const BoundedPredicate bounded = add_bounds(p, BoundMode::safe, Precision::binary64, diagnostics);
    Tally tally;
    for (int i = 0; i < 20000; ++i) {
      const auto near = [&](double x) { return x * (1 + std::ldexp(static_cast<double>(random() % 64), -52)); };
      const double x = std::ldexp(1 + static_cast<double>(random() >> 12) * 0x1p-52, -540);
      const double y = std::ldexp(1 + static_cast<double>(random() >> 12) * 0x1p-52, 190);
      Sample<double> s;
      s.slots = {x, y, near(x), near(y), 0, 0, 0, 0};
      for (int j = 0; j < 4; ++j) s.exact.emplace_back(s.slots[static_cast<std::size_t>(j)]);
      check_sample<DyadicRatio>(p, bounded, s, tally);
    }
    EXPECT_EQ(tally.violations, 0) << ranges;
    EXPECT_EQ(tally.wrong_signs, 0) << ranges;
  }
}

/// The sign of an infinity or a NaN is uncertain, whatever the operation.
TEST(Bounds, NonFiniteInputsHaveNoSign) {
  std::mt19937_64 random(7);
  const double bad[] = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                        std::numeric_limits<double>::quiet_NaN()};
  for (const BoundMode mode : {BoundMode::safe, BoundMode::tight}) {
    for (int i = 0; i < 300; ++i) {
      dsl::Predicate p = random_predicate(random, {Inputs::mixed, Ranges::none, 10, false});
      // A value that depends on input 0 through + and - only is as infinite as that input.
      p.stages[0].outputs[0].nodes[0] = p.graph.add(p.stages[0].outputs[0].nodes[0], p.graph.input(0));
      dsl::Diagnostics diagnostics;
      const BoundedPredicate bounded = add_bounds(p, mode, Precision::binary64, diagnostics);
      Sample<double> s = random_sample<double>(random, p, 1);
      s.slots[0] = bad[i % 3];
      const auto computed = dsl::evaluate<double>(bounded.graph, s.slots);
      const BoundedNode node = bounded.stages[0].outputs[0].elements[0];
      const double value = computed[static_cast<std::size_t>(node.value)];
      const double bound = computed[static_cast<std::size_t>(node.bound)];
      EXPECT_FALSE(value > bound || value < -bound) << value << " +- " << bound;
    }
  }
}

// 4 x overflows, comes back by a scaling down as an infinity, and min forgets it. The exact difference is negative.
TEST(Bounds, OverflowThatMinForgetsHasNoSign) {
  const std::string lost = "predicate f(scalar x, y, z) { sign min(rounded(4 * x) / 4, y) - z as d }";
  const std::string deep =
      "predicate f(scalar x, y, z) { let w = rounded(4 * x) sign -max(-rounded(w / 8), -y) - z as d }";
  const std::string bounded = "predicate f(bounded scalar x, scalar y, z) { sign min(rounded(4 * x) / 4, y) - z as d }";
  struct Case {
    std::string text;
    std::array<double, 3> inputs;
  };
  for (const Case& c : {Case{lost, {1e308, 1.5e308, 1.2e308}}, Case{deep, {1e308, 6e307, 5.5e307}},
                        Case{bounded, {1e308, 1.5e308, 1.2e308}}}) {
    const dsl::Program program = tightrope::testing_support::program(c.text);
    for (const BoundMode mode : {BoundMode::safe, BoundMode::tight, BoundMode::interval}) {
      dsl::Diagnostics diagnostics;
      const BoundedPredicate result = add_bounds(program.predicates.front(), mode, Precision::binary64, diagnostics);
      ASSERT_FALSE(diagnostics.has_errors());
      const std::array<double, 6> slots = {c.inputs[0], c.inputs[1], c.inputs[2], 1, 0, 0};
      const std::vector<double> values = dsl::evaluate<double>(result.graph, slots);
      const BoundedNode& d = result.stages.front().outputs.front().elements.front();
      const double value = values[static_cast<std::size_t>(d.value)], bound = values[static_cast<std::size_t>(d.bound)];
      EXPECT_FALSE(value > bound) << c.text << " " << name(mode);
    }
  }
}

TEST(Simplify, KeepsEveryValueOfRandomPredicates) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 2000; ++i) {
    const dsl::Predicate p = random_predicate(random, {Inputs::exact, Ranges::none, 20, false});
    const dsl::Predicate simple = simplify(p);
    EXPECT_LE(simple.graph.size(), p.graph.size() + 3);
    const Sample<double> s = random_sample<double>(random, p, random_scale<double>(random, true));
    const auto before = dsl::evaluate<double>(p.graph, s.slots);
    const auto after = dsl::evaluate<double>(simple.graph, s.slots);
    for (std::size_t o = 0; o < p.stages[0].outputs.size(); ++o) {
      const double x = before[static_cast<std::size_t>(p.stages[0].outputs[o].nodes[0])];
      const double y = after[static_cast<std::size_t>(simple.stages[0].outputs[o].nodes[0])];
      EXPECT_TRUE(x == y || !std::isfinite(x)) << x << " " << y;
    }
  }
}

TEST(Simplify, ADifferenceAndItsNegativeAreOneNode) {
  dsl::Predicate p = [] {
    std::mt19937_64 random(1);
    return random_predicate(random, {Inputs::exact, Ranges::none, 0, true});
  }();
  const NodeId x = p.graph.input(0);
  const NodeId y = p.graph.input(1);
  const NodeId z = p.graph.input(2);
  p.stages[0].outputs.resize(1);
  const NodeId left = p.graph.mul(p.graph.sub(x, y), z);
  const NodeId right = p.graph.mul(p.graph.sub(y, x), x);
  p.stages[0].outputs[0].nodes = {p.graph.add(left, right)};
  EXPECT_EQ(
      dsl::print(simplify(p).graph),
      "%0 = input 0\n%1 = input 1\n%2 = input 2\n%3 = sub %0 %1\n%4 = mul %2 %3\n%5 = mul %0 %3\n%6 = sub %4 %5\n");
}

}  // namespace
}  // namespace tightrope::codegen
