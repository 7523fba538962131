#pragma once
/// Options that several subcommands have.

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tightrope/ccd.h"

namespace tightrope::ccd {

/// --kind vertex-face|edge-edge
CLI::Option* add_kind(CLI::App& app, std::string& text, const std::string& help);
std::optional<Kind> chosen_kind(std::string_view text);  ///< empty text: none

/// --format, one of `accepted`, the first of them by default
CLI::Option* add_format(CLI::App& app, std::string& text, const std::vector<std::string>& accepted);

/// "all" or names with commas between, each once, in the order given; or what is wrong.
std::variant<std::vector<Method>, std::string> chosen_methods(std::string_view text);

std::string method_names();  ///< "bsc-float, bsc-safe, tight"

}  // namespace tightrope::ccd
