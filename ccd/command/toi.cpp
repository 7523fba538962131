#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "command/choices.h"
#include "command/command.h"
#include "command/progress.h"
#include "command/spool.h"
#include "command/time_check.h"
#include "query_io/query_files.h"
#include "tightrope/batch.h"

namespace tightrope::ccd {
namespace {

struct ToiOptions {
  std::string method = "tightrope";
  ImpactOptions impact;
  bool check = false;
  std::string kind;
  std::string path;
  ExecutionChoice execution;
};

constexpr const char* methods_with_times = "tightrope, safe, safe-tight";

bool has_times(Method method) {
  switch (method) {
    case Method::tightrope:
    case Method::safe:
    case Method::safe_tight:
      return true;
    case Method::bsc_float:
    case Method::bsc_safe:
    case Method::tight:
    case Method::bsc_exact:
      return false;
  }
  return false;
}

/// What is wrong with the options; empty: nothing.
std::string wrong_with(const ToiOptions& options, Method method, const CLI::App& app) {
  const ImpactOptions& impact = options.impact;
  if (!has_times(method)) {
    return fmt::format("method '{}' tells no times; those that do: {}", options.method, methods_with_times);
  }
  if (!(impact.tolerance >= 0) || std::isinf(impact.tolerance)) return "--tolerance must be 0 or more, and finite";
  if (!(impact.t_max >= 0 && impact.t_max <= 1)) return "--t-max must be from 0 to 1";
  if (!(impact.minimum_separation >= 0) || std::isinf(impact.minimum_separation)) {
    return "--separation must be 0 or more, and finite";
  }
  if (method != Method::tightrope && (app.count("--tolerance") > 0 || app.count("--separation") > 0)) {
    return "--tolerance and --separation are method tightrope's";
  }
  if (options.check && impact.minimum_separation > 0) return "--check knows contact only, no --separation";
  return {};
}

/// The times of a block: one line each to `output`, and to the check if there is one. What went wrong, if anything.
std::string add_times(const QueryBlock& block, std::span<const double> times, Spool& output, TimeCheck* check) {
  std::string lines;
  for (std::size_t i = 0; i < block.size(); ++i) {
    fmt::format_to(std::back_inserter(lines), "{}\n", times[i]);  // "inf" for infinity
    if (check == nullptr) continue;
    const auto points = std::span(block.points).subspan(coordinates_per_query * i).first<coordinates_per_query>();
    check->add(block.kind, points, std::isinf(times[i]) ? std::nullopt : std::optional(times[i]));
  }
  return output.append(lines);
}

/// All answers first, then the output: a malformed row leaves none of it.
int run(const ToiOptions& options, const CLI::App& app) {
  const auto method = method_by_name(options.method);
  if (!method) return fail(fmt::format("unknown method '{}'; accepted: {}", options.method, methods_with_times));
  if (const std::string wrong = wrong_with(options, *method, app); !wrong.empty()) return fail(wrong);
  const auto chosen = chosen_execution(options.execution);
  if (const auto* wrong = std::get_if<std::string>(&chosen)) return fail(*wrong);
  const auto& execution = std::get<Execution>(chosen);
  const BatchOptions batch{.method = *method, .threads = execution.threads, .instructions = execution.instructions};
  auto found = find_query_files(std::span(&options.path, 1), chosen_kind(options.kind));
  if (auto* wrong = std::get_if<FileError>(&found)) return fail(wrong->message);
  QueryStream stream(std::get<std::vector<QueryFile>>(std::move(found)));
  Progress progress("times of impact");
  TimeCheck check(options.impact.tolerance, options.impact.t_max);
  QueryBlock block;
  std::vector<double> times;
  Spool output;
  std::uint64_t done = 0;
  while (true) {
    constexpr std::size_t queries_per_block = 16384;
    if (auto wrong = stream.next(queries_per_block, block)) return fail(wrong->message);
    if (block.size() == 0) break;
    times.resize(block.size());
    const Queries<double> queries{.kind = block.kind, .count = block.size(), .points = block.points.data()};
    const BatchStatus status = impact_times(queries, times.data(), options.impact, batch);
    if (status != BatchStatus::done) return fail(explanation(status));
    const std::string wrong = add_times(block, times, output, options.check ? &check : nullptr);
    if (!wrong.empty()) return fail(wrong);
    progress.show(done += block.size());
  }
  if (stream.rounded() > 0) {
    warn(fmt::format("{} rational coordinates are no doubles and were rounded to nearest", stream.rounded()));
  }
  if (const int status = output.print(); status != success || !options.check) return status;
  const TimeCheck::Counts& counts = check.counts();
  fmt::print(stderr, "{}: {}\n", options.method, summary(counts, options.impact.tolerance));
  const bool exact = *method == Method::tightrope;
  const bool broken = counts.missed + counts.late + (exact ? counts.false_ones + counts.early : 0) > 0;
  return broken ? promise_broken : success;
}

}  // namespace

Subcommand add_toi(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("toi", "The time of impact, one line a query, in file order: in [0, 1], or inf");
  auto options = std::make_shared<ToiOptions>();
  command->add_option("--method", options->method, fmt::format("one of {}; tightrope if not given", methods_with_times))
      ->type_name("NAME");
  command
      ->add_option(
          "--tolerance", options->impact.tolerance,
          "how much before the first contact a time may be, in steps; 1e-6 if not given; 0: not at all but for "
          "its rounding down to a double")
      ->type_name("D");
  command->add_option("--t-max", options->impact.t_max, "later contacts do not count; 1 if not given")->type_name("T");
  command
      ->add_option("--separation", options->impact.minimum_separation, "coming within this distance counts as contact")
      ->type_name("D");
  command->add_flag(
      "--check", options->check,
      "compare every time with the exact one (slow); tells on stderr how many are wrong, and exits with 1 "
      "if any breaks the method's promise");
  add_kind(*command, options->kind,
           "kind of CSV files whose path does not tell it; leaves out queries of the other kind");
  command->add_option("PATH", options->path, "a CSV or HDF5 query file, or a directory of them")
      ->required()
      ->type_name("");
  add_execution(*command, options->execution);
  command->footer(
      "No time is after the first contact; inf is a proof that there is none. Of method tightrope no time is more "
      "than\n"
      "the tolerance before it, none is 0 without contact at 0, and inf is printed whenever there is no contact.");
  return {command, [options, command] { return run(*options, *command); }};
}

}  // namespace tightrope::ccd
