#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <future>
#include <memory>
#include <utility>

#include "command/choices.h"
#include "command/command.h"
#include "command/interrupt.h"
#include "command/progress.h"
#include "query_io/query_writer.h"
#include "scenes/scene.h"
#include "scenes/truth.h"

namespace tightrope::ccd {
namespace {

constexpr std::uint64_t most_queries = 1'000'000'000;

struct GenerateOptions {
  std::string scene;
  std::uint64_t queries = 10'000;
  std::uint64_t seed = 1;
  std::string output;
  std::string kind;
};

struct Generated {
  Kind kind{};
  std::uint64_t collisions = 0;
};

/// Makes, decides and writes the queries of one kind; while a block is decided, by all cores, the next one is made.
std::optional<FileError> write_kind(const GenerateOptions& options, Scene scene, QueryWriter& writer,
                                    Generated& generated) {
  constexpr std::uint64_t queries_per_block = 16384;
  const auto generator = generate(scene, generated.kind, options.queries, options.seed);
  Progress progress(fmt::format("generating {} {}", options.scene, name(generated.kind)));
  QueryBlock block, next;
  block.kind = next.kind = generated.kind;
  const auto make_next = [&](std::uint64_t done) {
    next.points.resize(std::min(queries_per_block, options.queries - done) * coordinates_per_query);
    generator->fill(next.points);
  };
  make_next(0);
  for (std::uint64_t done = 0; done < options.queries;) {
    std::swap(block, next);
    done += block.size();
    std::future<void> making;
    if (done < options.queries) making = std::async(std::launch::async, make_next, done);
    block.truths.resize(block.size());
    exact_truths(block.kind, block.points, block.truths);
    for (const unsigned char truth : block.truths) generated.collisions += truth;
    if (auto wrong = writer.append(block)) return wrong;
    if (interrupted()) return FileError{"interrupted; nothing was written"};
    progress.show(done, options.queries);
    if (making.valid()) making.get();
  }
  return std::nullopt;
}

int run(const GenerateOptions& options) {
  const auto scene = scene_by_name(options.scene);
  if (!scene) {
    std::string names;
    for (const SceneInfo& info : scenes()) names += fmt::format("{}{}", names.empty() ? "" : ", ", info.name);
    return fail(fmt::format("unknown scene '{}'; accepted: {}", options.scene, names));
  }
  if (options.queries < 1 || options.queries > most_queries) {
    return fail(fmt::format("--queries must be from 1 to {}", most_queries));
  }
  catch_interrupts();
  auto created = create_queries(options.output, fmt::format("{}-{}", options.scene, options.seed));
  if (auto* wrong = std::get_if<FileError>(&created)) return fail(wrong->message);
  QueryWriter& writer = *std::get<std::unique_ptr<QueryWriter>>(created);
  const auto only = chosen_kind(options.kind);
  std::string summary;
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    if (only && kind != *only) continue;
    Generated generated{.kind = kind};
    if (auto wrong = write_kind(options, *scene, writer, generated)) return fail(wrong->message);
    summary += fmt::format("{}: {} {} queries, {} of them collisions\n", options.output, options.queries, name(kind),
                           generated.collisions);
  }
  if (auto wrong = writer.commit()) return fail(wrong->message);
  return print(summary);
}

std::string scene_list() {
  std::string text = "Scenes:\n";
  for (const SceneInfo& info : scenes()) text += fmt::format("  {:<21}{}\n", info.name, info.what);
  return text + "A seed gives the same queries on every machine.";
}

constexpr std::string_view survey_group = "degenerate-families";

/// The names for scripts, one a line; no scene is generated then.
void list_scenes(const std::string& group) {
  std::string text;
  for (const SceneInfo& info : scenes()) {
    const bool chosen = group == survey_group ? info.survey && info.name != survey_group : true;
    if (chosen) text += fmt::format("{}\n", info.name);
  }
  if (print(text) != success) throw CLI::RuntimeError(bad_usage);
  throw CLI::Success();
}

}  // namespace

Subcommand add_generate(CLI::App& app) {
  CLI::App* command = app.add_subcommand("generate", "Write queries of a scene with their exact truth");
  auto options = std::make_shared<GenerateOptions>();
  command->add_option("SCENE", options->scene, "one of the scenes below")->required()->type_name("");
  command->add_option("--queries", options->queries, "number of queries of each kind; 10000 if not given")
      ->type_name("N");
  command->add_option("--seed", options->seed, "1 if not given")->type_name("S");
  command
      ->add_option(
          "-o,--output", options->output,
          "FILE.h5, or a directory that gets vertex-face/SCENE-SEED.csv and edge-edge/SCENE-SEED.csv (rational format)")
      ->required()
      ->type_name("FILE.h5|DIR");
  add_kind(*command, options->kind, "only this kind");
  command
      ->add_option_function<std::string>("--list", list_scenes,
                                         "only list the names of the scenes: all, or degenerate-families (the survey)")
      ->check(CLI::IsMember(std::vector<std::string>{"all", std::string(survey_group)}))
      ->type_name("GROUP")
      ->trigger_on_parse();
  command->footer(scene_list());
  return {command, [options] { return run(*options); }};
}

}  // namespace tightrope::ccd
