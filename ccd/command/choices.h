#pragma once
/// Options that several subcommands have.

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "command/device.h"
#include "tightrope/ccd.h"

namespace tightrope::ccd {

/// --kind vertex-face|edge-edge
CLI::Option* add_kind(CLI::App& app, std::string& text, const std::string& help);
std::optional<Kind> chosen_kind(std::string_view text);  ///< empty text: none

/// --format, one of `accepted`, the first of them by default
CLI::Option* add_format(CLI::App& app, std::string& text, const std::vector<std::string>& accepted);

/// "all" or names with commas between, each once, in the order given; or what is wrong.
std::variant<std::vector<Method>, std::string> chosen_methods(std::string_view text);

/// --threads N and --instructions NAME as they were given; --device cpu|gpu too where a command has it.
struct ExecutionChoice {
  int threads = 1;  ///< 0: as many as there are processors
  std::string instructions;
  std::string device = "cpu";
};
void add_execution(CLI::App& app, ExecutionChoice& choice);
void add_device(CLI::App& app, ExecutionChoice& choice);

/// Or what is wrong: an instruction set or a device that this build or this machine does not have.
std::variant<Execution, std::string> chosen_execution(const ExecutionChoice& choice);

std::string method_names();  ///< "bsc-float, bsc-safe, tight"

}  // namespace tightrope::ccd
