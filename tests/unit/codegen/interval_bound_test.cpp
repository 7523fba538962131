/// Mode `interval` against exact arithmetic.

#include "codegen/interval_bound.h"

#include "codegen/precision.h"
#include "tests/unit/codegen/predicates_of_scalars.h"

namespace tightrope::codegen {
namespace {

using dsl::Graph;
using dsl::Op;
using testing_support::Tally;

void expect_sound(const Tally& tally, int least_definite) {
  EXPECT_EQ(tally.violations, 0);
  EXPECT_EQ(tally.wrong_signs, 0);
  EXPECT_GT(tally.definite, least_definite);
}

TEST(IntervalBound, CoversErrorsOfRandomPredicates) {
  for (const int operations : {2, 5, 12}) {
    SCOPED_TRACE(operations);
    for (const bool bounded : {false, true}) {
      expect_sound(testing_support::campaign<double>(BoundMode::interval, 200, 60, operations, -4, 4, bounded), 3000);
      expect_sound(testing_support::campaign<float>(BoundMode::interval, 100, 60, operations, -4, 4, bounded), 1000);
    }
  }
}

TEST(IntervalBound, CoversErrorsAtAllScales) {
  expect_sound(testing_support::campaign<double>(BoundMode::interval, 400, 60, 5, -1070, 1020, false), 2000);
  expect_sound(testing_support::campaign<float>(BoundMode::interval, 400, 60, 5, -148, 124, false), 2000);
}

/// Lemma I on the numbers around which it is tight: powers of two, their neighbours, subnormal numbers. The interval of
/// x + 0 * y is that of one rounded sum, whose ends must pass the neighbours of x.
template <class Real>
void expect_ends_beyond_the_neighbours(int lowest, int highest) {
  const FloatFormat& f = format(testing_support::precision_of<Real>);
  const Real unit = static_cast<Real>(round_up(f.unit_roundoff * (1 + 4 * f.unit_roundoff), f));
  for (int e = lowest; e <= highest; ++e) {
    const Real power = std::ldexp(Real(1), e);
    for (const Real x : {power, std::nextafter(power, Real(0)), std::nextafter(power, 4 * power)}) {
      const Real reach = x * unit + static_cast<Real>(f.eta);
      const Real below = x - reach;
      const Real above = x + reach;
      EXPECT_LE(below, std::nextafter(x, Real(-1))) << x;
      EXPECT_GE(above, std::nextafter(x, std::numeric_limits<Real>::infinity())) << x;
    }
  }
}

TEST(IntervalBound, EndsPassTheNeighbours) {
  expect_ends_beyond_the_neighbours<double>(-1074, 1022);
  expect_ends_beyond_the_neighbours<float>(-149, 126);
}

BoundedPredicate bounded(const dsl::Predicate& p) {
  dsl::Diagnostics diagnostics;
  BoundedPredicate result = add_bounds(p, BoundMode::interval, Precision::binary64, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors());
  return result;
}

int sign_at(const BoundedPredicate& b, std::vector<double> slots) {
  slots.resize(2 * slots.size());
  const auto v = dsl::evaluate<double>(b.graph, slots);
  const BoundedNode node = b.stages[0].outputs[0].elements[0];
  const double value = v[static_cast<std::size_t>(node.value)];
  const double bound = v[static_cast<std::size_t>(node.bound)];
  return value > bound ? 1 : value < -bound ? -1 : 0;
}

TEST(IntervalBound, AQuotientByWhatMayBeZeroIsUncertain) {
  const std::vector<testing_support::Scalar> scalars(3);
  const BoundedPredicate exact = bounded(testing_support::predicate_of_scalars(
      scalars, [](Graph& g) { return g.binary(Op::div, g.input(0), g.input(1)); }));
  EXPECT_EQ(sign_at(exact, {1, 2, 0}), 1);
  EXPECT_EQ(sign_at(exact, {1, -0x1p-1074, 0}), 0);  // overflow
  EXPECT_EQ(sign_at(exact, {0x1p-1074, -0x1p-1074, 0}), -1);
  EXPECT_EQ(sign_at(exact, {1, 0, 0}), 0);
  EXPECT_EQ(sign_at(exact, {1, INFINITY, 0}), 0);
  EXPECT_EQ(sign_at(exact, {1, NAN, 0}), 0);
  const BoundedPredicate rounded = bounded(testing_support::predicate_of_scalars(scalars, [](Graph& g) {
    return g.binary(Op::div, g.input(0), g.sub(g.mul(g.input(1), g.input(1)), g.mul(g.input(2), g.input(2))));
  }));
  EXPECT_EQ(sign_at(rounded, {1, 3, 2}), 1);
  EXPECT_EQ(sign_at(rounded, {1, 2, 3}), -1);
  EXPECT_EQ(sign_at(rounded, {1, 0.1, 0.1}), 0);
}

TEST(IntervalBound, ARootOfWhatMayBeNegativeIsUncertain) {
  const BoundedPredicate b =
      bounded(testing_support::predicate_of_scalars(std::vector<testing_support::Scalar>(3), [](Graph& g) {
        return g.sub(g.unary(Op::sqrt, g.sub(g.mul(g.input(0), g.input(0)), g.mul(g.input(1), g.input(1)))),
                     g.input(2));
      }));
  EXPECT_EQ(sign_at(b, {5, 3, 3.999999}), 1);
  EXPECT_EQ(sign_at(b, {5, 3, 4.000001}), -1);
  EXPECT_EQ(sign_at(b, {0.1, 0.1, -1}), 0);
  EXPECT_EQ(sign_at(b, {3, 5, -1}), 0);
}

TEST(IntervalBound, EveryDroppedTermIsNoticed) {
  const auto violations = [](Weakening weakening, double scale, bool uncertain,
                             const std::function<dsl::NodeId(Graph&)>& build) {
    const std::vector<testing_support::Scalar> scalars(3, {0, uncertain});
    EXPECT_EQ(testing_support::weakened_violations(BoundMode::interval, Weakening::none, scalars, scale, build), 0);
    return testing_support::weakened_violations(BoundMode::interval, weakening, scalars, scale, build);
  };
  const auto difference = [](Graph& g) { return g.sub(g.input(0), g.input(1)); };
  const auto product = [](Graph& g) { return g.mul(g.input(0), g.input(1)); };
  EXPECT_GT(violations(Weakening::drop_rounding_of_differences, 1, false, difference), 0);
  EXPECT_GT(violations(Weakening::drop_rounding_of_products, 1, false, product), 0);
  // The middle of the ends hides one such loss; three do not.
  EXPECT_GT(violations(Weakening::halve_unit_roundoff, 1, false, product), 0);
  EXPECT_GT(violations(Weakening::drop_rounding_of_sums, 1, false,
                       [](Graph& g) { return g.add(g.mul_pow2(g.input(0), 1), g.input(1)); }),
            0);
  EXPECT_GT(violations(Weakening::drop_division_rounding, 1, false,
                       [](Graph& g) { return g.binary(Op::div, g.input(0), g.constant(3)); }),
            0);
  EXPECT_GT(violations(Weakening::drop_input_bound, 1, true, difference), 0);
  EXPECT_GT(violations(Weakening::drop_underflow, 0x1p-530, false, product), 0);
}

}  // namespace
}  // namespace tightrope::codegen
