/// Division by run-time values, roots and fused products: their bounds against enclosures of more than 200 bits, in
/// every mode and precision, at all scales; what the guards refuse; and each term left out is noticed.

#include <gtest/gtest.h>
#include <tightrope/sign.h>

#include <cstdlib>

#include "tests/unit/codegen/random_predicate.h"

namespace tightrope::codegen {
namespace {

using namespace testing_support;

template <class Real>
void expect_sound(BoundMode mode) {
  for (const Inputs inputs : {Inputs::exact, Inputs::bounded, Inputs::mixed}) {
    for (const Ranges ranges : {Ranges::none, Ranges::all, Ranges::uneven}) {
      const bool uneven = ranges == Ranges::uneven;
      SCOPED_TRACE(testing::Message() << "inputs " << static_cast<int>(inputs) << " ranges "
                                      << static_cast<int>(ranges));
      const Tally tally = campaign<Real>(mode, {inputs, ranges, 9, false, uneven, true}, 200, 30);
      EXPECT_EQ(tally.violations, 0);
      EXPECT_EQ(tally.wrong_signs, 0);
      EXPECT_GT(tally.definite, tally.checked / 20);
    }
  }
}

TEST(TightBound, HoldsForQuotientsAndRootsInDouble) { expect_sound<double>(BoundMode::tight); }
TEST(TightBound, HoldsForQuotientsAndRootsInFloat) { expect_sound<float>(BoundMode::tight); }
TEST(SafeBound, HoldsForQuotientsAndRootsInDouble) { expect_sound<double>(BoundMode::safe); }
TEST(SafeBound, HoldsForQuotientsAndRootsInFloat) { expect_sound<float>(BoundMode::safe); }

TEST(TightBound, EveryDroppedTermOfQuotientsAndRootsIsNoticed) {
  const std::pair<Weakening, const char*> weakenings[] = {
      {Weakening::drop_division_rounding, "u |a / b|"}, {Weakening::drop_dividend_error, "Ra of a / b"},
      {Weakening::drop_divisor_error, "Rb of a / b"},   {Weakening::drop_divisor_margin, "|b| - Rb"},
      {Weakening::drop_root_rounding, "u |sqrt(a)|"},   {Weakening::drop_radicand_error, "Ra of sqrt(a)"},
      {Weakening::drop_fma_rounding, "u |a b + c|"},    {Weakening::drop_guards, "guards"},
  };
  for (const BoundMode mode : {BoundMode::tight, BoundMode::safe}) {
    for (const auto& [weakening, name] : weakenings) {
      int noticed = 0;
      for (const Inputs inputs : {Inputs::exact, Inputs::bounded}) {
        const Tally tally = campaign<double>(mode, {inputs, Ranges::none, 4, true, false, true}, 400, 30, weakening);
        noticed += tally.violations + tally.wrong_signs;
      }
      // SafeBound bounds a fused product's rounding with maxima: one missing rounding hides behind them here.
      if (mode == BoundMode::safe && weakening == Weakening::drop_fma_rounding) continue;
      EXPECT_GT(noticed, 0) << name << ", mode " << codegen::name(mode);
    }
  }
}

/// A predicate with one output over scalars: even-numbered ones exact, odd-numbered ones bounded if `bounded`.
dsl::Predicate scalars(int count, bool bounded, NodeId (*build)(dsl::Graph&)) {
  dsl::Predicate p;
  p.name = "scalars";
  for (int i = 0; i < count; ++i) {
    dsl::Parameter parameter;
    parameter.name = std::string(1, static_cast<char>('a' + i));
    parameter.bounded = bounded;
    parameter.first_slot = i;
    p.parameters.push_back(parameter);
    p.slots.push_back({i, 0, 0, 0});
    p.graph.input(i);
  }
  dsl::Output output;
  output.name = "out";
  output.nodes = {build(p.graph)};
  p.stages.push_back({"evaluate", {output}});
  return p;
}

NodeId quotient(dsl::Graph& g) { return g.binary(Op::div, g.input(0), g.input(1)); }
NodeId root(dsl::Graph& g) { return g.unary(Op::sqrt, g.input(0)); }
NodeId root_of_difference(dsl::Graph& g) { return g.unary(Op::sqrt, g.sub(g.input(0), g.input(1))); }
NodeId distance(dsl::Graph& g) {
  const NodeId d = g.sub(g.input(0), g.input(1));
  const NodeId e = g.sub(g.input(1), g.input(2));
  return g.unary(Op::sqrt, g.add(g.mul(d, d), g.mul(e, e)));
}

/// Value and bound for the given slots (values, then bounds).
template <class Real>
Bounded<Real> compute(BoundMode mode, const dsl::Predicate& p, const std::vector<Real>& slots) {
  const Precision precision = std::is_same_v<Real, double> ? Precision::binary64 : Precision::binary32;
  dsl::Diagnostics diagnostics;
  const BoundedPredicate bounded = add_bounds(p, mode, precision, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors());
  const auto v = dsl::evaluate<Real>(bounded.graph, slots);
  const BoundedNode node = bounded.stages[0].outputs[0].elements[0];
  return {v[static_cast<std::size_t>(node.value)], v[static_cast<std::size_t>(node.bound)]};
}

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double eta = 0x1p-1074;
constexpr BoundMode modes[] = {BoundMode::tight, BoundMode::safe};

TEST(Quotients, ADivisorThatMayBeZeroOrIsNotFiniteMakesTheResultUncertain) {
  for (const BoundMode mode : modes) {
    const auto p = scalars(2, true, quotient);
    for (const double b : {0.0, 0.5, -0.5, 1.0, -1.0, infinity, -infinity}) {
      const Bounded<double> y = compute<double>(mode, p, {3, b, 0, 1});
      EXPECT_TRUE(std::isnan(y.value)) << b;
      EXPECT_EQ(sign(y), Sign::uncertain) << b;
    }
    EXPECT_EQ(sign(compute<double>(mode, p, {3, 1.5, 0, 0.25})), Sign::positive);
    EXPECT_EQ(sign(compute<double>(mode, p, {3, -1.5, 0, 0.25})), Sign::negative);
    EXPECT_EQ(sign(compute<double>(mode, p, {3, 1.5, 0, infinity})), Sign::uncertain);
    EXPECT_EQ(sign(compute<double>(mode, p, {3, 1.5, 0, std::nan("")})), Sign::uncertain);
    const auto exact = scalars(2, false, quotient);
    for (const double b : {0.0, infinity, -infinity, std::nan("")}) {
      EXPECT_TRUE(std::isnan(compute<double>(mode, exact, {3, b, 0, 0}).value)) << b;
    }
  }
}

TEST(Quotients, ARadicandThatMayBeNegativeMakesTheResultUncertain) {
  for (const BoundMode mode : modes) {
    const auto p = scalars(1, true, root);
    EXPECT_EQ(sign(compute<double>(mode, p, {1, 1.5})), Sign::uncertain);
    EXPECT_TRUE(std::isnan(compute<double>(mode, p, {-1, 0}).value));
    EXPECT_EQ(sign(compute<double>(mode, p, {1, 0.25})), Sign::positive);
    const auto difference = scalars(2, false, root_of_difference);
    EXPECT_TRUE(std::isnan(compute<double>(mode, difference, {1, 2, 0, 0}).value));
    EXPECT_EQ(sign(compute<double>(mode, difference, {2, 1, 0, 0})), Sign::positive);
  }
}

TEST(Quotients, TheRootOfZeroIsZero) {
  for (const BoundMode mode : modes) {
    const Bounded<double> exact = compute<double>(mode, scalars(1, false, root), {0, 0});
    EXPECT_EQ(exact.value, 0);
    EXPECT_LE(exact.bound, 0x1p-1000);
    const Bounded<double> distance_of_equals = compute<double>(mode, scalars(3, false, distance), {1, 1, 1, 0, 0, 0});
    EXPECT_EQ(distance_of_equals.value, 0);
    EXPECT_LE(distance_of_equals.bound, 0x1p-500);
  }
  const auto difference = scalars(2, false, root_of_difference);  // exactly 0, where SafeBound sees a bound above 0
  const Bounded<double> y = compute<double>(BoundMode::tight, difference, {1, 1, 0, 0});
  EXPECT_EQ(y.value, 0);
  EXPECT_EQ(y.bound, 0);
}

/// L = 0 and a true quotient up to 2^8 eta (MATH 4.2).
TEST(TightBound, OfAQuotientSeesUnderflowAmplifiedByADivisorNearItsBound) {
  const auto p = scalars(2, true, quotient);
  const Bounded<double> y = compute<double>(BoundMode::tight, p, {eta, 4, 0, 4 * (1 - 0x1p-10)});
  EXPECT_EQ(y.value, 0);
  EXPECT_GE(y.bound, 0x1p8 * eta);
}

/// A quotient and a root of exact numbers are as tight as their rounding, at every scale.
TEST(TightBound, OfAQuotientOrRootOfExactNumbersIsHalfAnUlp) {
  for (const double scale : {0x1p-1000, 1.0, 0x1p900}) {
    const Bounded<double> q = compute<double>(BoundMode::tight, scalars(2, false, quotient), {scale, 3, 0, 0});
    EXPECT_LE(q.bound, q.value * 0x1.001p-53 + 4 * eta);
    const Bounded<double> r = compute<double>(BoundMode::tight, scalars(1, false, root), {3 * scale, 0});
    EXPECT_LE(r.bound, r.value * 0x1.001p-53);
    const Bounded<double> d = compute<double>(BoundMode::tight, scalars(3, false, distance),
                                              {std::sqrt(scale), 0, std::sqrt(scale), 0, 0, 0});
    EXPECT_LE(d.bound, d.value * 0x1.ap-52);  // (4/2 + 1) u, and what may have underflowed
  }
}

}  // namespace
}  // namespace tightrope::codegen
