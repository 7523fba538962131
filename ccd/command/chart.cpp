#include "command/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "codegen/charts/pareto.h"

namespace tightrope::ccd {
namespace {

using charts::Datum;
using charts::Line;
using charts::Panel;
using charts::Series;
using charts::Style;

constexpr std::uint32_t front_colour = 0x909090;

/// "1,234,567"
std::string grouped(std::uint64_t number) {
  std::string digits = std::to_string(number);
  for (std::size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, ",");
  return digits;
}

/// "1 query", "2 queries"
std::string counted(std::uint64_t number, const char* one, const char* more) {
  return fmt::format("{} {}", grouped(number), number == 1 ? one : more);
}

std::size_t index_of(Method method) {
  const auto found =
      std::find_if(methods().begin(), methods().end(), [&](const MethodInfo& info) { return info.method == method; });
  return static_cast<std::size_t>(found - methods().begin());
}

Style style_of(const EvaluationRow& row) {
  Style style = charts::style_of(index_of(row.method));
  style.filled = row.precision == Precision::in_double;
  return style;
}

bool never_misses(const EvaluationRow& row) {
  return methods()[index_of(row.method)].conservative && row.mistakes->false_negatives == 0;
}

/// Of one kind and precision, the rows that no other one beats in time and false positives.
std::vector<const EvaluationRow*> front_of(std::span<const EvaluationRow* const> rows, Precision precision) {
  std::vector<const EvaluationRow*> candidates;
  std::vector<charts::Cost> costs;
  for (const EvaluationRow* row : rows) {
    if (row->precision != precision || !never_misses(*row)) continue;
    candidates.push_back(row);
    costs.push_back({row->ns_per_query, false_positive_rate(*row)});
  }
  std::vector<const EvaluationRow*> front;
  for (const std::size_t i : charts::pareto_front(costs)) front.push_back(candidates[i]);
  return front;
}

std::string front_name(Precision precision) { return fmt::format("Pareto front, {}", name(precision)); }

/// Stairs through the members of the front: above and to the right of them everything is beaten.
Series front_line(const std::vector<const EvaluationRow*>& front, Precision precision) {
  Series series{.name = front_name(precision),
                .style = {.colour = front_colour},
                .line = precision == Precision::in_double ? Line::solid : Line::dashed,
                .markers = false,
                .data = {}};
  for (const EvaluationRow* row : front) {
    if (!series.data.empty()) series.data.push_back({.x = row->ns_per_query, .y = series.data.back().y});
    series.data.push_back({.x = row->ns_per_query, .y = false_positive_rate(*row)});
  }
  return series;
}

std::string label_of(const EvaluationRow& row, bool several_precisions) {
  const std::string method(name(row.method));
  return several_precisions && row.precision == Precision::in_float ? method + " (float)" : method;
}

Series marker(const EvaluationRow& row, bool several_precisions, bool in_front) {
  const Mistakes& mistakes = *row.mistakes;
  const double rate = false_positive_rate(row);
  Datum datum{.x = row.ns_per_query, .y = rate, .label = label_of(row, several_precisions), .ring = in_front};
  if (mistakes.false_negatives > 0) datum.alarm = grouped(mistakes.false_negatives) + " missed";
  datum.facts = {{"ns per query", fmt::format("{:.1f}", row.ns_per_query)},
                 {"time / tight", fmt::format("{:.2f}", row.time_ratio_to_tight)},
                 {"queries", grouped(row.queries)},
                 {"in contact", grouped(mistakes.collisions)},
                 {"false positives", grouped(mistakes.false_positives)},
                 {"false-positive rate", rate > 0 ? fmt::format("{:.3g}", rate) : "0"},
                 {"false negatives", grouped(mistakes.false_negatives)},
                 {"uncertain signs", grouped(row.uncertain)},
                 {"Pareto front", in_front            ? "yes"
                                  : never_misses(row) ? "no"
                                                      : "no: may miss"}};
  return {.name = fmt::format("{}, {}", name(row.method), name(row.precision)),
          .style = style_of(row),
          .line = Line::none,
          .data = {datum}};
}

/// "vertex-face: 1,835 queries, 121 in contact (199 in float)"
std::string title_of(std::span<const EvaluationRow* const> rows) {
  const EvaluationRow& first = *rows.front();
  const EvaluationRow& last = *rows.back();  // of the last precision
  std::string title = fmt::format("{}: {}, {} in contact", name(first.kind), counted(first.queries, "query", "queries"),
                                  grouped(first.mistakes->collisions));
  if (last.mistakes->collisions != first.mistakes->collisions) {
    title += fmt::format(" ({} in {})", grouped(last.mistakes->collisions), name(last.precision));
  }
  return title;
}

Panel panel_of(std::span<const EvaluationRow* const> rows, std::span<const Precision> precisions) {
  Panel panel{.name = std::string(name(rows.front()->kind)), .title = title_of(rows), .series = {}};
  std::vector<const EvaluationRow*> members;
  for (const Precision precision : precisions) {
    const auto front = front_of(rows, precision);
    panel.series.push_back(front_line(front, precision));
    members.insert(members.end(), front.begin(), front.end());
  }
  for (const EvaluationRow* row : rows) {
    const bool in_front = std::find(members.begin(), members.end(), row) != members.end();
    panel.series.push_back(marker(*row, precisions.size() > 1, in_front));
  }
  return panel;
}

/// Whether some panel has a front in this precision: without conservative methods there is none.
bool has_front(const std::vector<Panel>& panels, Precision precision) {
  return std::any_of(panels.begin(), panels.end(), [&](const Panel& panel) {
    return std::any_of(panel.series.begin(), panel.series.end(), [&](const Series& series) {
      return series.name == front_name(precision) && !series.data.empty();
    });
  });
}

std::vector<charts::LegendEntry> legend_of(const std::vector<Panel>& panels, std::span<const Precision> precisions,
                                           bool missed) {
  std::vector<charts::LegendEntry> legend;
  for (const Precision precision : precisions) {
    const bool in_double = precision == Precision::in_double;
    const std::string type = precisions.size() > 1 || !in_double ? fmt::format(", {}", name(precision)) : "";
    if (!type.empty()) {
      std::vector<Style> examples = {charts::style_of(2), charts::style_of(0)};
      for (Style& style : examples) style.filled = in_double;
      legend.push_back({.text = fmt::format("computed in {}", name(precision)), .markers = examples});
    }
    if (!has_front(panels, precision)) continue;
    legend.push_back({.text = "Pareto front of the conservative methods" + type,
                      .style = {.colour = front_colour},
                      .line = in_double ? Line::solid : Line::dashed,
                      .ring = true});
  }
  if (missed) legend.push_back({.text = "missed contacts (false negatives)", .alarm = true});
  return legend;
}

std::string caption_of(bool missed) {
  std::string text =
      "Right is slower, up is more false alarms. Time: one thread, reading not included, the median of several passes. "
      "False-positive rate: queries answered true without contact, as a part of all queries without contact; in the "
      "band 0 there is none. Conservative methods promise never to miss a contact; no other one of them is both faster "
      "and more accurate than one with a ring. ";
  if (missed) {
    text += "A method with a red cross missed as many contacts as it says there, and is no candidate for the front. ";
  }
  return text;
}

}  // namespace

double false_positive_rate(const EvaluationRow& row) {
  const std::uint64_t without_contact = row.queries - row.mistakes->collisions;
  if (without_contact == 0) return 0;
  return static_cast<double>(row.mistakes->false_positives) / static_cast<double>(without_contact);
}

charts::Chart evaluation_chart(std::span<const EvaluationRow> rows, const std::string& source) {
  charts::Chart chart;
  std::vector<Precision> precisions;
  bool missed = false;
  std::uint64_t most = 1;
  for (const EvaluationRow& row : rows) {
    if (std::find(precisions.begin(), precisions.end(), row.precision) == precisions.end()) {
      precisions.push_back(row.precision);
    }
    missed = missed || row.mistakes->false_negatives > 0;
    most = std::max(most, row.queries);
  }
  std::uint64_t queries = 0;
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    std::vector<const EvaluationRow*> of_kind;
    for (const EvaluationRow& row : rows) {
      if (row.kind == kind) of_kind.push_back(&row);
    }
    if (of_kind.empty()) continue;
    queries += of_kind.front()->queries;
    chart.panels.push_back(panel_of(of_kind, precisions));
  }
  chart.title = fmt::format("Speed against accuracy: {}", counted(queries, "collision query", "collision queries"));
  chart.subtitle = source;
  chart.caption = caption_of(missed);
  chart.x = {.title = "time per query, nanoseconds"};
  chart.y = {.title = "false-positive rate", .zero_band = true, .least = 1 / static_cast<double>(most)};
  chart.legend = legend_of(chart.panels, precisions, missed);
  return chart;
}

}  // namespace tightrope::ccd
