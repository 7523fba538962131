#include "codegen/command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <functional>
#include <optional>
#include <sstream>

#include "codegen/accuracy_chart.h"
#include "codegen/certify.h"
#include "codegen/charts/write_chart.h"
#include "codegen/compile.h"
#include "codegen/explore/explore_command.h"
#include "codegen/gappa.h"
#include "codegen/import_command.h"
#include "codegen/print_tests.h"
#include "codegen/report.h"

namespace tightrope::codegen {
namespace {

constexpr int done = 0;
constexpr int bad_program = 1;
constexpr int bad_usage = 2;
constexpr int internal_error = 3;

int usage_error(const std::string& message) {
  fmt::print(stderr, "tightrope: error: {}\n", message);
  return bad_usage;
}

int program_error(const dsl::Diagnostics& diagnostics, const dsl::SourceMap& sources) {
  const std::string text = diagnostics.render(sources);
  std::fputs(text.c_str(), stderr);
  if (!text.empty() && text.back() != '\n') std::fputc('\n', stderr);
  return bad_program;
}

bool readable(const std::string& file) {
  std::error_code error;
  return !std::filesystem::is_directory(file, error) && std::ifstream(file).good();
}

template <class Value>
struct Choice {
  const char* name;
  std::vector<Value> values;
};

/// The values that a comma-separated list of names selects, each once, in the order of the choices.
template <class Value>
std::vector<Value> selected(const std::string& option, const std::string& list,
                            const std::vector<Choice<Value>>& choices, std::string& error) {
  std::string accepted;
  for (const auto& choice : choices) accepted += (accepted.empty() ? "" : ", ") + std::string(choice.name);
  std::vector<Value> wanted;
  std::stringstream stream(list);
  std::string name;
  while (std::getline(stream, name, ',')) {
    const auto choice =
        std::find_if(choices.begin(), choices.end(), [&](const Choice<Value>& c) { return c.name == name; });
    if (choice == choices.end()) {
      error = fmt::format("{}: unknown value '{}' (accepted: {})", option, name, accepted);
      return {};
    }
    wanted.insert(wanted.end(), choice->values.begin(), choice->values.end());
  }
  std::vector<Value> result;
  for (const auto& choice : choices) {
    for (const Value value : choice.values) {
      const bool is_wanted = std::find(wanted.begin(), wanted.end(), value) != wanted.end();
      if (is_wanted && std::find(result.begin(), result.end(), value) == result.end()) result.push_back(value);
    }
  }
  if (result.empty() && error.empty()) error = fmt::format("{}: no value given (accepted: {})", option, accepted);
  return result;
}

/// What the options of `compile` and `report` say, as written.
struct Arguments {
  std::vector<std::string> files;
  std::string bound = "tight";
  std::string real = "double";
  std::string products = "direct";
  std::string target = "cpp";
  std::string directory = ".";
  std::string depfile;
  std::string format = "text";
  std::string gappa = "gappa";
  double time_limit = 60;
  double assumed_range = 1;
  std::optional<double> report_range;
  bool fma = false;
  bool tests = false;
  bool measure = false;
  std::string chart;
  bool bound_given = false;
};

std::string interpret(const Arguments& arguments, CompileRequest& request) {
  std::string error;
  request.file = arguments.files.front();
  request.modes = selected<BoundMode>("--bound", arguments.bound,
                                      {{"float", {BoundMode::none}},
                                       {"safe", {BoundMode::safe}},
                                       {"tight", {BoundMode::tight}},
                                       {"static", {BoundMode::fixed}},
                                       {"interval", {BoundMode::interval}},
                                       {"exact", {BoundMode::exact}},
                                       {"staged", {BoundMode::staged}},
                                       {"all",
                                        {BoundMode::none, BoundMode::safe, BoundMode::tight, BoundMode::fixed,
                                         BoundMode::interval, BoundMode::exact, BoundMode::staged}}},
                                      error);
  request.only_applicable_modes = arguments.bound == "all";
  if (!error.empty()) return error;
  request.precisions = selected<Precision>("--real", arguments.real,
                                           {{"double", {Precision::binary64}},
                                            {"float", {Precision::binary32}},
                                            {"all", {Precision::binary64, Precision::binary32}}},
                                           error);
  if (!error.empty()) return error;
  const auto products = selected<dsl::ProductScheme>(
      "--products", arguments.products,
      {{"direct", {dsl::ProductScheme::direct}}, {"karatsuba", {dsl::ProductScheme::karatsuba}}}, error);
  if (!error.empty()) return error;
  if (products.size() != 1) return "--products: give one value, direct or karatsuba";
  request.products = products.front();
  request.targets = selected<Target>("--target", arguments.target,
                                     {{"cpp", {Target::cpp}},
                                      {"simd", {Target::simd}},
                                      {"cuda", {Target::cuda}},
                                      {"all", {Target::cpp, Target::simd, Target::cuda}}},
                                     error);
  if (!error.empty()) return error;
  if (!wants(request, Target::cpp)) {
    if (arguments.tests) return "--tests: the generated tests need --target cpp";
    for (const BoundMode mode : request.modes) {
      if (!request.only_applicable_modes && (mode == BoundMode::exact || mode == BoundMode::staged)) {
        return fmt::format("--bound: mode {} runs on the host, on one query at a time (needs --target cpp, not {})",
                           name(mode), arguments.target);
      }
    }
  }
  request.fma = arguments.fma;
  request.tests = arguments.tests;
  request.directory = arguments.directory;
  request.depfile = arguments.depfile;
  if (error.empty() && !readable(request.file)) error = fmt::format("cannot read {}", request.file);
  return error;
}

int run_check(const Arguments& arguments) {
  int status = done;
  for (const std::string& file : arguments.files) {
    if (!readable(file)) return usage_error(fmt::format("cannot read {}", file));
    dsl::SourceMap sources;
    dsl::Diagnostics diagnostics;
    const dsl::Program program = dsl::load_program(file, sources, diagnostics);
    if (diagnostics.has_errors()) {
      status = program_error(diagnostics, sources);
    } else {
      const std::size_t count = program.predicates.size();
      fmt::print("{}: {} predicate{}, no errors\n", file, count, count == 1 ? "" : "s");
    }
  }
  return status;
}

int run_compile(const Arguments& arguments) {
  CompileRequest request;
  if (const std::string error = interpret(arguments, request); !error.empty()) return usage_error(error);
  dsl::SourceMap sources;
  dsl::Diagnostics diagnostics;
  const auto files = compile(request, sources, diagnostics);
  if (!files) return program_error(diagnostics, sources);
  if (const std::string foreign = foreign_file(*files); !foreign.empty()) {
    return usage_error(fmt::format("{} is there and was not generated; choose another folder with -o", foreign));
  }
  if (const std::string error = write_files(*files); !error.empty()) return usage_error(error);
  return done;
}

/// Writes the chart that `report` was asked for. `program` as loaded.
int write_accuracy_chart(const Arguments& arguments, CompileRequest request, dsl::Program program,
                         const dsl::SourceMap& sources) {
  AccuracyRequest accuracy;
  if (!arguments.bound_given) request.modes = accuracy.modes;
  request.only_applicable_modes = !arguments.bound_given || arguments.bound == "all";
  accuracy.assumed_range = arguments.report_range.value_or(1);
  for (dsl::Predicate& p : program.predicates) {
    for (const dsl::Parameter& parameter : p.parameters) {
      accuracy.ranges_assumed = accuracy.ranges_assumed || !parameter.range;
    }
    p = with_assumed_ranges(p, accuracy.assumed_range);
  }
  accuracy.modes = modes_of(request, program);
  std::erase_if(accuracy.modes, [](BoundMode mode) {
    return mode == BoundMode::none || mode == BoundMode::exact || mode == BoundMode::staged;
  });
  if (accuracy.modes.empty()) return usage_error("--chart: no bounds to draw; give --bound safe, tight, static, ...");
  accuracy.precisions = request.precisions;
  accuracy.gappa = find_program("gappa");
  accuracy.source = std::filesystem::path(request.file).filename().string();
  dsl::Diagnostics diagnostics;
  const charts::Chart chart = accuracy_chart(program, accuracy, diagnostics);
  if (diagnostics.has_errors()) return program_error(diagnostics, sources);
  const std::string error = charts::write_chart(chart, arguments.chart);
  return error.empty() ? done : usage_error(error);
}

int run_report(const Arguments& arguments) {
  CompileRequest request;
  if (const std::string error = interpret(arguments, request); !error.empty()) return usage_error(error);
  if (arguments.format != "text" && arguments.format != "json" && arguments.format != "table") {
    return usage_error(fmt::format("--format: unknown value '{}' (accepted: text, json, table)", arguments.format));
  }
  for (const BoundMode mode : {BoundMode::exact, BoundMode::staged}) {
    const bool asked = std::find(request.modes.begin(), request.modes.end(), mode) != request.modes.end();
    if (asked && arguments.bound != "all") {
      return usage_error(fmt::format("--bound: mode {} has no bounds to report", name(mode)));
    }
  }
  if (!arguments.chart.empty()) {
    if (const std::string error = charts::check_chart_file(arguments.chart); !error.empty()) return usage_error(error);
  }
  dsl::SourceMap sources;
  dsl::Diagnostics diagnostics;
  dsl::Program program = load(request, sources, diagnostics);
  if (diagnostics.has_errors()) return program_error(diagnostics, sources);
  const dsl::Program as_loaded = program;
  if (arguments.report_range) {
    if (!(*arguments.report_range > 0)) return usage_error("--assume-range takes a positive number");
    for (dsl::Predicate& p : program.predicates) p = with_assumed_ranges(p, *arguments.report_range);
  }
  const auto bounded = bounded_programs(program, modes_of(request, program), request.precisions, diagnostics);
  if (diagnostics.has_errors()) return program_error(diagnostics, sources);
  const std::string text =
      report(program, bounded, {arguments.format == "json", arguments.format == "table", arguments.measure});
  if (!arguments.chart.empty()) {
    const int status = write_accuracy_chart(arguments, request, as_loaded, sources);
    if (status != done) return status;
  }
  std::fputs(text.c_str(), stdout);
  return done;
}

int run_certify(const Arguments& arguments) {
  CompileRequest request;
  if (const std::string error = interpret(arguments, request); !error.empty()) return usage_error(error);
  CertifyRequest certificates{request.modes,
                              request.precisions,
                              arguments.assumed_range,
                              arguments.directory,
                              find_program(arguments.gappa),
                              arguments.time_limit};
  for (const BoundMode mode : certificates.modes) {
    if (mode != BoundMode::fixed && mode != BoundMode::safe) {
      return usage_error(
          fmt::format("--bound: '{}' has no bound that Gappa could prove (accepted: static, safe)", name(mode)));
    }
  }
  if (!(arguments.assumed_range > 0) || !(arguments.time_limit > 0)) {
    return usage_error("--assume-range and --time-limit take positive numbers");
  }
  if (certificates.gappa.empty() && arguments.gappa != "gappa") {
    return usage_error(fmt::format("--gappa: cannot run {}", arguments.gappa));
  }
  dsl::SourceMap sources;
  dsl::Diagnostics diagnostics;
  const dsl::Program program = dsl::load_program(request.file, sources, diagnostics, {.products = request.products});
  if (diagnostics.has_errors()) return program_error(diagnostics, sources);
  std::vector<Certificate> results;
  const std::string error = certify(program, certificates, diagnostics, results);
  if (diagnostics.has_errors()) return program_error(diagnostics, sources);
  if (!error.empty()) return usage_error(error);
  std::fputs(text(results).c_str(), stdout);
  if (certificates.gappa.empty()) {
    fmt::print(stderr, "tightrope: gappa is not installed: the scripts are written, nothing is proved\n");
  }
  return unproved(results) ? bad_program : done;
}

void add_file_option(CLI::App& command, Arguments& arguments, bool several) {
  CLI::Option* option = command.add_option("FILE", arguments.files, "the predicates (.pred)")->required();
  if (!several) option->expected(1);
}

void add_program_options(CLI::App& command, Arguments& arguments) {
  command
      .add_option("--bound", arguments.bound,
                  "float, safe, tight, static, interval, exact, staged, a comma list of them, or all")
      ->capture_default_str();
  command.add_option("--real", arguments.real, "double, float, double,float or all")->capture_default_str();
  command
      .add_option("--products", arguments.products,
                  "how products of polynomials are computed: direct, or karatsuba (fewer multiplications)")
      ->capture_default_str();
  command.add_flag("--fma", arguments.fma, "contract products into sums: for hardware with fused multiply-add");
}

}  // namespace

int run_command(int argc, const char* const* argv) {
  Arguments arguments;
  std::function<int(const Arguments&)> run;
  CLI::App app("Compiles polynomial geometric predicates into C++ with derived error bounds.", "tightrope");
  app.set_version_flag("--version", "tightrope " TIGHTROPE_VERSION);
  app.require_subcommand(1);

  CLI::App& check = *app.add_subcommand("check", "Report the errors of predicates");
  add_file_option(check, arguments, true);
  check.callback([&] { run = run_check; });

  CLI::App& compile = *app.add_subcommand("compile", "Write NAME.BOUND.REAL.h for every bound and scalar type");
  add_file_option(compile, arguments, false);
  add_program_options(compile, arguments);
  compile
      .add_option("--target", arguments.target,
                  "cpp; simd: NAME.BOUND.REAL.simd.h for vector classes; cuda: NAME.BOUND.REAL.cu for batches on a GPU "
                  "(both not of exact, staged); a comma list, or all")
      ->capture_default_str();
  compile.add_flag("--tests", arguments.tests, "also write NAME.test.cpp and a CMakeLists.txt that runs it");
  compile.add_option("--depfile", arguments.depfile, "write what the outputs depend on, in make's syntax");
  compile.add_option("-o", arguments.directory, "folder for the outputs")->capture_default_str();
  compile.callback([&] { run = run_compile; });

  CLI::App& report = *app.add_subcommand("report", "Per output: degree, operation counts, bound");
  add_file_option(report, arguments, false);
  add_program_options(report, arguments);
  report.add_option("--format", arguments.format, "text, json, or table (with --measure: bound / error by mode)")
      ->capture_default_str();
  report.add_option("--assume-range", arguments.report_range,
                    "range of the inputs that declare none (else they have none)");
  report.add_flag("--measure", arguments.measure, "also compare the bounds with true errors on random inputs");
  report.add_option(
      "--chart", arguments.chart,
      "also draw the bounds (safe, tight and static without --bound) and Gappa's against true errors, over "
      "the magnitude of the inputs: a .svg, .png or .html file");
  report.callback([&] {
    arguments.bound_given = report.count("--bound") > 0;
    run = run_report;
  });

  CLI::App& certify =
      *app.add_subcommand("certify", "Write Gappa scripts that claim the bounds, and run Gappa on them");
  add_file_option(certify, arguments, false);
  add_program_options(certify, arguments);
  certify.get_option("--bound")->description("static, safe, or static,safe")->default_str("static,safe");
  certify.add_option("-o", arguments.directory, "folder for the scripts and for what Gappa prints")
      ->capture_default_str();
  certify.add_option("--gappa", arguments.gappa, "the program to run")->capture_default_str();
  certify.add_option("--time-limit", arguments.time_limit, "seconds a script")->capture_default_str();
  certify.add_option("--assume-range", arguments.assumed_range, "range of the inputs that declare none")
      ->capture_default_str();
  certify.callback([&] {
    if (certify.count("--bound") == 0) arguments.bound = "static,safe";
    run = run_certify;
  });

  ImportArguments import_arguments;
  add_import_command(app, import_arguments).callback([&] {
    run = [&](const Arguments&) { return run_import(import_arguments); };
  });

  ExploreArguments explore_arguments;
  add_explore_command(app, explore_arguments).callback([&] {
    run = [&](const Arguments&) { return run_explore(explore_arguments); };
  });

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? done : bad_usage;
  }
  try {
    return run(arguments);
  } catch (const TranslationError& error) {
    fmt::print(stderr, "tightrope: internal error: what was printed is not what was analysed; nothing is written\n{}\n",
               error.what());
    return internal_error;
  }
}

}  // namespace tightrope::codegen
