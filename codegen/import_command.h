#pragma once
/// `tightrope import FILE.cpp --function NAME [-o FILE.pred] [-- FLAGS]`.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace tightrope::codegen {

/// The options, as written.
struct ImportArguments {
  std::string file;
  std::string function;
  std::string output;  ///< empty: standard output
  std::vector<std::string> flags;
};

/// Adds the subcommand, which fills `arguments`.
CLI::App& add_import_command(CLI::App& app, ImportArguments& arguments);

/// The command's exit status.
int run_import(const ImportArguments& arguments);

}  // namespace tightrope::codegen
