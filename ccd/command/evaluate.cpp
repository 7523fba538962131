#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "codegen/charts/write_chart.h"
#include "command/chart.h"
#include "command/choices.h"
#include "command/command.h"
#include "command/evaluation.h"
#include "command/mpi.h"
#include "command/report.h"

namespace tightrope::ccd {
namespace {

struct EvaluateOptions {
  std::string methods = "all";
  std::string truth;
  std::string kind;
  std::string real = "double";
  std::string format;
  std::string chart;
  std::vector<std::string> paths;
  ExecutionChoice execution;
};

/// A chart needs a truth: where the files tell none and nothing was asked for, it is decided.
TruthSource truth_source(const EvaluateOptions& options) {
  if (options.truth == "exact") return TruthSource::exact;
  if (options.truth == "file") return TruthSource::file;
  return options.chart.empty() ? TruthSource::file_if_told : TruthSource::file_or_exact;
}

std::vector<Precision> precisions(const std::string& real) {
  if (real == "all") return {Precision::in_double, Precision::in_float};
  return {real == "float" ? Precision::in_float : Precision::in_double};
}

void tell_notes(const Evaluation& evaluation) {
  if (evaluation.rounded > 0) {
    warn(fmt::format("{} rational coordinates are no doubles and were rounded to nearest", evaluation.rounded));
  }
  if (evaluation.wrong_truths > 0) {
    warn(
        fmt::format("the files tell a truth that is not the exact one for {} of the queries", evaluation.wrong_truths));
  }
  if (evaluation.left_out > 0) {
    warn(fmt::format("queries beyond the range of float, left out there: {}", evaluation.left_out));
  }
  const bool known =
      std::all_of(evaluation.rows.begin(), evaluation.rows.end(), [](const auto& row) { return row.mistakes; });
  if (evaluation.changed > 0) {
    warn(fmt::format("queries that rounding to float changes{}: {}",
                     known ? "; their truth in float was decided exactly" : "", evaluation.changed));
  }
  if (!known) warn("the truth is not known, a file tells none; --truth exact decides the queries exactly");
}

/// "cloth-fold.h5, sample-queries": without the folders above them, which are of no interest in a chart.
std::string names_of(const std::vector<std::string>& paths) {
  std::string names;
  for (const std::filesystem::path path : paths) {
    const auto last = path.has_filename() ? path : path.parent_path();
    names += (names.empty() ? "" : ", ") + last.filename().string();
  }
  return names;
}

int run(const EvaluateOptions& options) {
  auto chosen = chosen_methods(options.methods);
  if (auto* wrong = std::get_if<std::string>(&chosen)) return fail(*wrong);
  if (!options.chart.empty()) {
    if (const std::string wrong = charts::check_chart_file(options.chart); !wrong.empty()) return fail(wrong);
  }
  const auto execution = chosen_execution(options.execution);
  if (const auto* wrong = std::get_if<std::string>(&execution)) return fail(*wrong);
  const EvaluationRequest request{.paths = options.paths,
                                  .kind = chosen_kind(options.kind),
                                  .methods = std::get<std::vector<Method>>(std::move(chosen)),
                                  .precisions = precisions(options.real),
                                  .truth = truth_source(options),
                                  .execution = std::get<Execution>(execution)};
  const auto outcome = evaluate(request, *mpi::processes());
  if (const auto* wrong = std::get_if<FileError>(&outcome)) return fail(wrong->message);
  const auto& evaluation = std::get<Evaluation>(outcome);
  tell_notes(evaluation);
  if (!options.chart.empty() && mpi::is_first()) {
    if (evaluation.rows.empty()) return fail("there are no queries to draw a chart of");
    const std::string wrong =
        charts::write_chart(evaluation_chart(evaluation.rows, names_of(options.paths)), options.chart);
    if (!wrong.empty()) return fail(wrong);
  }
  if (options.format == "json") return print(json(evaluation.rows));
  if (options.format == "csv") return print(csv(evaluation.rows));
  return print(table(evaluation.rows));
}

}  // namespace

Subcommand add_evaluate(CLI::App& app) {
  CLI::App* command = app.add_subcommand("evaluate", "Run methods on query files: wrong answers and time");
  auto options = std::make_shared<EvaluateOptions>();
  command
      ->add_option("--method", options->methods, fmt::format("all, or names with commas between: {}", method_names()))
      ->type_name("NAME,..");
  command
      ->add_option("--truth", options->truth,
                   "file: the files must tell it; exact: decided by exact arithmetic; if not given: the files' where "
                   "they tell it")
      ->type_name("SOURCE")
      ->check(CLI::IsMember({"file", "exact"}));
  command
      ->add_option("--real", options->real,
                   "the type that methods compute in: double, float or all; double if not given. For float every "
                   "coordinate is rounded to the nearest one")
      ->type_name("REAL")
      ->check(CLI::IsMember({"double", "float", "all"}));
  add_kind(*command, options->kind,
           "kind of CSV files whose path does not tell it; leaves out queries of the other kind");
  add_execution(*command, options->execution);
  add_device(*command, options->execution);
  add_format(*command, options->format, {"table", "json", "csv"});
  command
      ->add_option("--chart", options->chart,
                   "also draw a chart, time against false positives: a .svg, .png or .html file. Without --truth, what "
                   "the files do not tell is decided exactly")
      ->type_name("FILE");
  command->add_option("PATH", options->paths, "CSV and HDF5 query files, or directories of them")
      ->required()
      ->type_name("");
  command->footer(
      "'uncertain' counts the signs that a method met and its bounds could not tell. Times are those of batches in "
      "memory,\n"
      "reading not included; '/ tight' is the ratio to the method tight in the same type, measured in the same run. "
      "The\n"
      "exit status is 0 also when a method is wrong.");
  return {command, [options] { return run(*options); }, true};
}

}  // namespace tightrope::ccd
