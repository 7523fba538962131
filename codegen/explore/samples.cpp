#include "codegen/explore/samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <sstream>

#include "dsl/evaluate.h"

namespace tightrope::codegen::explore {
namespace {

/// Operations that are evaluated exactly (about a microsecond each), and the samples that makes.
constexpr int operation_budget = 100'000;
constexpr int fewest_samples = 100;
constexpr int most_samples = 2'000;
constexpr int bisections = 60;

int digits(Precision precision) { return precision == Precision::binary64 ? 53 : 24; }

/// The nearest number of the type.
double in_type(double x, Precision precision) {
  return precision == Precision::binary64 ? x : static_cast<double>(static_cast<float>(x));
}

/// Uniform in [-1, 1], every bit random.
double uniform(std::mt19937_64& random, Precision precision) {
  const std::uint64_t bits = random();
  const double x = in_type(std::ldexp(static_cast<double>(bits >> 11), -53), precision);
  return (bits & 1) != 0 ? x : -x;
}

Row random_row(const dsl::Predicate& predicate, Precision precision, bool close, std::mt19937_64& random) {
  const double largest = precision == Precision::binary64 ? std::numeric_limits<double>::max()
                                                          : static_cast<double>(std::numeric_limits<float>::max());
  double centre[3];
  for (double& c : centre) c = uniform(random, precision);
  Row row;
  for (const dsl::Slot& slot : predicate.slots) {
    const dsl::Parameter& parameter = predicate.parameters[static_cast<std::size_t>(slot.parameter)];
    double x = uniform(random, precision);
    if (close && parameter.point) x = centre[slot.component] + std::ldexp(x, -10);
    const double range = parameter.range.value_or(1);
    x = in_type(x * std::min(range, largest / 4), precision);
    while (parameter.range && std::abs(x) > range) x /= 2;
    row.push_back(x);
  }
  return row;
}

/// Inputs, then the bounds of bounded ones, which come without error.
template <class Number>
std::vector<Number> slots_of(const Row& row) {
  std::vector<Number> slots;
  for (const double x : row) slots.push_back(Number(x));
  slots.resize(2 * row.size(), Number(0.0));
  return slots;
}

dsl::NodeId node_at(const dsl::Predicate& predicate, const Place& place) {
  return predicate.stages[place.stage].outputs[place.output].nodes[place.element];
}

/// The row at t of the way between two.
Row between(const Row& a, const Row& b, double t, Precision precision) {
  Row row;
  for (std::size_t i = 0; i < a.size(); ++i) row.push_back(in_type((1 - t) * a[i] + t * b[i], precision));
  return row;
}

class ZeroSearch {
 public:
  ZeroSearch(const dsl::Predicate& predicate, Precision precision) : predicate_(predicate), precision_(precision) {}

  /// Where the value of `node` changes its sign on the way from `a` to `b`, if it has opposite signs there.
  std::optional<double> crossing(const Row& a, const Row& b, dsl::NodeId node) const {
    const double at_a = value(a, node);
    if (!(at_a * value(b, node) < 0)) return std::nullopt;
    double low = 0;
    double high = 1;
    for (int i = 0; i < bisections && high - low > 0x1p-53; ++i) {
      const double middle = (low + high) / 2;
      (value(between(a, b, middle, precision_), node) * at_a > 0 ? low : high) = middle;
    }
    return (low + high) / 2;
  }

