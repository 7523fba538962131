#include <fmt/format.h>

#include <fstream>
#include <memory>

#include "command/build_fit.h"
#include "command/choices.h"
#include "command/command.h"
#include "command/progress.h"
#include "command/unfinished_folder.h"
#include "fit/choice.h"
#include "fit/folder.h"
#include "fit/report.h"
#include "query_io/query_files.h"

namespace tightrope::ccd {
namespace {

constexpr std::size_t sample_size = 1 << 17;
constexpr int missed = 1;  ///< exit status
constexpr const char* report_file = "fit.txt";

struct FitOptions {
  double max_false_positives = 0;
  std::string need = "boolean";
  std::string kind;
  std::string name = "fitted";
  std::string output;
  std::string prefix;
  bool build = false;
  std::vector<std::string> paths;
};

/// The scenes of both kinds, those without queries left out.
std::variant<std::vector<SceneSample>, FileError> read_scene(const FitOptions& options) {
  auto found = find_query_files(options.paths, chosen_kind(options.kind));
  if (auto* wrong = std::get_if<FileError>(&found)) return *wrong;
  QueryStream stream(std::get<std::vector<QueryFile>>(std::move(found)));
  std::vector<SceneSample> samples{{Kind::vertex_face, sample_size}, {Kind::edge_edge, sample_size}};
  Progress progress("reading");
  std::uint64_t queries = 0;
  for (QueryBlock block;;) {
    constexpr std::size_t queries_per_block = 4096;
    if (auto wrong = stream.next(queries_per_block, block)) return *wrong;
    if (block.size() == 0) break;
    samples[block.kind == Kind::vertex_face ? 0 : 1].add(block.points);
    progress.show(queries += block.size());
  }
  std::erase_if(samples, [](const SceneSample& sample) { return sample.figures().queries == 0; });
  return samples;
}

std::optional<std::string> write(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) return fmt::format("cannot write {}", path.string());
  return std::nullopt;
}

std::optional<std::string> write_folder(const FitOptions& options, const std::vector<Choice>& choices,
                                        const std::string& text) {
  UnfinishedFolder folder(options.output, report_file);
  if (auto wrong = folder.create()) return wrong;
  std::vector<FitFile> files = fit_files(options.name, choices, options.need == "toi");
  files.push_back({report_file, text});
  for (const FitFile& file : files) {
    if (auto wrong = write(folder.path() / file.name, file.text)) return wrong;
  }
  return folder.commit();
}

/// Builds the folder and runs its check on the samples; the check prints what it finds.
int build_and_check(const FitOptions& options, const std::vector<SceneSample>& samples) {
  const FitBuild build(options.output, options.name, options.prefix);
  if (auto wrong = build.run_build()) return fail(*wrong);
  std::vector<std::string> arguments;
  for (const SceneSample& sample : samples) {
    const auto path = build.path() / fmt::format("{}.queries", name(sample.kind()));
    const std::string_view bytes(reinterpret_cast<const char*>(sample.points().data()), sample.points().size_bytes());
    if (auto wrong = write(path, bytes)) return fail(*wrong);
    arguments.insert(arguments.end(), {std::string(name(sample.kind())), path.string()});
  }
  if (build.run_check(arguments)) return success;
  fail("the fitted queries miss contacts");
  return missed;
}

int run(const FitOptions& options) {
  const FitRequest request{options.max_false_positives, options.need == "toi"};
  if (!(request.max_false_positives >= 0 && request.max_false_positives <= 1)) {
    return fail("--max-false-positives must be from 0 to 1");
  }
  if (!is_fit_name(options.name)) return fail("--name must be letters, digits and _, the first a letter");
  auto read = read_scene(options);
  if (auto* wrong = std::get_if<FileError>(&read)) return fail(wrong->message);
  const auto& samples = std::get<std::vector<SceneSample>>(read);
  std::vector<Choice> choices;
  std::string text;
  for (const SceneSample& sample : samples) {
    choices.push_back(choose(sample, request));
    text += report(sample, choices.back(), request);
  }
  if (auto wrong = write_folder(options, choices, text)) return fail(*wrong);
  if (const int status = print(text); status != success) return status;
  return options.build ? build_and_check(options, samples) : success;
}

}  // namespace

Subcommand add_fit(CLI::App& app) {
  CLI::App* command = app.add_subcommand("fit", "Write queries fitted to a scene: no more model than it needs");
  auto options = std::make_shared<FitOptions>();
  command
      ->add_option("--max-false-positives", options->max_false_positives,
                   "share of the queries without contact that may be reported; 0, none, if not given")
      ->type_name("R");
  command->add_option("--need", options->need, "boolean or toi, the time of impact, too; boolean if not given")
      ->type_name("WHAT")
      ->check(CLI::IsMember({"boolean", "toi"}));
  add_kind(*command, options->kind,
           "kind of CSV files whose path does not tell it; leaves out queries of the other kind");
  command->add_option("--name", options->name, "of files, functions and predicates; fitted if not given")
      ->type_name("NAME");
  command->add_flag("--build", options->build, "build it with CMake, check it on the scene and tell the speed-up");
  command->add_option("--prefix", options->prefix, "where Tightrope is installed; where this command is, if not given")
      ->type_name("DIR");
  command->add_option("-o,--output", options->output, "folder for the predicates, the C++ and its CMakeLists.txt")
      ->required()
      ->type_name("DIR");
  command->add_option("PATH", options->paths, "CSV or HDF5 query files of the scene, or directories of them")
      ->required()
      ->type_name("");
  return {command, [options] { return run(*options); }};
}

}  // namespace tightrope::ccd
