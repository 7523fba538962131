#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>

#include "command/choices.h"
#include "command/command.h"
#include "command/interrupt.h"
#include "command/progress.h"
#include "command/unfinished_folder.h"
#include "query_io/query_writer.h"
#include "stability/atlas_json.h"
#include "stability/base_queries.h"
#include "stability/index_page.h"
#include "stability/rates.h"
#include "stability/sweep.h"

namespace tightrope::ccd {
namespace {

namespace fs = std::filesystem;

constexpr int defect = 3;  ///< exit status: a method broke its promise
constexpr std::size_t most_queries = 100'000;

struct StabilityOptions {
  std::string methods = "all";
  std::string families = "all";
  std::string kind;
  std::string real = "double";
  std::string axes = "full";
  std::size_t queries = 50;
  std::uint64_t seed = 1;
  std::string output;
};

std::string family_names() {
  std::string names;
  for (const Scene scene : stability::families()) names += fmt::format("{}{}", names.empty() ? "" : ", ", name(scene));
  return names;
}

/// "all" or names with commas between, in the order of the tables; or what is wrong.
std::variant<std::vector<Scene>, std::string> chosen_families(std::string_view text) {
  const std::vector<Scene> all = stability::families();
  std::vector<Scene> wanted;
  while (true) {
    const std::size_t comma = text.find(',');
    const std::string_view one = text.substr(0, comma);
    const auto found = std::find_if(all.begin(), all.end(), [&](Scene scene) { return name(scene) == one; });
    if (one == "all") {
      wanted = all;
    } else if (found != all.end()) {
      wanted.push_back(*found);
    } else {
      return fmt::format("unknown family '{}'; accepted: all, {}", one, family_names());
    }
    if (comma == std::string_view::npos) break;
    text.remove_prefix(comma + 1);
  }
  std::vector<Scene> result;
  for (const Scene scene : all) {
    if (std::find(wanted.begin(), wanted.end(), scene) != wanted.end()) result.push_back(scene);
  }
  return result;
}

std::vector<stability::Real> chosen_reals(const std::string& text) {
  using enum stability::Real;
  if (text == "all") return {in_double, in_float};
  return {text == "float" ? in_float : in_double};
}

std::optional<std::string> write(const fs::path& file, const std::string& text) {
  errno = 0;
  std::ofstream stream(file, std::ios::binary);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (stream) return std::nullopt;
  return fmt::format("cannot write {}: {}", file.filename().string(), std::strerror(errno));
}

/// The queries of one type on which a promise was broken, with their truths, as query files.
std::optional<std::string> write_broken(const fs::path& folder, std::span<const stability::BrokenPromise> broken,
                                        stability::Real real) {
  auto created = create_queries(folder / "broken-promises", std::string(name(real)));
  if (const auto* wrong = std::get_if<FileError>(&created)) return wrong->message;
  QueryWriter& writer = *std::get<std::unique_ptr<QueryWriter>>(created);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    QueryBlock block;
    block.kind = kind;
    for (const stability::BrokenPromise& promise : broken) {
      if (promise.kind != kind || promise.real != real) continue;
      block.points.insert(block.points.end(), promise.points.begin(), promise.points.end());
      block.truths.push_back(promise.contact ? 1 : 0);
    }
    if (block.truths.empty()) continue;
    if (const auto wrong = writer.append(block)) return wrong->message;
  }
  if (const auto wrong = writer.commit()) return wrong->message;
  return std::nullopt;
}

std::optional<std::string> write_all(const fs::path& folder, const stability::SweepResult& result) {
  const std::string json = stability::to_json(result.atlas);
  const std::vector<stability::Page> pages = stability::pages(result.atlas);
  if (auto wrong = write(folder / "atlas.json", json)) return wrong;
  if (auto wrong = write(folder / "index.html", stability::index_page(result.atlas, pages, json))) return wrong;
  for (const stability::Page& page : pages) {
    const std::string svg = charts::heat_map_svg(page.maps);
    if (auto wrong = write(folder / (page.file + ".svg"), svg)) return wrong;
  }
  for (const stability::Real real : {stability::Real::in_double, stability::Real::in_float}) {
    const auto of_type = [&](const stability::BrokenPromise& promise) { return promise.real == real; };
    if (std::none_of(result.broken.begin(), result.broken.end(), of_type)) continue;
    if (auto wrong = write_broken(folder, result.broken, real)) return wrong;
  }
  return std::nullopt;
}

/// A line a method and type.
std::string summary(const stability::Atlas& atlas) {
  using stability::Figure;
  constexpr const char* layout = "{:<12} {:<6} {:>10} {:>10} {:>8} {:>13} {:>16} {:>17}\n";
  std::string text = fmt::format(fmt::runtime(layout), "method", "real", "queries", "contacts", "misses",
                                 "false alarms", "uncertain signs", "exact arithmetic");
  for (const stability::Real real : {stability::Real::in_double, stability::Real::in_float}) {
    for (std::size_t m = 0; m < atlas.methods.size(); ++m) {
      std::array<stability::Rate, stability::all_figures.size()> sums;
      std::uint64_t queries = 0;
      for (const stability::Map& map : atlas.maps) {
        if (map.real != real) continue;
        for (const std::uint32_t count : map.queries) queries += count;
        for (std::size_t f = 0; f < sums.size(); ++f) {
          sums[f] += stability::rate(stability::all_figures[f], map, map.methods[m]);
        }
      }
      if (queries == 0) continue;
      text += fmt::format(fmt::runtime(layout), atlas.methods[m].name, name(real), queries, sums[0].of, sums[0].count,
                          percent(sums[1]), percent(sums[2]), percent(sums[3]));
    }
  }
  return text;
}

void tell_broken(const stability::SweepResult& result, const std::string& output) {
  constexpr std::size_t most_lines = 5;
  for (std::size_t i = 0; i < std::min(most_lines, result.broken.size()); ++i) {
    const stability::BrokenPromise& promise = result.broken[i];
    warn(fmt::format("{} in {}, {}: answers {} to a query that has {}", name(promise.method), name(promise.real),
                     name(promise.kind), promise.contact ? "0" : "1", promise.contact ? "contact" : "none"));
  }
  fail(fmt::format("a method broke its promise; queries that show it, {} of them, are in {}/broken-promises",
                   result.broken.size(), output));
}

int run(const StabilityOptions& options) {
  auto methods = chosen_methods(options.methods);
  if (const auto* wrong = std::get_if<std::string>(&methods)) return fail(*wrong);
  auto families = chosen_families(options.families);
  if (const auto* wrong = std::get_if<std::string>(&families)) return fail(*wrong);
  if (options.queries < 1 || options.queries > most_queries) {
    return fail(fmt::format("--queries must be from 1 to {}", most_queries));
  }
  UnfinishedFolder folder(options.output, "atlas.json");
  if (const auto wrong = folder.create()) return fail(*wrong);
  stability::SweepRequest request{.families = std::get<std::vector<Scene>>(std::move(families)),
                                  .kinds = {Kind::vertex_face, Kind::edge_edge},
                                  .methods = std::get<std::vector<Method>>(std::move(methods)),
                                  .reals = chosen_reals(options.real),
                                  .axes = options.axes == "full" ? stability::full_axes() : stability::small_axes(),
                                  .queries = options.queries,
                                  .seed = options.seed};
  if (const auto only = chosen_kind(options.kind)) request.kinds = {*only};
  catch_interrupts();
  std::optional<stability::SweepResult> result;
  {
    Progress progress("stability");
    result = stability::sweep(request, [&](std::uint64_t done, std::uint64_t all) {
      progress.show(done, all);
      return !interrupted();
    });
  }
  if (!result) return fail("interrupted; nothing was written");
  if (const auto wrong = write_all(folder.path(), *result)) return fail(*wrong);
  if (const auto wrong = folder.commit()) return fail(*wrong);
  const int printed = print(summary(result->atlas) + fmt::format("atlas: {}/index.html\n", options.output));
  if (result->broken.empty() || printed != success) return printed;
  tell_broken(*result, options.output);
  return defect;
}

}  // namespace

