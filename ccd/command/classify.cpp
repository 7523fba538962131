#include <fmt/format.h>

#include <memory>

#include "command/choices.h"
#include "command/command.h"
#include "command/progress.h"
#include "command/spool.h"
#include "query_io/query_files.h"

namespace tightrope::ccd {
namespace {

struct ClassifyOptions {
  std::string method;
  std::string kind;
  std::string path;
  ExecutionChoice execution;
};

/// All answers first, then the output: a malformed row leaves none of it.
int run(const ClassifyOptions& options) {
  const auto method = method_by_name(options.method);
  if (!method) return fail(fmt::format("unknown method '{}'; accepted: {}", options.method, method_names()));
  const auto chosen = chosen_execution(options.execution);
  if (const auto* wrong = std::get_if<std::string>(&chosen)) return fail(*wrong);
  auto found = find_query_files(std::span(&options.path, 1), chosen_kind(options.kind));
  if (auto* wrong = std::get_if<FileError>(&found)) return fail(wrong->message);
  QueryStream stream(std::get<std::vector<QueryFile>>(std::move(found)));
  Progress progress("classifying");
  QueryBlock block;
  std::vector<unsigned char> answers;
  std::string lines;
  Spool output;
  std::uint64_t done = 0;
  while (true) {
    constexpr std::size_t queries_per_block = 65536;
    if (auto wrong = stream.next(queries_per_block, block)) return fail(wrong->message);
    if (block.size() == 0) break;
    answers.resize(block.size());
    const Queries<double> queries{.kind = block.kind, .count = block.size(), .points = block.points.data()};
    const BatchStatus status = collides(queries, answers.data(), *method, std::get<Execution>(chosen));
    if (status != BatchStatus::done) return fail(explanation(status));
    lines.clear();
    for (const unsigned char answer : answers) lines += answer != 0 ? "1\n" : "0\n";
    if (const std::string wrong = output.append(lines); !wrong.empty()) return fail(wrong);
    progress.show(done += block.size());
  }
  if (stream.rounded() > 0) {
    warn(fmt::format("{} rational coordinates are no doubles and were rounded to nearest", stream.rounded()));
  }
  return output.print();
}

}  // namespace

Subcommand add_classify(CLI::App& app) {
  CLI::App* command = app.add_subcommand("classify", "One line a query, in file order: 1 collides, 0 does not");
  auto options = std::make_shared<ClassifyOptions>();
  command->add_option("--method", options->method, fmt::format("one of {}", method_names()))
      ->required()
      ->type_name("NAME");
  add_kind(*command, options->kind,
           "kind of CSV files whose path does not tell it; leaves out queries of the other kind");
  command->add_option("PATH", options->path, "a CSV or HDF5 query file, or a directory of them")
      ->required()
      ->type_name("");
  add_execution(*command, options->execution);
  add_device(*command, options->execution);
  return {command, [options] { return run(*options); }};
}

}  // namespace tightrope::ccd
