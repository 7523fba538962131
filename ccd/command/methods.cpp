#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "command/choices.h"
#include "command/command.h"

namespace tightrope::ccd {
namespace {

std::string methods_table() {
  constexpr const char* layout = "{:<12} {:<12} {:<14} {:<12} {}\n";
  std::string text = fmt::format(fmt::runtime(layout), "method", "bound", "may miss", "may add", "source");
  for (const MethodInfo& info : methods()) {
    text += fmt::format(fmt::runtime(layout), info.name, info.bound, info.conservative ? "never" : "collisions",
                        info.exact ? "never" : "collisions", info.source);
  }
  return text;
}

std::string methods_json() {
  auto array = nlohmann::ordered_json::array();
  for (const MethodInfo& info : methods()) {
    array.push_back({{"name", info.name},
                     {"bound", info.bound},
                     {"conservative", info.conservative},
                     {"exact", info.exact},
                     {"kinds", {name(Kind::vertex_face), name(Kind::edge_edge)}},
                     {"reals", {"double", "float"}},
                     {"devices", {"cpu"}},
                     {"source", info.source}});
  }
  return array.dump(2) + "\n";
}

}  // namespace

Subcommand add_methods(CLI::App& app) {
  CLI::App* command = app.add_subcommand("methods", "List the methods");
  auto format = std::make_shared<std::string>();
  add_format(*command, *format, {"table", "json"});
  return {command, [format] { return print(*format == "json" ? methods_json() : methods_table()); }};
}

}  // namespace tightrope::ccd
