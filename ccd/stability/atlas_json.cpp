#include "stability/atlas_json.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

namespace tightrope::ccd::stability {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* format_name = "tightrope stability atlas, 1";

struct Field {
  const char* name;
  Counts MethodCounts::*counts;
};
constexpr std::array<Field, 6> fields = {{{"misses", &MethodCounts::misses},
                                          {"false_alarms", &MethodCounts::false_alarms},
                                          {"uncertain", &MethodCounts::uncertain},
                                          {"signs", &MethodCounts::signs},
                                          {"uncertain_signs", &MethodCounts::uncertain_signs},
                                          {"exact", &MethodCounts::exact}}};

std::string text(const Counts& counts) { return fmt::format("[{}]", fmt::join(counts, ",")); }

std::string json_string(std::string_view text) { return Json(text).dump(); }

std::string axes_text(const Axes& axes) {
  std::vector<int> of_float;
  for (const int scale : axes.scales) of_float.push_back(scale_exponent(scale, Real::in_float));
  return fmt::format(
      "  \"axes\": {{\n    \"offset\": [{}],\n    \"distance\": [{}],\n"
      "    \"scale_exponent\": {{\"double\": [{}], \"float\": [{}]}}\n  }},\n",
      fmt::join(axes.offsets, ", "), fmt::join(axes.distances, ", "), fmt::join(axes.scales, ", "),
      fmt::join(of_float, ", "));
}

std::string method_text(const MethodCounts& method) {
  std::string result = fmt::format("      {}: {{", json_string(method.method));
  const char* separator = "\n";
  for (const Field& field : fields) {
    const Counts& counts = method.*field.counts;
    if (counts.empty()) continue;
    result += fmt::format("{}        {}: {}", separator, json_string(field.name), text(counts));
    separator = ",\n";
  }
  return result + "\n      }";
}

std::string map_text(const Map& map) {
  std::string result = fmt::format("    {{\"family\": {}, \"kind\": {}, \"real\": {},\n", json_string(map.family),
                                   json_string(name(map.kind)), json_string(name(map.real)));
  result += fmt::format("      \"queries\": {},\n      \"contacts\": {},\n      \"methods\": {{\n", text(map.queries),
                        text(map.contacts));
  for (std::size_t m = 0; m < map.methods.size(); ++m) {
    result += method_text(map.methods[m]) + (m + 1 < map.methods.size() ? ",\n" : "\n");
  }
  return result + "    }}";
}

Counts counts_of(const Json& json, std::size_t cells) {
  auto counts = json.get<Counts>();
  if (counts.size() != cells) throw std::runtime_error("a list of counts has not one a cell");
  return counts;
}

Map map_of(const Json& json, std::size_t cells) {
  Map map;
  map.family = json.at("family").get<std::string>();
  map.kind = json.at("kind") == name(Kind::vertex_face) ? Kind::vertex_face : Kind::edge_edge;
  map.real = json.at("real") == name(Real::in_double) ? Real::in_double : Real::in_float;
  map.queries = counts_of(json.at("queries"), cells);
  map.contacts = counts_of(json.at("contacts"), cells);
  for (const auto& [method, counts] : json.at("methods").items()) {
    MethodCounts& added = map.methods.emplace_back();
    added.method = method;
    for (const Field& field : fields) {
      if (counts.contains(field.name)) added.*field.counts = counts_of(counts.at(field.name), cells);
    }
  }
  return map;
}

}  // namespace

std::string to_json(const Atlas& atlas) {
  std::string result = fmt::format("{{\n  \"format\": {},\n  \"seed\": {},\n  \"queries_per_cell\": {},\n",
                                   json_string(format_name), atlas.seed, atlas.queries);
  result += axes_text(atlas.axes) + "  \"families\": [\n";
  for (std::size_t i = 0; i < atlas.families.size(); ++i) {
    result += fmt::format("    {{\"name\": {}, \"what\": {}}}{}\n", json_string(atlas.families[i].name),
                          json_string(atlas.families[i].what), i + 1 < atlas.families.size() ? "," : "");
  }
  result += "  ],\n  \"methods\": [\n";
  for (std::size_t m = 0; m < atlas.methods.size(); ++m) {
    const AtlasMethod& method = atlas.methods[m];
    result += fmt::format("    {{\"name\": {}, \"conservative\": {}, \"exact\": {}}}{}\n", json_string(method.name),
                          method.conservative, method.exact, m + 1 < atlas.methods.size() ? "," : "");
  }
  result += "  ],\n  \"maps\": [\n";
  for (std::size_t i = 0; i < atlas.maps.size(); ++i) {
    result += map_text(atlas.maps[i]) + (i + 1 < atlas.maps.size() ? ",\n" : "\n");
  }
  return result + "  ]\n}\n";
}

std::variant<Atlas, NoAtlas> atlas_from_json(std::string_view text) {
  try {
    const Json json = Json::parse(text);
    if (json.at("format") != format_name) return NoAtlas{"no stability atlas, or one of another version"};
    Atlas atlas;
    atlas.seed = json.at("seed").get<std::uint64_t>();
    atlas.queries = json.at("queries_per_cell").get<std::size_t>();
    const Json& axes = json.at("axes");
    atlas.axes = {.distances = axes.at("distance").get<std::vector<double>>(),
                  .scales = axes.at("scale_exponent").at("double").get<std::vector<int>>(),
                  .offsets = axes.at("offset").get<std::vector<double>>()};
    for (const Json& family : json.at("families")) {
      atlas.families.push_back({family.at("name").get<std::string>(), family.at("what").get<std::string>()});
    }
    for (const Json& method : json.at("methods")) {
      atlas.methods.push_back({method.at("name").get<std::string>(), method.at("conservative").get<bool>(),
                               method.at("exact").get<bool>()});
    }
    for (const Json& map : json.at("maps")) atlas.maps.push_back(map_of(map, atlas.axes.cells()));
    return atlas;
  } catch (const std::exception& error) {
    return NoAtlas{error.what()};
  }
}

}  // namespace tightrope::ccd::stability
