#include "codegen/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "codegen/count.h"
#include "codegen/interface.h"
#include "codegen/measure.h"
#include "codegen/precision.h"
#include "codegen/simplify.h"
#include "codegen/static_bound.h"

namespace tightrope::codegen {
namespace {

using Json = nlohmann::ordered_json;

/// Operations that one measurement evaluates exactly (about a microsecond each), and the samples that makes.
constexpr int operation_budget = 4'000'000;
constexpr int fewest_samples = 200;
constexpr int most_samples = 10'000;

/// One predicate in one mode and precision.
struct Entry {
  const dsl::Predicate& predicate;
  const BoundedPredicate& bounded;
  BoundMode mode;
  Precision precision;
  std::vector<Cost> costs;                          ///< by stage
  std::vector<std::vector<StageMeasure>> measures;  ///< by sampling, by stage; empty if not measured
};

Entry make_entry(const dsl::Predicate& predicate, const BoundedPredicate& bounded, const BoundedProgram& program,
                 const ReportOptions& options) {
  Entry entry{predicate, bounded, program.mode, program.precision, stage_costs(bounded, schedule(bounded)), {}};
  if (options.measure && program.mode != BoundMode::none) {
    const int samples =
        std::clamp(operation_budget / std::max(1, predicate.graph.size()), fewest_samples, most_samples);
    for (const Sampling sampling : samplings) {
      entry.measures.push_back(measure(predicate, bounded, program.precision, sampling, samples));
    }
  }
  return entry;
}

Json to_json(const OperationCount& count) {
  return {{"total", count.total()},           {"sums", count.sums},
          {"products", count.products},       {"divisions", count.divisions},
          {"comparisons", count.comparisons}, {"exact", count.exact}};
}

Json to_json(const OutputMeasure& m, Sampling sampling) {
  return {
      {"sampling", name(sampling)},
      {"samples", m.samples},
      {"not_finite", m.not_finite},
      {"without_error", m.without_error},
      {"definite", m.definite},
      {"sound", m.sound},
      {"least_margin", m.least_margin},
      {"bound_to_error",
       {{"median", m.median_ratio}, {"p99", m.p99_ratio}, {"least", m.least_ratio}, {"greatest", m.greatest_ratio}}},
      {"bound_to_published", {{"median", m.published_median}, {"greatest", m.published_greatest}}}};
}

Json to_json(const Entry& entry) {
  Json stages = Json::array();
  for (std::size_t s = 0; s < entry.predicate.stages.size(); ++s) {
    Json outputs = Json::array();
    for (std::size_t o = 0; o < entry.predicate.stages[s].outputs.size(); ++o) {
      const dsl::Output& output = entry.predicate.stages[s].outputs[o];
      const OutputBound& bound = entry.bounded.stages[s].outputs[o];
      const Cost cost = output_cost(entry.bounded, bound);
      Json json = {{"name", output.name},
                   {"kind", output.sign ? "sign" : "value"},
                   {"expression", output.text},
                   {"extents", output.extents},
                   {"degree", output.degree},
                   {"value_operations", to_json(cost.value)},
                   {"bound_operations", to_json(cost.bound)}};
      if (entry.mode == BoundMode::safe) {
        json["k"] = bound.roundings;
        json["B"] = bound.magnitude;
      }
      if (entry.mode == BoundMode::fixed) json["constant"] = bound.constant;
      if (!bound.assumption.empty()) json["assumption"] = bound.assumption;
      for (std::size_t m = 0; m < entry.measures.size(); ++m) {
        json["measured"].push_back(to_json(entry.measures[m][s].outputs[o], samplings[m]));
      }
      outputs.push_back(std::move(json));
    }
    stages.push_back({{"name", entry.predicate.stages[s].name},
                      {"value_operations", to_json(entry.costs[s].value)},
                      {"bound_operations", to_json(entry.costs[s].bound)},
                      {"outputs", std::move(outputs)}});
  }
  return {{"predicate", entry.predicate.name},
          {"bound", name(entry.mode)},
          {"real", name(entry.precision)},
          {"stages", std::move(stages)}};
}

std::string to_text(const OutputMeasure& m, Sampling sampling, Precision precision) {
  std::string text = fmt::format("      measured on {} samples, {}: {}, {:.4g} % of signs definite\n", m.samples,
                                 name(sampling), m.sound ? "sound" : "UNSOUND", 100 * m.definite);
  text += fmt::format(
      "        bound / error: median {:.3g}, p99 {:.3g}, least {:.3g}, greatest {:.3g} ({} without error)\n",
      m.median_ratio, m.p99_ratio, m.least_ratio, m.greatest_ratio, m.without_error);
  text += fmt::format("        least bound - error: {:.3g}\n", m.least_margin);
  text +=
      fmt::format("        bound / published TightBound: median {:.4f}, greatest {:.4f} (where that exceeds 2^-{})\n",
                  m.published_median, m.published_greatest, precision == Precision::binary64 ? 900 : 100);
  if (m.not_finite > 0) text += fmt::format("        {} samples not finite\n", m.not_finite);
  return text;
}

/// "0x1p-49 = 16 u"
std::string constant_text(const OutputBound& bound, Precision precision) {
  const double in_units = bound.constant / format(precision).unit_roundoff;
  return fmt::format("{} = {:.6g} u", literal(bound.constant, Precision::binary64), in_units);
}

std::string to_text(const Entry& entry) {
  std::string text = fmt::format("{}, bound {}, {}\n", entry.predicate.name, name(entry.mode), name(entry.precision));
  for (std::size_t s = 0; s < entry.predicate.stages.size(); ++s) {
    const dsl::Stage& stage = entry.predicate.stages[s];
    text += fmt::format("  stage {}\n    operations for values {}\n    operations for bounds {}\n", stage.name,
                        codegen::text(entry.costs[s].value), codegen::text(entry.costs[s].bound));
    for (std::size_t o = 0; o < stage.outputs.size(); ++o) {
      const dsl::Output& output = stage.outputs[o];
      const OutputBound& bound = entry.bounded.stages[s].outputs[o];
      const Cost cost = output_cost(entry.bounded, bound);
      text += fmt::format("    {} {}{}: degree {} in t, on its own {} operations for the value, {} for the bound\n",
                          output.sign ? "sign" : "value", output.name, extents_text(output.extents), output.degree,
                          cost.value.total(), cost.bound.total());
      if (entry.mode == BoundMode::safe)
        text += fmt::format("      k = {}, B = {}\n", bound.roundings, bound.magnitude);
      if (entry.mode == BoundMode::fixed)
        text += fmt::format("      bound {}\n", constant_text(bound, entry.precision));
      if (!bound.assumption.empty()) text += fmt::format("      {}\n", bound.assumption);
      for (std::size_t m = 0; m < entry.measures.size(); ++m) {
        text += to_text(entry.measures[m][s].outputs[o], samplings[m], entry.precision);
      }
    }
  }
  return text;
}

/// "16.7 / 892 / 1.2e+05": median, 99th percentile and greatest of bound / error. Where few signs are definite no ratio
/// says much.
std::string ratios(const OutputMeasure& m) {
  if (m.samples == m.not_finite + m.without_error) return "exact";
  return fmt::format("{:.3g} / {:.3g} / {:.2g}", m.median_ratio, m.p99_ratio, m.greatest_ratio);
}

struct Column {
  std::string title;
  Entry entry;
};

/// One predicate in one precision: every mode with bounds, and `static` as Gappa would have it, by its rules alone
/// (`certify` shows whether the two agree). A number as bound says nothing where errors of any size come in.
std::vector<Column> columns(const dsl::Predicate& predicate, std::size_t index, Precision precision,
                            const std::vector<BoundedProgram>& bounded, const ReportOptions& options,
                            BoundedPredicate& by_rules) {
  std::vector<Column> result;
  const bool errors_come_in = std::any_of(predicate.parameters.begin(), predicate.parameters.end(),
                                          [](const dsl::Parameter& p) { return p.bounded; });
  for (const BoundedProgram& combination : bounded) {
    if (combination.precision != precision || combination.mode == BoundMode::none) continue;
    const bool constant = combination.mode == BoundMode::fixed;
    if (constant && errors_come_in) continue;
    result.push_back(
        {name(combination.mode), make_entry(predicate, combination.predicates[index], combination, options)});
    if (!constant) continue;
    dsl::Diagnostics ignored;
    add_static_bounds(simplify(predicate), format(precision), ignored, Weakening::none, by_rules, StaticLemmas::none);
    result.push_back({"static, rules alone", make_entry(predicate, by_rules, combination, options)});
  }
  return result;
}

std::string to_table(const std::vector<Column>& entries) {
  const Entry& first = entries.front().entry;
  std::string text = fmt::format("| {}, {} |", first.predicate.name, name(first.precision));
  std::string rule = "\n|---|";
  for (const Column& column : entries) {
    text += fmt::format(" {} |", column.title);
    rule += "---|";
  }
  text += rule + "\n";
  for (std::size_t s = 0; s < first.predicate.stages.size(); ++s) {
    for (std::size_t o = 0; o < first.predicate.stages[s].outputs.size(); ++o) {
      text += fmt::format("| `{}` |", first.predicate.stages[s].outputs[o].name);
      for (const auto& [title, entry] : entries) {
        text += entry.measures.empty() ? " - |" : fmt::format(" {} |", ratios(entry.measures[0][s].outputs[o]));
      }
      text += "\n";
    }
  }
  return text;
}

}  // namespace

std::string report(const dsl::Program& program, const std::vector<BoundedProgram>& bounded,
                   const ReportOptions& options) {
  Json json = Json::array();
  std::string text;
  for (std::size_t i = 0; i < program.predicates.size(); ++i) {
    if (options.table) {
      for (const Precision precision : {Precision::binary64, Precision::binary32}) {
        BoundedPredicate by_rules;
        const std::vector<Column> entries = columns(program.predicates[i], i, precision, bounded, options, by_rules);
        if (!entries.empty()) text += (text.empty() ? "" : "\n") + to_table(entries);
      }
      continue;
    }
    for (const BoundedProgram& combination : bounded) {
      const Entry entry = make_entry(program.predicates[i], combination.predicates[i], combination, options);
      if (options.json) {
        json.push_back(to_json(entry));
      } else {
        if (!text.empty()) text += '\n';
        text += to_text(entry);
      }
    }
  }
  return options.json ? json.dump(2) + "\n" : text;
}

}  // namespace tightrope::codegen
