/// tightrope-ccd: continuous collision detection on query files.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "command/command.h"
#include "command/mpi.h"

namespace tightrope::ccd {

int fail(std::string_view message) {
  if (mpi::is_first()) fmt::print(stderr, "tightrope-ccd: error: {}\n", message);
  return bad_usage;
}

void warn(std::string_view message) {
  if (mpi::is_first()) fmt::print(stderr, "tightrope-ccd: warning: {}\n", message);
}

int print(std::string_view text) {
  if (!mpi::is_first()) return success;
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  return written ? success : fail("cannot write to standard output");
}

namespace {

/// "--method, --truth, .." of a command line without subcommand chosen: the subcommands.
std::string accepted(const CLI::App& app) {
  std::string names;
  const auto add = [&](const std::string& name) { names += (names.empty() ? "" : ", ") + name; };
  const auto chosen = app.get_subcommands();
  if (chosen.empty()) {
    for (const CLI::App* command : app.get_subcommands({})) add(command->get_name());
    return "commands: " + names;
  }
  for (const CLI::Option* option : chosen.front()->get_options()) add(option->get_name());
  return fmt::format("accepted by {}: {}", chosen.front()->get_name(), names);
}

int tell_parse_error(const CLI::App& app, const CLI::ParseError& error) {
  std::string what = error.what();
  for (char& c : what) {
    if (c == '\n') c = ' ';
  }
  const bool unknown = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError);
  if (unknown || app.get_subcommands().empty()) what += "; " + accepted(app);
  return fail(what);
}

int run(int argc, const char* const* argv) {
  CLI::App app("Continuous collision detection with derived error bounds", "tightrope-ccd");
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("tightrope-ccd ") + TIGHTROPE_VERSION);
  const std::vector<Subcommand> commands = {add_methods(app), add_evaluate(app),  add_classify(app),
                                            add_toi(app),     add_stages(app),    add_generate(app),
                                            add_exact(app),   add_stability(app), add_fit(app)};
  const std::string_view first = argc > 1 ? argv[1] : "-";
  const auto called = [&](const Subcommand& command) { return command.app->get_name() == first; };
  if (!first.starts_with('-') && std::none_of(commands.begin(), commands.end(), called)) {
    return fail(fmt::format("unknown command '{}'; {}", first, accepted(app)));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == success) return mpi::is_first() ? app.exit(error) : success;  // --help, --version
    return tell_parse_error(app, error);
  }
  if (const std::string fault = mpi::fault(); !fault.empty()) return fail(fault);
  for (const Subcommand& command : commands) {
    if (!command.app->parsed()) continue;
    if (!command.shares_queries && mpi::processes()->count() > 1) {
      return fail(fmt::format("{} is for one process; several can share only evaluate", command.app->get_name()));
    }
    return command.run();
  }
  return fail("no command");
}

}  // namespace
}  // namespace tightrope::ccd

int main(int argc, char** argv) {
  const tightrope::ccd::mpi::Session session;
  return tightrope::ccd::run(argc, argv);
}
