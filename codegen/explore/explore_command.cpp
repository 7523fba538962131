#include "codegen/explore/explore_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "codegen/charts/write_chart.h"
#include "codegen/compile.h"
#include "codegen/explore/chart.h"
#include "codegen/explore/emit.h"
#include "codegen/explore/exploration.h"
#include "codegen/print_tests.h"

namespace tightrope::codegen {

using namespace explore;

namespace {

constexpr int done = 0;
constexpr int bad_program = 1;
constexpr int bad_usage = 2;

/// Random inputs that are drawn for a predicate.
constexpr int random_inputs = 2048;

int usage_error(const std::string& message) {
  fmt::print(stderr, "tightrope: error: {}\n", message);
  return bad_usage;
}

std::string check_options(const ExploreArguments& arguments) {
  if (arguments.real != "double" && arguments.real != "float") {
    return fmt::format("--real: unknown value '{}' (accepted: double, float)", arguments.real);
  }
  if (arguments.format != "text" && arguments.format != "json") {
    return fmt::format("--format: unknown value '{}' (accepted: text, json)", arguments.format);
  }
  if (arguments.emit.empty() && arguments.tests) return "--tests belongs to --emit";
  std::error_code ignored;
  if (std::filesystem::is_directory(arguments.file, ignored) || !std::ifstream(arguments.file).good()) {
    return fmt::format("cannot read {}", arguments.file);
  }
  return "";
}

/// The last stage that a call evaluates, by name.
std::string find_stage(const dsl::Predicate& predicate, const std::string& name, std::size_t& stage) {
  std::string known;
  for (stage = 0; stage < predicate.stages.size(); ++stage) {
    if (predicate.stages[stage].name == name) return "";
    known += (known.empty() ? "" : ", ") + predicate.stages[stage].name;
  }
  stage = predicate.stages.size() - 1;
  return name.empty() ? "" : fmt::format("--stage: `{}` has no '{}' (it has {})", predicate.name, name, known);
}

std::vector<std::string> words(const std::string& text) {
  std::vector<std::string> result;
  std::stringstream stream(text);
  for (std::string word; stream >> word;) result.push_back(word);
  return result;
}

int emit(const ExploreArguments& arguments, const Lowerings& lowerings, const EmitRequest& request) {
  const std::vector<Candidate> all = candidates(lowerings, request.inputs);
  const auto chosen = std::find_if(all.begin(), all.end(), [&](const Candidate& c) {
    return c.name() == arguments.emit ||
           std::find(c.aliases.begin(), c.aliases.end(), arguments.emit) != c.aliases.end();
  });
  if (chosen == all.end()) {
    std::string known;
    for (const Candidate& c : all) known += (known.empty() ? "" : ", ") + c.name();
    return usage_error(
        fmt::format("--emit: `{}` has no scheme '{}' (it has {})", lowerings.written().name, arguments.emit, known));
  }
  if (request.tests && !has_tests(chosen->scheme, request.inputs)) {
    return usage_error(fmt::format("--tests: there are none of {} on floats", chosen->name()));
  }
  const std::vector<TextFile> files = emitted_files(*chosen, lowerings.written(), request);
  if (const std::string foreign = foreign_file(files); !foreign.empty()) {
    return usage_error(fmt::format("{} is there and was not generated; choose another folder with -o", foreign));
  }
  if (const std::string error = write_files(files); !error.empty()) return usage_error(error);
  return done;
}

int measure(const ExploreArguments& arguments, const Lowerings& lowerings, Precision inputs) {
  ExplorationRequest request;
  request.time = !arguments.no_time;
  request.all = arguments.all;
  request.timing.inputs = inputs;
  request.timing.flags = words(arguments.flags);
  std::string error = arguments.output.empty() ? "" : charts::check_chart_file(arguments.output);
  if (!error.empty()) return usage_error(error);
  error = find_stage(lowerings.written(), arguments.stage, request.timing.last_stage);
  if (!error.empty()) return usage_error(error);
  if (request.time) request.timing.compiler = find_compiler(error);
  if (!error.empty()) return usage_error(error);
  std::vector<Row> rows;
  if (arguments.inputs.empty()) {
    rows = random_rows(lowerings.written(), inputs, random_inputs);
  } else {
    error = read_rows(arguments.inputs, lowerings.written(), inputs, rows);
    if (!error.empty()) return usage_error(error);
  }
  Exploration exploration = explore::explore(lowerings, rows, request, error);
  if (!error.empty()) return usage_error(error);
  exploration.given_inputs = !arguments.inputs.empty();
  if (!arguments.output.empty()) {
    error = charts::write_chart(exploration_chart(exploration), arguments.output);
    if (!error.empty()) return usage_error(error);
  }
  std::fputs((arguments.format == "json" ? json(exploration) : text(exploration)).c_str(), stdout);
  return done;
}

}  // namespace

CLI::App& add_explore_command(CLI::App& app, ExploreArguments& arguments) {
  CLI::App& command = *app.add_subcommand(
      "explore", "Compare evaluation schemes of a predicate: operations, time and bounds of equal polynomials");
  command.add_option("FILE", arguments.file, "the predicates (.pred)")->required()->expected(1);
  command.add_option("--predicate", arguments.predicate, "which one, if the file has several");
  command.add_option("--stage", arguments.stage, "a call evaluates the stages up to this one (all if not given)");
  command.add_option("--real", arguments.real, "type of the inputs: double or float")->capture_default_str();
  command.add_option("--inputs", arguments.inputs, "CSV file with one input a line in place of random ones");
  command.add_option("--emit", arguments.emit,
                     "write the header of this scheme into the folder -o, and measure nothing");
  command.add_flag("--tests", arguments.tests, "with --emit: also write its tests");
  command.add_option("-o", arguments.output, "a chart, .svg, .png or .html; with --emit the folder");
  command.add_option("--format", arguments.format, "text or json")->capture_default_str();
  command.add_option("--flags", arguments.flags, "of the C++ compiler, $CXX or c++")->capture_default_str();
  command.add_flag("--no-time", arguments.no_time, "operations and bounds alone: the same on every machine");
  command.add_flag("--all", arguments.all, "time schemes with far more operations than others, too");
  return command;
}

int run_explore(const ExploreArguments& arguments) {
  if (const std::string error = check_options(arguments); !error.empty()) return usage_error(error);
  dsl::SourceMap sources;
  dsl::Diagnostics diagnostics;
  Lowerings lowerings;
  std::uint64_t hash = 0;
  const std::string error = load_lowerings(arguments.file, arguments.predicate, sources, diagnostics, lowerings, hash);
  if (diagnostics.has_errors()) {
    fmt::print(stderr, "{}\n", diagnostics.render(sources));
    return bad_program;
  }
  if (!error.empty()) return usage_error(error);
  const Precision inputs = arguments.real == "double" ? Precision::binary64 : Precision::binary32;
  if (arguments.emit.empty()) return measure(arguments, lowerings, inputs);
  return emit(arguments, lowerings,
              {arguments.file, hash, inputs, arguments.output.empty() ? "." : arguments.output, arguments.tests});
}

}  // namespace tightrope::codegen
