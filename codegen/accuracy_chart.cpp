#include "codegen/accuracy_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include "codegen/certify.h"
#include "codegen/interface.h"
#include "codegen/measure.h"

namespace tightrope::codegen {
namespace {

using charts::Chart;
using charts::Line;
using charts::Panel;
using charts::Series;
using charts::Style;

constexpr std::size_t most_panels = 8;
constexpr int smallest_exponent = -8;  // the smallest inputs are 2^-8 of their range
constexpr int exponent_step = 1;

/// Operations that one measurement evaluates exactly (about a microsecond each), and the samples that makes.
constexpr int operation_budget = 150'000;
constexpr int fewest_samples = 100;
constexpr int most_samples = 1'000;

/// Gappa's bounds, by output: "vertex_face.inside.m_ab" and precision.
using GappaBounds = std::map<std::pair<std::string, Precision>, double>;

/// One output in one precision.
struct OutputPlace {
  std::size_t predicate = 0;
  std::size_t stage = 0;
  std::size_t output = 0;
};

Style style_of(BoundMode mode) {
  switch (mode) {
    case BoundMode::safe:
      return charts::style_of(1);
    case BoundMode::tight:
      return charts::style_of(2);
    case BoundMode::fixed:
      return charts::style_of(3);
    case BoundMode::interval:
      return charts::style_of(4);
    case BoundMode::none:
    case BoundMode::exact:
    case BoundMode::staged:
      break;
  }
  return charts::style_of(6);
}

const Style gappa_style = {.colour = 0xCC79A7, .shape = charts::Shape::pentagon, .filled = false};
const Style error_style = charts::style_of(6);

bool errors_come_in(const dsl::Predicate& predicate) {
  return std::any_of(predicate.parameters.begin(), predicate.parameters.end(),
                     [](const dsl::Parameter& p) { return p.bounded; });
}

/// A folder for Gappa's scripts, removed with them.
class ScriptFolder {
 public:
  ScriptFolder() {
    std::error_code error;
    std::string name = (std::filesystem::temp_directory_path(error) / "tightrope-gappa-XXXXXX").string();
    if (!error && ::mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~ScriptFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  ScriptFolder(const ScriptFolder&) = delete;
  ScriptFolder& operator=(const ScriptFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }  ///< empty: there is none

 private:
  std::filesystem::path path_;
};

/// What Gappa finds by itself for the whole ranges, the largest of each output's elements; nothing for an output one of
/// whose elements it gives no bound.
GappaBounds gappa_bounds(const dsl::Program& program, const AccuracyRequest& request) {
  const bool asked = std::find(request.modes.begin(), request.modes.end(), BoundMode::fixed) != request.modes.end();
  const ScriptFolder folder;
  if (!asked || request.gappa.empty() || folder.path().empty()) return {};
  dsl::Program of_interest = program;
  std::erase_if(of_interest.predicates, errors_come_in);
  CertifyRequest certificates;
  certificates.modes = {BoundMode::fixed};
  certificates.precisions = request.precisions;
  certificates.directory = folder.path();
  certificates.gappa = request.gappa;
  certificates.time_limit = request.gappa_time_limit;
  dsl::Diagnostics ignored;  // what `static` does not admit has been told, or left out
  std::vector<Certificate> found;
  if (!certify(of_interest, certificates, ignored, found).empty()) return {};
  GappaBounds bounds;
  for (const Certificate& c : found) {
    const bool told = c.verdict == Certificate::Verdict::proved || c.verdict == Certificate::Verdict::rules_only;
    double& bound = bounds[{c.output.substr(0, c.output.find('[')), c.precision}];
    bound = std::max(bound, told ? c.gappa_bound : HUGE_VAL);
  }
  std::erase_if(bounds, [](const auto& entry) { return !std::isfinite(entry.second); });
  return bounds;
}

std::string number(double value) { return fmt::format("{:.3g}", value); }

/// The measurements of one predicate in one precision, by mode and magnitude.
class PredicateAccuracy {
 public:
  PredicateAccuracy(const dsl::Predicate& predicate, std::size_t index, Precision precision,
                    const std::vector<BoundedProgram>& bounded)
      : predicate_(predicate), precision_(precision) {
    const int samples =
        std::clamp(operation_budget / std::max(1, predicate.graph.size()), fewest_samples, most_samples);
    for (const BoundedProgram& program : bounded) {
      if (program.precision != precision) continue;
      if (program.mode == BoundMode::fixed && errors_come_in(predicate)) continue;
      modes_.push_back(program.mode);
      measures_.emplace_back();
      for (int exponent = smallest_exponent; exponent <= 0; exponent += exponent_step) {
        measures_.back().push_back(measure(predicate, program.predicates[index], precision, Sampling::spread, samples,
                                           std::ldexp(1.0, exponent)));
      }
    }
  }

  /// Of the output, the greatest median of its bounds by the last mode but `static`, for inputs of the whole range.
  double badness(std::size_t stage, std::size_t output) const {
    double worst = 0;
    for (const auto& by_magnitude : measures_) {
      const OutputMeasure& m = by_magnitude.back()[stage].outputs[output];
      worst = std::max(worst, m.median_bound);
    }
    return worst;
  }

  Panel panel(std::size_t stage, std::size_t output, const GappaBounds& gappa, bool tell_precision) const {
    const dsl::Output& out = predicate_.stages[stage].outputs[output];
    const std::string key = fmt::format("{}.{}.{}", predicate_.name, predicate_.stages[stage].name, out.name);
    Panel panel{.name = fmt::format("{}.{}", predicate_.name, out.name),
                .title = fmt::format("{}, {}{}", predicate_.name, out.name, extents_text(out.extents)),
                .series = {}};
    if (out.degree > 0) panel.title += fmt::format(" (degree {} in t)", out.degree);
    if (tell_precision) {
      panel.name += fmt::format(", {}", name(precision_));
      panel.title += fmt::format(", {}", name(precision_));
    }
    if (measures_.empty()) return panel;
    for (std::size_t m = 0; m < modes_.size(); ++m) panel.series.push_back(bounds(m, stage, output));
    const auto found = gappa.find({key, precision_});
    if (found != gappa.end()) panel.series.push_back(gappa_series(found->second));
    panel.series.push_back(errors(stage, output));
    return panel;
  }

 private:
  static double part_of_range(std::size_t i) {
    return std::ldexp(1.0, smallest_exponent + exponent_step * static_cast<int>(i));
  }
  static std::string part_text(std::size_t i) {
    return fmt::format("2^{} of the range", smallest_exponent + exponent_step * static_cast<int>(i));
  }

  static Series gappa_series(double bound) {
    Series series{.name = "Gappa", .style = gappa_style, .line = Line::dashed, .data = {}};
    for (const std::size_t i : {std::size_t{0}, std::size_t{-smallest_exponent / exponent_step}}) {
      series.data.push_back({.x = part_of_range(i),
                             .y = bound,
                             .facts = {{"inputs up to", "the whole range"}, {"bound, median", number(bound)}}});
    }
    return series;
  }

  Series bounds(std::size_t mode, std::size_t stage, std::size_t output) const {
    Series series{.name = name(modes_[mode]), .style = style_of(modes_[mode]), .line = Line::solid, .data = {}};
    for (std::size_t i = 0; i < measures_[mode].size(); ++i) {
      const OutputMeasure& m = measures_[mode][i][stage].outputs[output];
      if (m.samples == m.not_finite) continue;
      series.data.push_back({.x = part_of_range(i),
                             .y = m.median_bound,
                             .facts = {{"inputs up to", part_text(i)},
                                       {"bound, median", number(m.median_bound)},
                                       {"bound / error, median", number(m.median_ratio)},
                                       {"bound / error, least", number(m.least_ratio)},
                                       {"definite signs", fmt::format("{:.4g} %", 100 * m.definite)}}});
    }
    return series;
  }

  /// True errors do not depend on the mode: those of the first.
  Series errors(std::size_t stage, std::size_t output) const {
    Series series{.name = "true error", .style = error_style, .line = Line::dotted, .data = {}};
    for (std::size_t i = 0; i < measures_.front().size(); ++i) {
      const OutputMeasure& m = measures_.front()[i][stage].outputs[output];
      if (m.samples == m.not_finite) continue;
      series.data.push_back({.x = part_of_range(i),
                             .y = m.median_error,
                             .facts = {{"inputs up to", part_text(i)},
                                       {"error, median", number(m.median_error)},
                                       {"error, greatest", number(m.greatest_error)}}});
    }
    return series;
  }

  const dsl::Predicate& predicate_;
  Precision precision_;
  std::vector<BoundMode> modes_;
  std::vector<std::vector<std::vector<StageMeasure>>> measures_;  ///< by mode, by magnitude, by stage
};

std::vector<OutputPlace> all_outputs(const dsl::Program& program) {
  std::vector<OutputPlace> places;
  for (std::size_t p = 0; p < program.predicates.size(); ++p) {
    const auto& stages = program.predicates[p].stages;
    for (std::size_t s = 0; s < stages.size(); ++s) {
      for (std::size_t o = 0; o < stages[s].outputs.size(); ++o) places.push_back({p, s, o});
    }
  }
  return places;
}

/// Of each predicate the output with the greatest bound.
std::vector<OutputPlace> worst_outputs(const std::vector<OutputPlace>& all,
                                       const std::vector<PredicateAccuracy>& accuracies) {
  std::vector<OutputPlace> worst;
  for (const OutputPlace& place : all) {
    const auto badness = [&](const OutputPlace& p) { return accuracies[p.predicate].badness(p.stage, p.output); };
    if (worst.empty() || worst.back().predicate != place.predicate) {
      worst.push_back(place);
    } else if (badness(place) > badness(worst.back())) {
      worst.back() = place;
    }
  }
  return worst;
}

std::vector<charts::LegendEntry> legend_of(const Chart& chart) {
  std::vector<charts::LegendEntry> legend;
  for (const Panel& panel : chart.panels) {
    for (const Series& series : panel.series) {
      const bool there =
          std::any_of(legend.begin(), legend.end(), [&](const auto& e) { return e.text == series.name; });
      if (there) continue;
      legend.push_back({.text = series.name, .markers = {series.style}, .style = series.style, .line = series.line});
    }
  }
  return legend;
}

std::string caption_of(const Chart& chart, const AccuracyRequest& request, bool all) {
  std::string text = "How far the bounds are from the errors that they bound. Inputs are uniform in a part of their ";
  text += request.ranges_assumed ? fmt::format("ranges (where none is declared, {:g} at most); ", request.assumed_range)
                                 : "declared ranges; ";
  text += "bounds and errors are medians over them, the errors by exact arithmetic. ";
  const std::pair<const char*, const char*> sentences[] = {
      {"safe", "safe depends on the largest inputs of a run. "},
      {"tight", "tight depends on every value. "},
      {"interval", "interval, too. "},
      {"static", "static is one constant for the whole ranges. "},
      {"Gappa", "Gappa: what it finds by itself for the whole ranges. "},
  };
  for (const auto& sentence : sentences) {
    const bool there = std::any_of(chart.legend.begin(), chart.legend.end(),
                                   [&](const charts::LegendEntry& entry) { return entry.text == sentence.first; });
    if (there) text += sentence.second;
  }
  if (!all) text += "Of each predicate the output with the greatest bound. ";
  return text;
}

}  // namespace

Chart accuracy_chart(const dsl::Program& program, const AccuracyRequest& request, dsl::Diagnostics& diagnostics) {
  Chart chart;
  const auto bounded = bounded_programs(program, request.modes, request.precisions, diagnostics);
  if (diagnostics.has_errors()) return chart;
  const GappaBounds gappa = gappa_bounds(program, request);
  bool all = true;
  for (const Precision precision : request.precisions) {
    std::vector<PredicateAccuracy> accuracies;
    for (std::size_t p = 0; p < program.predicates.size(); ++p) {
      accuracies.emplace_back(program.predicates[p], p, precision, bounded);
    }
    std::vector<OutputPlace> places = all_outputs(program);
    all = places.size() <= most_panels;
    if (!all) places = worst_outputs(places, accuracies);
    for (const OutputPlace& place : places) {
      chart.panels.push_back(
          accuracies[place.predicate].panel(place.stage, place.output, gappa, request.precisions.size() > 1));
    }
  }
  chart.title = "Error bounds against true errors: " + request.source;
  chart.subtitle =
      request.precisions.size() == 1 ? fmt::format("Computed in {}.", name(request.precisions.front())) : "";
  chart.legend = legend_of(chart);
  chart.caption = caption_of(chart, request, all);
  chart.x = {.title = "largest input, as a part of its range"};
  chart.y = {.title = "bound, error", .shared = false};
  return chart;
}

}  // namespace tightrope::codegen
