#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "command/choices.h"
#include "command/command.h"
#include "command/stage_times.h"

namespace tightrope::ccd {
namespace {

struct StagesOptions {
  std::string need = "boolean";
  std::string real = "double";
  std::string kind;
  std::string format;
  std::vector<std::string> paths;
};

std::string table(const std::vector<StageRow>& rows) {
  constexpr const char* layout = "{:<11} {:<11} {:>9} {:>9} {:>10} {:>9}\n";
  std::string text =
      fmt::format(fmt::runtime(layout), "kind", "decided by", "queries", "fraction", "ns/query", "of time");
  std::uint64_t queries = 0;
  double nanoseconds = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const StageRow& row = rows[i];
    text += fmt::format(
        fmt::runtime(layout), name(row.kind), name(row.stage), row.queries, fmt::format("{:.3f}%", 100 * row.fraction),
        row.queries > 0 ? fmt::format("{:.1f}", row.ns_per_query) : "-", fmt::format("{:.1f}%", 100 * row.time_share));
    queries += row.queries;
    nanoseconds += row.ns_per_query * static_cast<double>(row.queries);
    if (i + 1 == rows.size() || rows[i + 1].kind != row.kind) {
      text += fmt::format(fmt::runtime(layout), name(row.kind), "all", queries, "",
                          fmt::format("{:.1f}", nanoseconds / static_cast<double>(queries)), "");
      queries = 0;
      nanoseconds = 0;
    }
  }
  return text;
}

std::string json(const std::vector<StageRow>& rows) {
  auto array = nlohmann::ordered_json::array();
  for (const StageRow& row : rows) {
    const auto rounded = [](double x, double digits) { return std::round(x * digits) / digits; };
    array.push_back({{"kind", name(row.kind)},
                     {"stage", name(row.stage)},
                     {"queries", row.queries},
                     {"fraction", rounded(row.fraction, 1e7)},
                     {"ns_per_query", rounded(row.ns_per_query, 1e3)},
                     {"time_share", rounded(row.time_share, 1e5)}});
  }
  return array.dump(2) + "\n";
}

std::string csv(const std::vector<StageRow>& rows) {
  std::string text = "kind,stage,queries,fraction,ns_per_query,time_share\n";
  for (const StageRow& row : rows) {
    text += fmt::format("{},{},{},{:.7g},{:.3f},{:.5f}\n", name(row.kind), name(row.stage), row.queries, row.fraction,
                        row.ns_per_query, row.time_share);
  }
  return text;
}

int run(const StagesOptions& options) {
  StagesRequest request{.paths = options.paths, .kind = chosen_kind(options.kind)};
  if (options.need == "toi") request.question = Question::when;
  if (options.real == "float") request.precision = Precision::in_float;
  const auto result = stage_times(request);
  if (const auto* wrong = std::get_if<FileError>(&result)) return fail(wrong->message);
  const auto& rows = std::get<std::vector<StageRow>>(result);
  if (options.format == "json") return print(json(rows));
  return print(options.format == "csv" ? csv(rows) : table(rows));
}

}  // namespace

Subcommand add_stages(CLI::App& app) {
  CLI::App* command = app.add_subcommand("stages", "Which stage of method tightrope decides the queries, and its cost");
  auto options = std::make_shared<StagesOptions>();
  command->add_option("--need", options->need, "boolean or toi, the time of impact to 1e-6; boolean if not given")
      ->type_name("WHAT")
      ->check(CLI::IsMember({"boolean", "toi"}));
  command->add_option("--real", options->real, "double or float: coordinates rounded to it; double if not given")
      ->type_name("REAL")
      ->check(CLI::IsMember({"double", "float"}));
  add_kind(*command, options->kind,
           "kind of CSV files whose path does not tell it; leaves out queries of the other kind");
  add_format(*command, options->format, {"table", "json", "csv"});
  command->add_option("PATH", options->paths, "CSV or HDF5 query files, or directories of them")
      ->required()
      ->type_name("");
  command->footer(
      "first-look, separation, hull, subdivision and exact take turns; a query's time is that of all its stages.");
  return {command, [options] { return run(*options); }};
}

}  // namespace tightrope::ccd
