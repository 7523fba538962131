#include "codegen/measure.h"

#include <tightrope/enclosure.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <span>

#include "dsl/evaluate.h"

namespace tightrope::codegen {
namespace {

using dsl::Node;
using dsl::NodeId;
using dsl::Op;

/// What one sample says about one output element.
struct Sample {
  double ratio = 0;      ///< bound / |error|
  double margin = 0;     ///< bound - |error|
  double published = 0;  ///< bound / published bound, 0 where that is too small to compare
};

struct Collected {
  OutputMeasure measure;
  std::vector<double> ratios;
  std::vector<double> published;
  std::vector<double> bounds;
  std::vector<double> errors;
};

/// Uniform in [-1, 1], every bit random.
template <class Real>
Real uniform(std::mt19937_64& random) {
  constexpr int digits = std::numeric_limits<Real>::digits;
  const std::uint64_t bits = random();
  const auto mantissa = static_cast<Real>((bits >> (65 - digits)) | (std::uint64_t{1} << (digits - 1)));
  const Real x = std::ldexp(mantissa, -digits - std::countl_zero(random() | 1));
  return (bits & 1) != 0 ? x : -x;
}

/// Input slots, then the slots of their bounds (0: bounded inputs come without error).
template <class Real>
std::vector<Real> draw(const dsl::Predicate& predicate, Sampling sampling, double scale, std::mt19937_64& random) {
  const std::size_t n = predicate.slots.size();
  std::vector<Real> slots(2 * n, Real(0));
  const double largest = std::numeric_limits<Real>::max();
  Real centre[3];
  for (Real& c : centre) c = uniform<Real>(random);
  for (std::size_t i = 0; i < n; ++i) {
    const dsl::Parameter& parameter = predicate.parameters[static_cast<std::size_t>(predicate.slots[i].parameter)];
    Real x = uniform<Real>(random);
    if (sampling == Sampling::close && parameter.point) {
      x = centre[predicate.slots[i].component] + std::ldexp(x, -10);
    }
    if (parameter.range) x *= static_cast<Real>(std::min(*parameter.range, largest / 2));
    while (std::abs(static_cast<double>(x)) > parameter.range.value_or(std::numeric_limits<double>::infinity())) x /= 2;
    slots[i] = x * static_cast<Real>(scale);
  }
  return slots;
}

/// The bounds of all nodes of the value graph by the published TightBound rules [Wang et al. 2015, Theorem 1], with
/// epsilon, twice the unit roundoff, as published: R = Ra + Rb + epsilon |L| for sums, |La| Rb + |Lb| Ra + Ra Rb +
/// epsilon |L| for products, nothing for inputs and exact operations. Division by a constant, which the paper has not:
/// Ra / |c| + epsilon |L|.
template <class Real>
std::vector<Real> published_bounds(const dsl::Graph& graph, std::span<const Real> values, std::span<const Real> slots,
                                   std::size_t inputs) {
  const Real epsilon = std::numeric_limits<Real>::epsilon();
  std::vector<Real> r(static_cast<std::size_t>(graph.size()), Real(0));
  const auto at = [](const auto& v, NodeId id) { return std::abs(v[static_cast<std::size_t>(id)]); };
  for (NodeId id = 0; id < graph.size(); ++id) {
    const Node& node = graph[id];
    Real& result = r[static_cast<std::size_t>(id)];
    const Real rounding = epsilon * at(values, id);
    switch (node.op) {
      case Op::input:
        if (static_cast<std::size_t>(node.index) < inputs) {
          result = slots[inputs + static_cast<std::size_t>(node.index)];
        }
        break;
      case Op::constant:
        break;
      case Op::add:
      case Op::sub:
        result = at(r, node.a) + at(r, node.b) + rounding;
        break;
      case Op::mul:
        result = at(values, node.a) * at(r, node.b) + at(values, node.b) * at(r, node.a) +
                 at(r, node.a) * at(r, node.b) + rounding;
        break;
      case Op::div:
        result = at(r, node.a) / at(values, node.b) + rounding;
        break;
      case Op::mul_pow2:
        result = std::ldexp(at(r, node.a), node.index);
        break;
      case Op::neg:
      case Op::abs:
        result = at(r, node.a);
        break;
      case Op::min:
      case Op::max:
      case Op::max_magnitude:
        result = std::max(at(r, node.a), at(r, node.b));
        break;
      case Op::select:
        result = values[static_cast<std::size_t>(node.a)] >= 0 ? at(r, node.b) : at(r, node.c);
        break;
      case Op::certain_nonzero:
      case Op::certain_nonnegative:
      case Op::normalizer:
      case Op::sqrt:
      case Op::fma:
        result = std::numeric_limits<Real>::quiet_NaN();
        break;  // not among the published rules
    }
  }
  return r;
}

/// The exact inputs as generated code has them: normalized groups times their powers of two.
template <class Real>
void normalize(const dsl::Predicate& predicate, const std::vector<Real>& slots, std::vector<Enclosure>& exact) {
  std::map<int, Real> largest;
  const auto group = [&](std::size_t i) {
    return predicate.parameters[static_cast<std::size_t>(predicate.slots[i].parameter)].normalized;
  };
  for (std::size_t i = 0; i < predicate.slots.size(); ++i) {
    largest[group(i)] = std::max(largest[group(i)], std::abs(slots[i]));
  }
  for (std::size_t i = 0; i < predicate.slots.size(); ++i) {
    if (group(i) >= 0) exact[i] = exact[i] * Enclosure(static_cast<double>(dsl::normalizer_of(largest[group(i)])));
  }
}

double quantile(std::vector<double>& sorted, double q) {
  if (sorted.empty()) return 0;
  return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}

void add_sample(Collected& collected, double value, double bound, const Enclosure& exact, double published,
                double published_floor) {
  OutputMeasure& m = collected.measure;
  ++m.samples;
  if (exact.is_undefined() && std::abs(value) > bound) m.sound = false;
  if (!std::isfinite(value) || !std::isfinite(bound) || !exact.is_number()) {
    ++m.not_finite;
    return;
  }
  const DyadicRatio error = abs(Enclosure(value) - exact).lower();
  collected.bounds.push_back(bound);
  collected.errors.push_back(error.to_double());
  const DyadicRatio margin = DyadicRatio(bound) - error;
  if (margin.sign() < 0) m.sound = false;
  m.least_margin = m.samples - m.not_finite == 1 ? margin.to_double() : std::min(m.least_margin, margin.to_double());
  if (std::abs(value) > bound) m.definite += 1;
  if (error.sign() == 0) {
    ++m.without_error;
  } else {
    collected.ratios.push_back((DyadicRatio(bound) / error).to_double());
  }
  if (published > published_floor) collected.published.push_back(bound / published);
}

OutputMeasure finish(Collected& collected) {
  OutputMeasure m = collected.measure;
  std::sort(collected.ratios.begin(), collected.ratios.end());
  for (std::vector<double>* values : {&collected.published, &collected.bounds, &collected.errors}) {
    std::sort(values->begin(), values->end());
  }
  if (m.samples > 0) m.definite /= m.samples;
  m.median_ratio = quantile(collected.ratios, 0.5);
  m.p99_ratio = quantile(collected.ratios, 0.99);
  m.least_ratio = quantile(collected.ratios, 0);
  m.greatest_ratio = quantile(collected.ratios, 1);
  m.median_bound = quantile(collected.bounds, 0.5);
  m.median_error = quantile(collected.errors, 0.5);
  m.greatest_error = quantile(collected.errors, 1);
  m.published_median = quantile(collected.published, 0.5);
  m.published_greatest = quantile(collected.published, 1);
  return m;
}

template <class Real>
std::vector<StageMeasure> measure_real(const dsl::Predicate& predicate, const BoundedPredicate& bounded,
                                       Sampling sampling, int samples, double scale) {
  std::mt19937_64 random(2015);  // the year of the paper
  const double published_floor = std::ldexp(1.0, std::is_same_v<Real, double> ? -900 : -100);
  const std::size_t inputs = predicate.slots.size();
  std::vector<std::vector<Collected>> collected;
  for (const dsl::Stage& stage : predicate.stages) collected.emplace_back(stage.outputs.size());
  for (int n = 0; n < samples; ++n) {
    const std::vector<Real> slots = draw<Real>(predicate, sampling, scale, random);
    std::vector<Enclosure> exact_slots;
    for (const Real x : slots) exact_slots.emplace_back(static_cast<double>(x));
    normalize(predicate, slots, exact_slots);
    const auto exact = dsl::evaluate<Enclosure>(predicate.graph, exact_slots);
    const auto v = dsl::evaluate<Real>(bounded.graph, slots);
    const auto published = published_bounds<Real>(bounded.graph, v, slots, inputs);
    for (std::size_t s = 0; s < collected.size(); ++s) {
      for (std::size_t o = 0; o < collected[s].size(); ++o) {
        const std::vector<BoundedNode>& elements = bounded.stages[s].outputs[o].elements;
        for (std::size_t e = 0; e < elements.size(); ++e) {
          const auto value = static_cast<std::size_t>(elements[e].value);
          add_sample(collected[s][o], static_cast<double>(v[value]),
                     static_cast<double>(v[static_cast<std::size_t>(elements[e].bound)]),
                     exact[static_cast<std::size_t>(predicate.stages[s].outputs[o].nodes[e])],
                     static_cast<double>(published[value]), published_floor);
        }
      }
    }
  }
  std::vector<StageMeasure> result;
  for (auto& stage : collected) {
    result.emplace_back();
    for (Collected& output : stage) result.back().outputs.push_back(finish(output));
  }
  return result;
}

}  // namespace

const char* name(Sampling sampling) { return sampling == Sampling::spread ? "spread" : "close"; }

std::vector<StageMeasure> measure(const dsl::Predicate& predicate, const BoundedPredicate& bounded, Precision precision,
                                  Sampling sampling, int samples, double scale) {
  return precision == Precision::binary64 ? measure_real<double>(predicate, bounded, sampling, samples, scale)
                                          : measure_real<float>(predicate, bounded, sampling, samples, scale);
}

}  // namespace tightrope::codegen
