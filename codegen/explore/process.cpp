#include "codegen/explore/process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <system_error>
#include <thread>

extern char** environ;

namespace tightrope::codegen::explore {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
  std::string name = (fs::temp_directory_path() / "tightrope_explore_XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw fs::filesystem_error("cannot make a temporary folder", name, std::error_code(errno, std::generic_category()));
  }
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

namespace {

/// The process, or -1.
pid_t start(const Command& command) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, command.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  std::vector<std::string> words = command.words;
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t child = -1;
  const int error = posix_spawn(&child, words.front().c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return error == 0 ? child : -1;
}

/// Waits for one of these children, which leaves the map: the command, and whether it exited with status 0.
std::pair<std::size_t, bool> wait_for_one(std::map<pid_t, std::size_t>& running) {
  const auto child = running.begin();
  const std::size_t command = child->second;
  int status = 0;
  while (::waitpid(child->first, &status, 0) < 0 && errno == EINTR) {
  }
  running.erase(child);
  return {command, WIFEXITED(status) && WEXITSTATUS(status) == 0};
}

}  // namespace

int run_all(const std::vector<Command>& commands) {
  const std::size_t at_once = std::max(1U, std::thread::hardware_concurrency());
  std::map<pid_t, std::size_t> running;
  int failed = -1;
  const auto note = [&](std::size_t command, bool succeeded) {
    const int index = static_cast<int>(command);
    if (!succeeded && (failed < 0 || index < failed)) failed = index;
  };
  for (std::size_t next = 0; next < commands.size() || !running.empty();) {
    if (next < commands.size() && failed < 0 && running.size() < at_once) {
      const pid_t child = start(commands[next]);
      if (child > 0) {
        running.emplace(child, next);
      } else {
        note(next, false);
      }
      ++next;
    } else if (!running.empty()) {
      const auto [command, succeeded] = wait_for_one(running);
      note(command, succeeded);
    } else {
      break;  // the rest is not started after a failure
    }
  }
  return failed;
}

std::string file_text(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace tightrope::codegen::explore