Subcommand add_stability(CLI::App& app) {
  CLI::App* command = app.add_subcommand("stability", "The atlas of where methods fail around degenerate queries");
  auto options = std::make_shared<StabilityOptions>();
  command
      ->add_option("--method", options->methods, fmt::format("all, or names with commas between: {}", method_names()))
      ->type_name("NAME,..");
  command
      ->add_option("--families", options->families,
                   fmt::format("all, or names with commas between: {}", family_names()))
      ->type_name("NAME,..");
  add_kind(*command, options->kind, "leaves out the other kind");
  command
      ->add_option("--real", options->real,
                   "the type that methods compute in: double, float or all; double if not given")
      ->type_name("REAL")
      ->check(CLI::IsMember({"double", "float", "all"}));
  command
      ->add_option("--axes", options->axes,
                   "full: 11 distances, 9 scales, 5 offsets; small: 5, 3, 2; full if not given")
      ->type_name("AXES")
      ->check(CLI::IsMember({"full", "small"}));
  command->add_option("--queries", options->queries, "in each cell; 50 if not given")->type_name("N");
  command->add_option("--seed", options->seed, "of the queries; 1 if not given")->type_name("S");
  command->add_option("-o,--output", options->output, "a folder: new, empty, or an atlas to be replaced")
      ->type_name("DIR")
      ->required();
  command->footer(
      "Degenerate queries are moved away from their degeneracy (distance), away from the origin (offset) and scaled; "
      "each\n"
      "method's answers are compared with exact arithmetic. Writes DIR/index.html (open it in a browser), a page of "
      "heat\n"
      "maps a method as SVG, and all figures as DIR/atlas.json. Exit status 3: a method that promises to miss no "
      "contact, or\n"
      "to claim none that is not there, broke its promise; DIR/broken-promises then has the queries.");
  return {command, [options] { return run(*options); }};
}

}  // namespace tightrope::ccd
