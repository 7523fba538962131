/// The bounds of random predicates against exact arithmetic: |value - exact| <= bound for every output, in every mode
/// and precision, at all scales; and with each term of the bound left out, violations are found.

#include "codegen/bounds.h"

#include <gtest/gtest.h>
#include <tightrope/exact.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "codegen/simplify.h"
#include "dsl/evaluate.h"

namespace tightrope::codegen {
namespace {

using dsl::NodeId;
using dsl::Op;

enum class Inputs { exact, bounded, mixed };
enum class Ranges { none, all, uneven };  ///< all: 4 for every input; uneven: 2^-100 .. 2^100, each its own

struct Shape {
  Inputs inputs = Inputs::mixed;
  Ranges ranges = Ranges::none;
  int operations = 16;
  bool polynomial_only = false;  ///< no max, min, abs
  bool uneven_scales = false;    ///< inputs of one sample differ by hundreds of binades, constants by dozens
};

/// A predicate over six scalars with a random graph; the last few nodes are outputs.
dsl::Predicate random_predicate(std::mt19937_64& random, const Shape& shape) {
  const auto pick = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  dsl::Predicate p;
  p.name = "random";
  std::vector<NodeId> values;
  // Names that groups of inputs have too: they must not be taken for those.
  const char* const names[] = {"d", "b", "v_x", "d_x", "x", "y"};
  for (int i = 0; i < 6; ++i) {
    dsl::Parameter parameter;
    parameter.name = names[i];
    parameter.bounded = shape.inputs == Inputs::bounded || (shape.inputs == Inputs::mixed && i % 2 == 1);
    if (shape.ranges == Ranges::all) parameter.range = 4;
    if (shape.ranges == Ranges::uneven) parameter.range = std::ldexp(1.0, pick(201) - 100);
    parameter.first_slot = i;
    p.parameters.push_back(parameter);
    p.slots.push_back({i, 0, 0, 0});
    values.push_back(p.graph.input(i));
  }
  const auto operand = [&] { return values[static_cast<std::size_t>(pick(static_cast<int>(values.size())))]; };
  const double even[] = {3, 0.75, -5, 7, 0.1875, 2, -1};
  const double uneven[] = {3, 0x1.8p40, -5, 0x1.4p-30, 0x1p35, 100, -1};
  const auto& constants = shape.uneven_scales ? uneven : even;
  for (int i = 0; i < shape.operations; ++i) {
    const NodeId a = operand();
    const NodeId b = operand();
    NodeId made = a;
    switch (pick(shape.polynomial_only ? 10 : 13)) {
      case 0:
      case 1:
      case 2:
        made = p.graph.sub(a, b);
        break;
      case 3:
      case 4:
        made = p.graph.add(a, b);
        break;
      case 5:
      case 6:
        made = p.graph.mul(a, b);
        break;
      case 7:
        made = p.graph.mul(a, p.graph.constant(constants[pick(7)]));
        break;
      case 8:
        made = p.graph.mul_pow2(a, (pick(7) - 3) * (shape.uneven_scales ? 12 : 1));
        break;
      case 9:
        made = p.graph.binary(Op::div, a, p.graph.constant(std::abs(constants[pick(4)])));
        break;
      case 10:
        made = p.graph.binary(Op::max, a, b);
        break;
      case 11:
        made = p.graph.binary(Op::min, a, b);
        break;
      default:
        made = p.graph.abs(a);
        break;
    }
    values.push_back(made);
  }
  dsl::Stage stage;
  stage.name = "evaluate";
  for (int i = 0; i < 5; ++i) {
    dsl::Output output;
    output.name = "out" + std::to_string(i);
    output.nodes = {values[values.size() - 1 - static_cast<std::size_t>(i)]};
    stage.outputs.push_back(output);
  }
  p.stages.push_back(stage);
  return p;
}

template <class Real>
struct Sample {
  std::vector<Real> slots;         ///< values, then bounds of bounded inputs
  std::vector<DyadicRatio> exact;  ///< the exact inputs
};

/// Values near `scale`: random, small multiples of a grid, or close to an earlier value; bounds from 0 to comparable.
template <class Real>
Sample<Real> random_sample(std::mt19937_64& random, const dsl::Predicate& p, double common_scale,
                           bool uneven_scales = false) {
  const auto uniform = [&] { return std::ldexp(static_cast<double>(random() >> 11), -52) - 1; };
  Sample<Real> s;
  const std::size_t n = p.slots.size();
  s.slots.resize(2 * n, Real(0));
  for (std::size_t i = 0; i < n; ++i) {
    Real value;
    const double own_scale = uneven_scales ? std::ldexp(1.0, static_cast<int>(random() % 120) - 60) : 1;
    const double scale = std::min(common_scale * own_scale, static_cast<double>(std::numeric_limits<Real>::max() / 16));
    switch (random() % 4) {
      case 0:
        value = static_cast<Real>(scale * static_cast<double>(static_cast<int>(random() % 9) - 4));
        break;
      case 1:
        value = i == 0 ? static_cast<Real>(scale) : s.slots[i - 1];
        break;
      case 2:
        value = i == 0
                    ? static_cast<Real>(scale)
                    : std::nextafter(s.slots[i - 1], static_cast<Real>(uniform() * std::numeric_limits<Real>::max()));
        break;
      default:
        value = static_cast<Real>(scale * 4 * uniform());
    }
    const Real range = static_cast<Real>(p.parameters[i].range.value_or(0));
    if (p.parameters[i].range) value = std::min(std::max(value, -range), range);
    s.slots[i] = value;
    Real exact = value;
    if (p.parameters[i].bounded) {
      const int how = static_cast<int>(random() % 4);
      const int shift = how == 0 ? 0 : how == 1 ? -50 : how == 2 ? -20 : -1;
      Real bound = how == 0 ? Real(0) : static_cast<Real>(std::abs(std::ldexp(scale * uniform(), shift)));
      if (p.parameters[i].range) bound = std::min(bound, range);
      s.slots[n + i] = bound;
      // The worst errors are the extreme ones: the exact input is value +- bound as often as not.
      const DyadicRatio spread = DyadicRatio(static_cast<double>(bound)) *
                                 DyadicRatio(random() % 2 ? 1.0 : static_cast<double>(random() % 1024) / 1024) *
                                 DyadicRatio(random() % 2 ? 1.0 : -1.0);
      s.exact.push_back(DyadicRatio(static_cast<double>(value)) + spread);
      continue;
    }
    s.exact.push_back(DyadicRatio(static_cast<double>(exact)));
  }
  return s;
}

struct Tally {
  int checked = 0;
  int violations = 0;
  int definite = 0;
  int wrong_signs = 0;
};

template <class Real>
void check_sample(const dsl::Predicate& p, const BoundedPredicate& bounded, const Sample<Real>& sample, Tally& tally) {
  const auto computed = dsl::evaluate<Real>(bounded.graph, sample.slots);
  const auto exact = dsl::evaluate<DyadicRatio>(p.graph, sample.exact);
  for (std::size_t o = 0; o < p.stages[0].outputs.size(); ++o) {
    const BoundedNode node = bounded.stages[0].outputs[o].elements[0];
    const double value = static_cast<double>(computed[static_cast<std::size_t>(node.value)]);
    const double bound = static_cast<double>(computed[static_cast<std::size_t>(node.bound)]);
    const DyadicRatio& truth = exact[static_cast<std::size_t>(p.stages[0].outputs[o].nodes[0])];
    ++tally.checked;
    const int sign = value > bound ? 1 : value < -bound ? -1 : 0;
    if (sign != 0) ++tally.definite;
    if (sign != 0 && sign != truth.sign()) ++tally.wrong_signs;
    if (!std::isfinite(value) || !std::isfinite(bound)) continue;
    if (abs(DyadicRatio(value) - truth) > DyadicRatio(bound)) ++tally.violations;
  }
}

/// Input scales for one precision: around 1 mostly, and out to where everything under- or overflows.
template <class Real>
double random_scale(std::mt19937_64& random, bool ranges) {
  const int extreme = std::is_same_v<Real, double> ? 1070 : 148;
  const int usual = random() % 2 ? 3 : extreme;
  int exponent = static_cast<int>(random() % static_cast<unsigned>(2 * usual)) - usual;
  if (ranges) exponent = std::min(exponent, 0);
  exponent = std::min(exponent, std::numeric_limits<Real>::max_exponent - 4);
  return std::ldexp(1.0, exponent);
}

template <class Real>
Tally campaign(BoundMode mode, const Shape& shape, int predicates, int samples, Weakening weakening = Weakening::none,
               std::uint64_t seed = 20150804) {
  std::mt19937_64 random(seed);
  const Precision precision = std::is_same_v<Real, double> ? Precision::binary64 : Precision::binary32;
  Tally tally;
  for (int i = 0; i < predicates; ++i) {
    const dsl::Predicate p = random_predicate(random, shape);
    dsl::Diagnostics diagnostics;
    const BoundedPredicate bounded = add_bounds(p, mode, precision, diagnostics, weakening);
    EXPECT_FALSE(diagnostics.has_errors());
    for (int j = 0; j < samples; ++j) {
      const double scale = random_scale<Real>(random, shape.ranges == Ranges::all);
      check_sample<Real>(p, bounded, random_sample<Real>(random, p, scale, shape.uneven_scales), tally);
    }
  }
  return tally;
}

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
      check_sample<double>(p, bounded, s, tally);
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
