#include "command/report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tightrope::ccd {
namespace {

using Json = nlohmann::ordered_json;

double rounded(double value) { return std::round(value * 1000) / 1000; }

Json object(const EvaluationRow& row) {
  const auto count = [&](std::uint64_t Mistakes::*field) {
    return row.mistakes ? Json((*row.mistakes).*field) : Json();
  };
  return {{"method", name(row.method)},
          {"kind", name(row.kind)},
          {"real", name(row.precision)},
          {"device", name(row.execution.device)},
          {"threads", row.execution.threads},
          {"queries", row.queries},
          {"collisions", count(&Mistakes::collisions)},
          {"false_positives", count(&Mistakes::false_positives)},
          {"false_negatives", count(&Mistakes::false_negatives)},
          {"uncertain", row.uncertain},
          {"ns_per_query", rounded(row.ns_per_query)},
          {"time_ratio_to_tight", rounded(row.time_ratio_to_tight)},
          {"instructions", row.execution.device == Device::cpu ? Json(name(row.execution.instructions)) : Json()}};
}

/// "avx2", "avx2 x 8 threads", "gpu"
std::string place(const Execution& execution) {
  if (execution.device == Device::gpu) return "gpu";
  const std::string_view instructions = name(execution.instructions);
  return execution.threads == 1 ? std::string(instructions)
                                : fmt::format("{} x {} threads", instructions, execution.threads);
}

}  // namespace

std::string table(std::span<const EvaluationRow> rows) {
  constexpr const char* layout = "{:<12} {:<11} {:<6} {:>9} {:>10} {:>13} {:>15} {:>15} {:>10} {:>9} {:>7}  {}\n";
  std::string text =
      fmt::format(fmt::runtime(layout), "method", "kind", "real", "queries", "collisions", "answered true",
                  "false positives", "false negatives", "uncertain", "ns/query", "/ tight", "on");
  for (const EvaluationRow& row : rows) {
    const auto count = [&](std::uint64_t Mistakes::*field) {
      return row.mistakes ? fmt::format("{}", (*row.mistakes).*field) : std::string("-");
    };
    text += fmt::format(fmt::runtime(layout), name(row.method), name(row.kind), name(row.precision), row.queries,
                        count(&Mistakes::collisions), row.answers_true, count(&Mistakes::false_positives),
                        count(&Mistakes::false_negatives), row.uncertain, fmt::format("{:.1f}", row.ns_per_query),
                        fmt::format("{:.2f}", row.time_ratio_to_tight), place(row.execution));
  }
  return text;
}

std::string json(std::span<const EvaluationRow> rows) {
  Json array = Json::array();
  for (const EvaluationRow& row : rows) array.push_back(object(row));
  return array.dump(2) + "\n";
}

std::string csv(std::span<const EvaluationRow> rows) {
  std::string text;
  for (const EvaluationRow& row : rows) {
    std::vector<std::string> keys;
    std::vector<std::string> values;
    const Json fields = object(row);
    for (const auto& [key, value] : fields.items()) {
      keys.push_back(key);
      values.push_back(value.is_null() ? std::string() : value.is_string() ? value.get<std::string>() : value.dump());
    }
    if (text.empty()) text = fmt::format("{}\n", fmt::join(keys, ","));
    text += fmt::format("{}\n", fmt::join(values, ","));
  }
  return text;
}

}  // namespace tightrope::ccd
