#include "codegen/explore/accuracy.h"

#include <algorithm>
#include <cmath>

#include "codegen/explore/float_first.h"
#include "dsl/evaluate.h"

namespace tightrope::codegen::explore {
namespace {

template <class Real>
std::vector<Computed> computed(const dsl::Predicate& predicate, const BoundedPredicate& bounded,
                               const std::vector<Real>& slots, std::size_t last_stage) {
  const auto values = dsl::evaluate<Real>(bounded.graph, slots);
  std::vector<Computed> result;
  for (const Place& place : places(predicate, last_stage)) {
    const BoundedNode& node = bounded.stages[place.stage].outputs[place.output].elements[place.element];
    const auto at = [&](dsl::NodeId id) { return static_cast<double>(values[static_cast<std::size_t>(id)]); };
    result.push_back({at(node.value), node.bound == dsl::no_node ? 0 : at(node.bound)});
  }
  return result;
}

/// Inputs, then their bounds.
std::vector<float> filter_slots(const FloatFilter& filter, const Row& row) {
  std::vector<float> slots(2 * row.size(), 0.0F);
  for (std::size_t i = 0; i < row.size(); ++i) {
    const RoundedInput x = rounded_input(row[i]);
    slots[i] = x.value;
    const auto parameter = static_cast<std::size_t>(filter.predicate.slots[i].parameter);
    if (filter.predicate.parameters[parameter].bounded) slots[row.size() + i] = x.bound;
  }
  return slots;
}

bool decided(const Computed& x) { return std::abs(x.value) > x.bound; }

/// The filter's results where it decides all signs of a stage, else those of double.
std::vector<Computed> filtered(const Candidate& candidate, const std::vector<Computed>& in_double, const Row& row,
                               std::size_t last_stage) {
  const FloatFilter& filter = *candidate.filter;
  std::vector<Computed> result =
      computed<float>(filter.predicate, filter.bounded, filter_slots(filter, row), last_stage);
  const std::vector<Place> all = places(filter.predicate, last_stage);
  std::vector<bool> open(last_stage + 1, false);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool sign = filter.predicate.stages[all[i].stage].outputs[all[i].output].sign;
    if (sign && !decided(result[i])) open[all[i].stage] = true;
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (open[all[i].stage]) result[i] = in_double[i];
  }
  return result;
}

double quantile(std::vector<double>& values, double q) {
  if (values.empty()) return 0;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace

std::vector<Computed> compute(const Candidate& candidate, const Row& row, std::size_t last_stage) {
  if (candidate.precision == Precision::binary32) {
    std::vector<float> slots(2 * row.size(), 0.0F);
    std::transform(row.begin(), row.end(), slots.begin(), [](double x) { return static_cast<float>(x); });
    return computed<float>(candidate.predicate, candidate.bounded, slots, last_stage);
  }
  std::vector<double> slots(row);
  slots.resize(2 * row.size(), 0.0);
  const auto in_double = computed<double>(candidate.predicate, candidate.bounded, slots, last_stage);
  return candidate.filter ? filtered(candidate, in_double, row, last_stage) : in_double;
}

std::vector<std::vector<Computed>> compute_all(const Candidate& reference, const std::vector<Row>& rows,
                                               std::size_t last_stage) {
  std::vector<std::vector<Computed>> result;
  for (const Row& row : rows) result.push_back(compute(reference, row, last_stage));
  return result;
}

Accuracy measure_accuracy(const Candidate& candidate, const std::vector<std::vector<Computed>>& reference,
                          const Samples& samples, std::size_t last_stage) {
  Accuracy accuracy;
  const bool bounded = candidate.scheme.bound != BoundMode::none;
  std::vector<double> ratios;
  std::vector<double> sizes;
  Candidate without_filter = candidate;
  without_filter.filter.reset();
  for (std::size_t r = 0; r < samples.rows.size(); ++r) {
    const std::vector<Computed> own = compute(candidate, samples.rows[r], last_stage);
    const std::vector<Computed> finest = candidate.filter ? compute(without_filter, samples.rows[r], last_stage) : own;
    for (std::size_t i = 0; i < own.size(); ++i) {
      const Enclosure& exact = samples.exact[r][i];
      const auto& [value, bound] = own[i];
      if (bounded && exact.is_undefined() && decided(own[i])) accuracy.sound = false;
      if (!exact.is_number()) continue;
      if (reference[r][i].bound > 0) {
        const double size = finest[i].bound / reference[r][i].bound;
        sizes.push_back(std::isfinite(finest[i].value) && !std::isnan(size) ? size : INFINITY);
      }
      if (!std::isfinite(value) || !std::isfinite(bound)) continue;
      const DyadicRatio error = abs(Enclosure(value) - exact).lower();
      if (bounded && error > DyadicRatio(bound)) accuracy.sound = false;
      if (error.sign() != 0) ratios.push_back(bound / error.to_double());
    }
  }
  int undecided = 0;
  int wrong = 0;
  for (const NearZero& near : samples.near_zero) {
    const Computed x = compute(candidate, near.row, last_stage)[near.place];
    if (!decided(x)) ++undecided;
    if (decided(x) && (x.value > 0 ? 1 : -1) != near.sign) ++wrong;
  }
  if (bounded && wrong > 0) accuracy.sound = false;
  const double total = std::max<double>(1, static_cast<double>(samples.near_zero.size()));
  accuracy.size = sizes.empty() ? 1 : quantile(sizes, 0.5);  // no bounds but zeros: as good as the reference
  accuracy.median_ratio = quantile(ratios, 0.5);
  accuracy.p99_ratio = quantile(ratios, 0.99);
  accuracy.undecided = undecided / total;
  accuracy.wrong = wrong / total;
  return accuracy;
}

}  // namespace tightrope::codegen::explore
