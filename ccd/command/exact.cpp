#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <span>
#include <string>

#include "command/choices.h"
#include "command/command.h"
#include "command/progress.h"
#include "command/spool.h"
#include "oracle/contact_time.h"
#include "query_io/query_files.h"

namespace tightrope::ccd {
namespace {

struct ExactOptions {
  double width = 0x1p-60;
  std::string kind;
  std::string path;
};

/// "none", "2/7", or "5/8 3/4" around an irrational time.
std::string line(Kind kind, std::span<const double, coordinates_per_query> points, const mpq_class& width) {
  const auto time = oracle::first_contact(kind, points, width);
  if (!time) return "none\n";
  if (time->lower == time->upper) return time->lower.get_str() + "\n";
  return fmt::format("{} {}\n", time->lower.get_str(), time->upper.get_str());
}

/// All answers first, then the output: a malformed row leaves none of it.
int run(const ExactOptions& options) {
  if (!(options.width > 0) || std::isinf(options.width)) return fail("--width must be positive");
  auto found = find_query_files(std::span(&options.path, 1), chosen_kind(options.kind));
  if (auto* wrong = std::get_if<FileError>(&found)) return fail(wrong->message);
  QueryStream stream(std::get<std::vector<QueryFile>>(std::move(found)));
  Progress progress("deciding");
  QueryBlock block;
  Spool output;
  std::uint64_t done = 0;
  while (true) {
    constexpr std::size_t queries_per_block = 4096;
    if (auto wrong = stream.next(queries_per_block, block)) return fail(wrong->message);
    if (block.size() == 0) break;
    for (std::size_t i = 0; i < block.size(); ++i) {
      const auto points = std::span(block.points).subspan(coordinates_per_query * i).first<coordinates_per_query>();
      const std::string wrong = output.append(line(block.kind, points, options.width));
      if (!wrong.empty()) return fail(wrong);
      progress.show(++done);
    }
  }
  if (stream.rounded() > 0) {
    warn(fmt::format("{} rational coordinates are no doubles and were rounded to nearest", stream.rounded()));
  }
  return output.print();
}

}  // namespace

Subcommand add_exact(CLI::App& app) {
  CLI::App* command = app.add_subcommand("exact", "The exact time of first contact, one line a query, in file order");
  auto options = std::make_shared<ExactOptions>();
  command
      ->add_option("--width", options->width, "how closely an irrational time is enclosed at least; 2^-60 if not given")
      ->type_name("W");
  add_kind(*command, options->kind,
           "kind of CSV files whose path does not tell it; leaves out queries of the other kind");
  command->add_option("PATH", options->path, "a CSV or HDF5 query file, or a directory of them")
      ->required()
      ->type_name("");
  command->footer(
      "A line is 'none', or a rational time (2/7), or, of an irrational time, two rationals around it. By exact\n"
      "arithmetic alone: slow, and right.");
  return {command, [options] { return run(*options); }};
}

}  // namespace tightrope::ccd
