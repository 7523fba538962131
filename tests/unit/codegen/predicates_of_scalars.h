#pragma once
/// Predicates of scalars x0, x1, ... for tests of bounds, and their check against exact arithmetic.

#include <gtest/gtest.h>
#include <tightrope/exact.h>

#include <cmath>
#include <functional>
#include <random>
#include <type_traits>

#include "codegen/bounds.h"
#include "dsl/evaluate.h"

namespace tightrope::testing_support {

using codegen::BoundedNode;
using codegen::BoundedPredicate;
using codegen::BoundMode;
using codegen::Precision;
using codegen::Weakening;

struct Scalar {
  double range = 0;  ///< 0: none
  bool bounded = false;
};

/// One output, made by `build`.
inline dsl::Predicate predicate_of_scalars(const std::vector<Scalar>& scalars,
                                           const std::function<dsl::NodeId(dsl::Graph&)>& build) {
  dsl::Predicate p;
  p.name = "scalars";
  for (std::size_t i = 0; i < scalars.size(); ++i) {
    dsl::Parameter parameter;
    parameter.name = std::string(1, 'x') + std::to_string(i);
    parameter.bounded = scalars[i].bounded;
    if (scalars[i].range > 0) parameter.range = scalars[i].range;
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

/// x0 .. x5 in random sums, products, scalings, quotients by constants and by what is certainly not zero, extrema.
inline dsl::NodeId random_expression(dsl::Graph& g, std::mt19937_64& random, int operations, double range) {
  using dsl::Op;
  const auto pick = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  std::vector<dsl::NodeId> values;
  for (int i = 0; i < 6; ++i) values.push_back(g.input(i));
  const double constants[] = {3, 0.75, -5, 7, 0.1875, 6, -1};
  for (int i = 0; i < operations; ++i) {
    const auto operand = [&] { return values[static_cast<std::size_t>(pick(static_cast<int>(values.size())))]; };
    const dsl::NodeId a = operand();
    const dsl::NodeId b = operand();
    switch (pick(14)) {
      case 0:
      case 1:
      case 2:
        values.push_back(g.sub(a, b));
        break;
      case 3:
      case 4:
        values.push_back(g.add(a, b));
        break;
      case 5:
      case 6:
        values.push_back(g.mul(a, b));
        break;
      case 7:
        values.push_back(g.mul(a, g.constant(constants[pick(7)])));
        break;
      case 8:
        values.push_back(g.mul_pow2(a, pick(7) - 3));
        break;
      case 9:
        values.push_back(g.binary(Op::div, a, g.constant(constants[pick(3)])));
        break;
      case 10:
        values.push_back(g.binary(pick(2) != 0 ? Op::max : Op::min, a, b));
        break;
      case 11:
        values.push_back(g.abs(a));
        break;
      case 12:
        values.push_back(g.fma(a, b, operand()));
        break;
      default:
        values.push_back(g.binary(Op::div, a, g.add(g.input(pick(6)), g.constant(range * 3))));
        break;
    }
  }
  return values.back();
}

/// What a campaign of samples found.
struct Tally {
  int checked = 0;
  int definite = 0;
  int violations = 0;
  int wrong_signs = 0;
  double greatest_ratio = 0;  ///< of error to bound
};

/// Inputs: ends of the range, few bits, all bits, neighbours of an earlier input, tiny; within the range if there is
/// one.
template <class Real>
Real random_input(std::mt19937_64& random, double scale, Real earlier) {
  const double uniform = std::ldexp(static_cast<double>(random() >> 11), -52) - 1;
  Real x = 0;
  switch (random() % 6) {
    case 0:
      x = static_cast<Real>(random() % 2 ? scale : -scale);
      break;
    case 1:
      x = static_cast<Real>(scale * (static_cast<double>(random() % 17) - 8) / 8);
      break;
    case 2:
      x = std::nextafter(earlier, static_cast<Real>(uniform));
      break;
    case 3:
      x = static_cast<Real>(std::ldexp(uniform * scale, -static_cast<int>(random() % 40)));
      break;
    default:
      x = static_cast<Real>(uniform * scale);
  }
  while (std::abs(static_cast<double>(x)) > scale) x = std::nextafter(x, Real(0));
  return x;
}

/// Checks one predicate of scalars on random inputs of magnitude up to `scale`.
template <class Real>
void check_samples(const dsl::Predicate& p, const BoundedPredicate& bounded, double scale, int samples,
                   std::mt19937_64& random, Tally& tally) {
  const std::size_t n = p.slots.size();
  for (int sample = 0; sample < samples; ++sample) {
    std::vector<Real> slots(2 * n, Real(0));
    std::vector<DyadicRatio> exact;
    for (std::size_t i = 0; i < n; ++i) {
      slots[i] = random_input<Real>(random, scale, i > 0 ? slots[i - 1] : Real(0));
      exact.emplace_back(static_cast<double>(slots[i]));
      if (!p.parameters[i].bounded) continue;
      slots[n + i] = std::abs(random_input<Real>(random, scale, Real(0)));
      if (random() % 2 != 0) slots[n + i] *= static_cast<Real>(0x1p-20);
      const DyadicRatio offset(static_cast<double>(slots[n + i]));
      exact.back() = random() % 2 != 0 ? exact.back() + offset : exact.back() - offset;
    }
    const auto computed = dsl::evaluate<Real>(bounded.graph, slots);
    const auto truth =
        dsl::evaluate<DyadicRatio>(p.graph, exact)[static_cast<std::size_t>(p.stages[0].outputs[0].nodes[0])];
    const BoundedNode node = bounded.stages[0].outputs[0].elements[0];
    const auto value = static_cast<double>(computed[static_cast<std::size_t>(node.value)]);
    const auto bound = static_cast<double>(computed[static_cast<std::size_t>(node.bound)]);
    ++tally.checked;
    const int sign = value > bound ? 1 : value < -bound ? -1 : 0;
    if (sign != 0) ++tally.definite;
    if (sign != 0 && sign != truth.sign()) ++tally.wrong_signs;
    if (!std::isfinite(value) || !std::isfinite(bound)) continue;
    const DyadicRatio error = abs(DyadicRatio(value) - truth);
    if (error > DyadicRatio(bound)) ++tally.violations;
    if (bound > 0) tally.greatest_ratio = std::max(tally.greatest_ratio, (error / DyadicRatio(bound)).to_double());
  }
}

template <class Real>
constexpr Precision precision_of = std::is_same_v<Real, double> ? Precision::binary64 : Precision::binary32;

/// Random predicates with six inputs of one range, which changes from predicate to predicate between 2^low and 2^high.
template <class Real>
Tally campaign(BoundMode mode, int predicates, int samples, int operations, int low, int high, bool bounded_inputs) {
  std::mt19937_64 random(20150804);
  Tally tally;
  for (int i = 0; i < predicates; ++i) {
    const double range = std::ldexp(1.0, low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1)));
    std::vector<Scalar> scalars(6, {range, false});
    if (bounded_inputs) scalars[1].bounded = scalars[4].bounded = true;
    const dsl::Predicate p = predicate_of_scalars(scalars, [&](dsl::Graph& g) {
      return random_expression(g, random, operations, bounded_inputs ? 2 * range : range);
    });
    dsl::Diagnostics diagnostics;
    const BoundedPredicate b = codegen::add_bounds(p, mode, precision_of<Real>, diagnostics);
    if (diagnostics.has_errors()) continue;  // overflow, a constant that float does not hold
    check_samples<Real>(p, b, range, samples, random, tally);
  }
  return tally;
}

/// Violations where one term is left out of the bound of one expression over x0, x1, ...
inline int weakened_violations(BoundMode mode, Weakening weakening, const std::vector<Scalar>& scalars, double scale,
                               const std::function<dsl::NodeId(dsl::Graph&)>& build) {
  std::mt19937_64 random(7);
  const dsl::Predicate p = predicate_of_scalars(scalars, build);
  dsl::Diagnostics diagnostics;
  Tally tally;
  check_samples<double>(p, codegen::add_bounds(p, mode, Precision::binary64, diagnostics, weakening), scale, 4000,
                        random, tally);
  EXPECT_FALSE(diagnostics.has_errors());
  return tally.violations;
}

}  // namespace tightrope::testing_support
