#pragma once
/// The subcommands. Each adds itself to the command line and gives back what to run if it is chosen; running returns
/// the exit status: 0; 2 when something was wrong with the usage or with a file (one line on stderr then tells); 1 when
/// a check was asked for and failed.

#include <CLI/CLI.hpp>
#include <functional>
#include <string_view>

namespace tightrope::ccd {

inline constexpr int success = 0;
inline constexpr int bad_usage = 2;
inline constexpr int promise_broken = 1;  ///< only where the exact truth was asked to be compared with

struct Subcommand {
  CLI::App* app;
  std::function<int()> run;
  bool shares_queries = false;  ///< among the processes that an MPI launcher started
};

Subcommand add_methods(CLI::App& app);
Subcommand add_evaluate(CLI::App& app);
Subcommand add_classify(CLI::App& app);
Subcommand add_toi(CLI::App& app);
Subcommand add_stages(CLI::App& app);
Subcommand add_generate(CLI::App& app);
Subcommand add_exact(CLI::App& app);
Subcommand add_stability(CLI::App& app);
Subcommand add_fit(CLI::App& app);

/// "tightrope-ccd: error: ..." on stderr; gives bad_usage back. Of several processes only the first prints.
int fail(std::string_view message);
void warn(std::string_view message);

/// Writes all of `text` to stdout and gives success back, or fails.
int print(std::string_view text);

}  // namespace tightrope::ccd
