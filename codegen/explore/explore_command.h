#pragma once
/// `tightrope explore FILE.pred [--predicate NAME] [--emit SCHEME] [-o DIR] ...`.

#include <CLI/CLI.hpp>
#include <string>

namespace tightrope::codegen {

/// The options, as written.
struct ExploreArguments {
  std::string file;
  std::string predicate;
  std::string stage;
  std::string real = "double";
  std::string inputs;
  std::string emit;
  std::string output;
  std::string format = "text";
  std::string flags = "-O3";
  bool no_time = false;
  bool all = false;
  bool tests = false;
};

/// Adds the subcommand, which fills `arguments`.
CLI::App& add_explore_command(CLI::App& app, ExploreArguments& arguments);

/// The command's exit status.
int run_explore(const ExploreArguments& arguments);

}  // namespace tightrope::codegen
