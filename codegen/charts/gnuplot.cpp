#include "codegen/charts/gnuplot.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

extern char** environ;

namespace tightrope::charts {
namespace {

namespace fs = std::filesystem;

/// A folder of our own, removed with all that lies in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::error_code error;
    std::string name = (fs::temp_directory_path(error) / "tightrope-chart-XXXXXX").string();
    if (!error && ::mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const fs::path& path() const { return path_; }  ///< empty: there is none

 private:
  fs::path path_;
};

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Runs `program -d script`; what it prints goes to the files `out` and `log`. Its exit status, or -1.
int run(const std::string& program, const std::string& script, const std::string& out, const std::string& log) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  std::string arguments[] = {program, "-d", script};  // -d: none of the user's own settings
  char* argv[] = {arguments[0].data(), arguments[1].data(), arguments[2].data(), nullptr};
  pid_t child = 0;
  const int error = posix_spawn(&child, program.c_str(), &actions, nullptr, argv, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return -1;
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return -1;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// The last line with something on it: gnuplot repeats the command first, then says what is wrong with it.
std::string last_line(const std::string& text) {
  std::stringstream lines(text);
  std::string line;
  std::string last = "it said nothing";
  while (std::getline(lines, line)) {
    if (line.find_first_not_of(" \t^") != std::string::npos) last = line;
  }
  return last;
}

}  // namespace

std::string find_gnuplot() {
  const char* path = std::getenv("PATH");
  std::stringstream folders(path == nullptr ? "" : path);
  std::string folder;
  while (std::getline(folders, folder, ':')) {
    const std::string candidate = folder + "/gnuplot";
    if (!folder.empty() && ::access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  return "";
}

std::variant<std::string, Failure> draw(const Chart& chart, const Layout& layout, Terminal terminal) {
  const std::string program = find_gnuplot();
  if (program.empty()) return Failure{"gnuplot, which draws charts, is not installed (Debian package gnuplot-nox)"};
  const TemporaryFolder folder;
  if (folder.path().empty()) return Failure{fmt::format("no temporary folder: {}", std::strerror(errno))};
  const std::string script = (folder.path() / "chart.gp").string();
  const std::string picture = (folder.path() / "chart").string();
  const std::string log = (folder.path() / "log").string();
  std::ofstream(script, std::ios::binary) << gnuplot_script(chart, layout, terminal);
  const int status = run(program, script, picture, log);
  std::string bytes = content(picture);
  if (status != 0 || bytes.empty()) return Failure{"gnuplot failed: " + last_line(content(log))};
  return bytes;
}

}  // namespace tightrope::charts
