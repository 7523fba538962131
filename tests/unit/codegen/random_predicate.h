#pragma once
/// Random predicates and inputs, and their bounds held against exact arithmetic.

#include <gtest/gtest.h>
#include <tightrope/enclosure.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "codegen/bounds.h"
#include "codegen/simplify.h"
#include "dsl/evaluate.h"

namespace tightrope::codegen::testing_support {

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
  bool quotients = false;        ///< also quotients by run-time values, roots and fused products
  bool selections = false;       ///< also selections, by the sign of the difference of two exact inputs
};

/// A predicate over six scalars with a random graph; the last few nodes are outputs.
inline dsl::Predicate random_predicate(std::mt19937_64& random, const Shape& shape) {
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
    const int kinds = shape.quotients ? 21 : shape.polynomial_only ? 10 : 13;
    const int kind = pick(kinds + (shape.selections ? 3 : 0));
    if (kind >= kinds) {  // inputs 0, 2, 4 are exact unless all are bounded; their difference has its exact sign
      if (shape.inputs == Inputs::bounded) continue;
      const NodeId condition = p.graph.sub(p.graph.input(2 * pick(3)), p.graph.input(2 * pick(3)));
      values.push_back(p.graph.select(condition, a, b));
      continue;
    }
    switch (kind) {
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
      case 13:
      case 14:
      case 15:
        made = p.graph.binary(Op::div, a, b);
        break;
      case 16:
        made = p.graph.unary(Op::sqrt, a);
        break;
      case 17:
        made = p.graph.unary(Op::sqrt, p.graph.add(p.graph.mul(a, a), p.graph.mul(b, b)));
        break;
      case 18:
        made = p.graph.unary(Op::sqrt, p.graph.abs(a));
        break;
      case 19:
      case 20:
        made = p.graph.fma(a, b, operand());
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

/// Whether a computed sign is certainly not that of the exact number; of no number every sign is wrong.
inline bool wrong_sign(int sign, const Enclosure& exact) {
  if (sign == 0 || (!exact.is_number() && !exact.is_undefined())) return false;
  return exact.is_undefined() || (exact.is_exact() ? sign != exact.sign() : sign == -exact.sign());
}

/// Whether `value` is certainly farther than `bound` from the exact number.
inline bool violates(double value, double bound, const Enclosure& exact) {
  const DyadicRatio v(value);
  const DyadicRatio r(bound);
  return exact.is_number() && (exact.lower() > v + r || exact.upper() < v - r);
}

/// `Exact`: DyadicRatio, or Enclosure where there are roots and divisors that may be 0.
template <class Exact, class Real>
void check_sample(const dsl::Predicate& p, const BoundedPredicate& bounded, const Sample<Real>& sample, Tally& tally) {
  const auto computed = dsl::evaluate<Real>(bounded.graph, sample.slots);
  const std::vector<Exact> slots(sample.exact.begin(), sample.exact.end());
  const auto exact = dsl::evaluate<Exact>(p.graph, slots);
  for (std::size_t o = 0; o < p.stages[0].outputs.size(); ++o) {
    const BoundedNode node = bounded.stages[0].outputs[o].elements[0];
    const double value = static_cast<double>(computed[static_cast<std::size_t>(node.value)]);
    const double bound = static_cast<double>(computed[static_cast<std::size_t>(node.bound)]);
    const Enclosure truth = exact[static_cast<std::size_t>(p.stages[0].outputs[o].nodes[0])];
    ++tally.checked;
    const int sign = value > bound ? 1 : value < -bound ? -1 : 0;
    if (sign != 0) ++tally.definite;
    if (wrong_sign(sign, truth)) ++tally.wrong_signs;
    if (!std::isfinite(value) || !std::isfinite(bound)) continue;
    if (bound < 0 || violates(value, bound, truth)) ++tally.violations;
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
    if (diagnostics.has_errors()) {
      ADD_FAILURE() << diagnostics.entries().front().message << "\n" << print(simplify(p).graph);
      continue;
    }
    for (int j = 0; j < samples; ++j) {
      const double scale = random_scale<Real>(random, shape.ranges == Ranges::all);
      const Sample<Real> sample = random_sample<Real>(random, p, scale, shape.uneven_scales);
      if (shape.quotients) {
        check_sample<Enclosure>(p, bounded, sample, tally);
      } else {
        check_sample<DyadicRatio>(p, bounded, sample, tally);
      }
    }
  }
  return tally;
}

}  // namespace tightrope::codegen::testing_support
