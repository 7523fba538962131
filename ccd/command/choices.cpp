#include "command/choices.h"

#include <fmt/format.h>

#include <algorithm>

namespace tightrope::ccd {

CLI::Option* add_kind(CLI::App& app, std::string& text, const std::string& help) {
  return app.add_option("--kind", text, help)
      ->type_name("KIND")
      ->check(CLI::IsMember({std::string(name(Kind::vertex_face)), std::string(name(Kind::edge_edge))}));
}

std::optional<Kind> chosen_kind(std::string_view text) {
  if (text == name(Kind::vertex_face)) return Kind::vertex_face;
  if (text == name(Kind::edge_edge)) return Kind::edge_edge;
  return std::nullopt;
}

CLI::Option* add_format(CLI::App& app, std::string& text, const std::vector<std::string>& accepted) {
  text = accepted.front();
  return app.add_option("--format", text, fmt::format("{}; {} if not given", fmt::join(accepted, ", "), text))
      ->type_name("FORMAT")
      ->check(CLI::IsMember(accepted));
}

std::variant<std::vector<Method>, std::string> chosen_methods(std::string_view text) {
  std::vector<Method> chosen;
  const auto add = [&](Method method) {
    if (std::find(chosen.begin(), chosen.end(), method) == chosen.end()) chosen.push_back(method);
  };
  while (true) {
    const std::size_t comma = text.find(',');
    const std::string_view wanted = text.substr(0, comma);
    if (wanted == "all") {
      for (const MethodInfo& info : methods()) add(info.method);
    } else if (const auto method = method_by_name(wanted)) {
      add(*method);
    } else {
      return fmt::format("unknown method '{}'; accepted: all, {}", wanted, method_names());
    }
    if (comma == std::string_view::npos) return chosen;
    text.remove_prefix(comma + 1);
  }
}

std::string method_names() {
  std::string names;
  for (const MethodInfo& info : methods()) names += fmt::format("{}{}", names.empty() ? "" : ", ", info.name);
  return names;
}

}  // namespace tightrope::ccd
