#include "command/build_fit.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <deque>
#include <fstream>

namespace tightrope::ccd {
namespace {

/// Runs a program found on PATH and gives its exit status, -1 if it did not run. Its output goes to `log`, if not
/// empty.
int run(std::vector<std::string> command, const std::filesystem::path& log) {
  std::vector<char*> arguments;
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (!log.empty()) {
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  }
  pid_t child = 0;
  const int wrong = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (wrong != 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status)) return -1;
  return WEXITSTATUS(status);
}

std::string last_lines(const std::filesystem::path& log) {
  constexpr std::size_t most = 12;
  std::deque<std::string> lines;
  std::ifstream file(log);
  for (std::string line; std::getline(file, line);) {
    lines.push_back(line);
    if (lines.size() > most) lines.pop_front();
  }
  std::string text;
  for (const std::string& line : lines) text += "\n  " + line;
  return text;
}

}  // namespace

FitBuild::FitBuild(const std::filesystem::path& folder, std::string name, std::string prefix)
    : folder_(folder), path_(folder / "build"), name_(std::move(name)), prefix_(std::move(prefix)) {
  if (!prefix_.empty()) return;
  std::error_code wrong;
  const auto command = std::filesystem::read_symlink("/proc/self/exe", wrong);
  if (!wrong) prefix_ = command.parent_path().parent_path().string();
}

std::optional<std::string> FitBuild::run_build() const {
  const auto log = folder_ / "build.log";
  std::error_code wrong;
  std::filesystem::create_directories(path_, wrong);
  const int configured = run({"cmake", "-S", folder_.string(), "-B", path_.string(), "-DCMAKE_BUILD_TYPE=Release",
                              "-DCMAKE_PREFIX_PATH=" + std::filesystem::absolute(prefix_, wrong).string()},
                             log);
  if (configured == 127 || configured == -1) return "--build needs the command cmake, which is not found";
  if (configured != 0) {
    return fmt::format("cmake cannot configure {} (is Tightrope installed in {}? --prefix names another place):{}",
                       folder_.string(), prefix_, last_lines(log));
  }
  if (run({"cmake", "--build", path_.string()}, log) != 0) {
    return fmt::format("cmake cannot build {}:{}", folder_.string(), last_lines(log));
  }
  return std::nullopt;
}

bool FitBuild::run_check(const std::vector<std::string>& arguments) const {
  std::vector<std::string> command{(path_ / (name_ + "_check")).string()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return run(command, {}) == 0;
}

}  // namespace tightrope::ccd