 private:
  double value(const Row& row, dsl::NodeId node) const {
    return dsl::evaluate<double>(predicate_.graph, slots_of<double>(row))[static_cast<std::size_t>(node)];
  }
  const dsl::Predicate& predicate_;
  Precision precision_;
};

/// A row near a zero of `place`, between two rows; tries a few pairs.
std::optional<Row> row_near_zero(const dsl::Predicate& predicate, const std::vector<Row>& rows, const Place& place,
                                 Precision precision, std::mt19937_64& random) {
  constexpr int tries = 8;
  const ZeroSearch search(predicate, precision);
  const auto pick = [&]() -> const Row& { return rows[static_cast<std::size_t>(random() % rows.size())]; };
  for (int i = 0; i < tries; ++i) {
    const Row& a = pick();
    const Row& b = pick();
    const auto crossing = search.crossing(a, b, node_at(predicate, place));
    if (!crossing) continue;
    const int least = digits(precision) * 3 / 5;
    const int j = least + static_cast<int>(random() % static_cast<unsigned>(digits(precision) - least + 1));
    const double off = std::ldexp(random() % 2 == 0 ? 1.0 : -1.0, -j);
    return between(a, b, std::clamp(*crossing + off, 0.0, 1.0), precision);
  }
  return std::nullopt;
}

/// The exact inputs as generated code has them: groups that are normalized (codegen/normalize.h) times their powers of
/// two.
std::vector<Enclosure> exact_inputs(const dsl::Predicate& predicate, const Row& row, Precision precision) {
  std::vector<Enclosure> slots = slots_of<Enclosure>(row);
  std::map<int, double> largest;
  const auto group = [&](std::size_t i) {
    return predicate.parameters[static_cast<std::size_t>(predicate.slots[i].parameter)].normalized;
  };
  for (std::size_t i = 0; i < row.size(); ++i) largest[group(i)] = std::max(largest[group(i)], std::abs(row[i]));
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (group(i) < 0) continue;
    const double most = largest[group(i)];
    const double scale = precision == Precision::binary64
                             ? dsl::normalizer_of(most)
                             : static_cast<double>(dsl::normalizer_of(static_cast<float>(most)));
    slots[i] = slots[i] * Enclosure(scale);
  }
  return slots;
}

std::vector<Enclosure> exact_values(const dsl::Predicate& predicate, const Row& row, Precision precision) {
  return dsl::evaluate<Enclosure>(predicate.graph, exact_inputs(predicate, row, precision));
}

}  // namespace

std::vector<Place> places(const dsl::Predicate& predicate, std::size_t last_stage) {
  std::vector<Place> result;
  for (std::size_t s = 0; s <= last_stage; ++s) {
    for (std::size_t o = 0; o < predicate.stages[s].outputs.size(); ++o) {
      for (std::size_t e = 0; e < predicate.stages[s].outputs[o].nodes.size(); ++e) result.push_back({s, o, e});
    }
  }
  return result;
}

std::vector<Row> random_rows(const dsl::Predicate& predicate, Precision inputs, int count) {
  std::mt19937_64 random(2015);
  std::vector<Row> rows;
  for (int i = 0; i < count; ++i) rows.push_back(random_row(predicate, inputs, i % 2 == 1, random));
  return rows;
}

std::string read_rows(const std::string& file, const dsl::Predicate& predicate, Precision inputs,
                      std::vector<Row>& rows) {
  std::ifstream stream(file);
  if (!stream) return fmt::format("cannot read {}", file);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line.front() == '#') continue;
    std::stringstream cells(line);
    std::string cell;
    Row row;
    while (std::getline(cells, cell, ',')) {
      char* end = nullptr;
      const double x = in_type(std::strtod(cell.c_str(), &end), inputs);
      const bool blank_behind =
          cell.find_first_not_of(" \t", static_cast<std::size_t>(end - cell.c_str())) == std::string::npos;
      if (end == cell.c_str() || !blank_behind || !std::isfinite(x)) {
        return fmt::format("{}:{}: '{}' is no finite number", file, number, cell);
      }
      row.push_back(x);
    }
    if (row.size() != predicate.slots.size()) {
      return fmt::format("{}:{}: {} numbers, but `{}` takes {}", file, number, row.size(), predicate.name,
                         predicate.slots.size());
    }
    rows.push_back(std::move(row));
  }
  return rows.empty() ? fmt::format("{} has no inputs", file) : "";
}

Samples samples(const dsl::Predicate& predicate, std::vector<Row> rows, Precision inputs, std::size_t last_stage) {
  const std::vector<Place> all = places(predicate, last_stage);
  const int count = std::clamp(operation_budget / std::max(1, predicate.graph.size()), fewest_samples, most_samples);
  Samples result;
  std::mt19937_64 random(1971);
  for (int i = 0; i < count; ++i) {
    const std::size_t place = static_cast<std::size_t>(i) % all.size();
    if (!predicate.stages[all[place].stage].outputs[all[place].output].sign) continue;
    const auto row = row_near_zero(predicate, rows, all[place], inputs, random);
    if (!row) continue;
    const Enclosure exact =
        exact_values(predicate, *row, inputs)[static_cast<std::size_t>(node_at(predicate, all[place]))];
    if (exact.is_exact()) result.near_zero.push_back({*row, place, exact.sign()});
  }
  if (rows.size() > static_cast<std::size_t>(count)) rows.resize(static_cast<std::size_t>(count));
  result.rows = std::move(rows);
  for (const Row& row : result.rows) {
    const std::vector<Enclosure> values = exact_values(predicate, row, inputs);
    std::vector<Enclosure>& of_row = result.exact.emplace_back();
    for (const Place& place : all) of_row.push_back(values[static_cast<std::size_t>(node_at(predicate, place))]);
  }
  return result;
}

}  // namespace tightrope::codegen::explore
