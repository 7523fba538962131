#include "codegen/explore/chart.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace tightrope::codegen::explore {
namespace {

using charts::Datum;
using charts::Series;

constexpr std::uint32_t front_colour = 0x909090;
constexpr BoundMode bounds[] = {BoundMode::tight, BoundMode::safe, BoundMode::fixed, BoundMode::interval};

bool is_shown(const Exploration& exploration, const Entry& entry) {
  return !entry.dismissed && is_of_use(exploration, entry) && entry.accuracy.size > 0 && exploration.cost(entry) > 0;
}

Datum datum(const Exploration& exploration, const Entry& entry) {
  const std::size_t stage = exploration.stages.size() - 1;
  const Candidate& candidate = entry.candidate;
  const Accuracy& a = entry.accuracy;
  const bool is_default = candidate.scheme == Scheme{.bound = candidate.scheme.bound};
  Datum result{.x = exploration.cost(entry), .y = a.size, .ring = entry.on_front};
  if (entry.on_front || is_default || candidate.filter) result.label = candidate.name();
  if (!a.sound) result.alarm = "unsound";
  result.facts = {{"scheme", candidate.name()},
                  {"operations for values", std::to_string(candidate.values(stage).total())},
                  {"operations for bounds", std::to_string(candidate.bounds(stage).total())}};
  if (entry.time.median > 0) {
    result.facts.push_back({"ns a call", fmt::format("{:.1f} ({:.1f} .. {:.1f})", entry.time.median,
                                                     entry.time.lower_quartile, entry.time.upper_quartile)});
  }
  result.facts.push_back({"size of bound", fmt::format("{:.3g}", a.size)});
  result.facts.push_back({"bound / error, median", fmt::format("{:.3g}", a.median_ratio)});
  result.facts.push_back({"uncertain near zero", fmt::format("{:.1f} %", 100 * a.undecided)});
  return result;
}

/// Stairs through the members of the front, which stand by rising cost among the entries.
Series front_line(const Exploration& exploration) {
  Series series{
      .name = "Pareto front", .style = {.colour = front_colour}, .line = charts::Line::solid, .markers = false};
  for (const Entry& entry : exploration.entries) {
    if (!entry.on_front) continue;
    const double cost = exploration.cost(entry);
    if (!series.data.empty()) series.data.push_back({.x = cost, .y = series.data.back().y});
    series.data.push_back({.x = cost, .y = entry.accuracy.size});
  }
  return series;
}

std::string caption(const Exploration& exploration) {
  std::string text = exploration.timed
                         ? fmt::format(
                               "Right is slower, up are larger bounds. Time: processor time of one call, median "
                               "of the rounds, compiled with {}. ",
                               exploration.flags)
                         : "Right are more operations, up are larger bounds. ";
  text += fmt::format(
      "Bounds in units of those of {}: median over {} inputs. With a ring: no other scheme is cheaper and as tight. ",
      exploration.reference, exploration.rows);
  if (!exploration.timed) return text;
  for (const Entry& entry : exploration.entries) {
    if (entry.candidate.scheme == Scheme{.bound = BoundMode::none} && entry.time.median > 0) {
      text += fmt::format("Without any bound (float): {:.1f} ns.", entry.time.median);
    }
  }
  return text;
}

}  // namespace

charts::Chart exploration_chart(const Exploration& exploration) {
  charts::Chart chart;
  chart.title = fmt::format("Evaluation schemes of {}", exploration.predicate);
  chart.subtitle = fmt::format("stage{} {}, inputs of type {}", exploration.stages.size() > 1 ? "s" : "",
                               fmt::join(exploration.stages, ", "), name(exploration.inputs));
  chart.caption = caption(exploration);
  chart.x = {.title = exploration.timed ? "time of a call, nanoseconds" : "operations"};
  chart.y = {.title = "size of bound"};
  charts::Panel panel{.name = exploration.predicate, .title = "", .series = {front_line(exploration)}};
  chart.legend.push_back(
      {.text = "Pareto front", .style = {.colour = front_colour}, .line = charts::Line::solid, .ring = true});
  for (std::size_t b = 0; b < std::size(bounds); ++b) {
    Series series{.name = name(bounds[b]), .style = charts::style_of(b)};
    for (const Entry& entry : exploration.entries) {
      if (entry.candidate.scheme.bound == bounds[b] && is_shown(exploration, entry)) {
        series.data.push_back(datum(exploration, entry));
      }
    }
    if (series.data.empty()) continue;
    chart.legend.push_back({.text = series.name, .markers = {series.style}});
    panel.series.push_back(std::move(series));
  }
  chart.panels.push_back(std::move(panel));
  return chart;
}

}  // namespace tightrope::codegen::explore
