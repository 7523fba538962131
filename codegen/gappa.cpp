#include "codegen/gappa.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

extern char** environ;

namespace tightrope::codegen {
namespace {

/// "-3b-47" is -3 * 2^-47; without `b` a whole number. Empty if it is no such number.
std::optional<double> dyadic(const std::string& text) {
  std::size_t used = 0;
  try {
    const double mantissa = std::stod(text, &used);
    if (used == text.size()) return mantissa;
    if (text[used] != 'b') return std::nullopt;
    return std::ldexp(mantissa, std::stoi(text.substr(used + 1)));
  } catch (const std::logic_error&) {  // what stod and stoi throw
    return std::nullopt;
  }
}

/// The largest magnitude in "[-3b-47 {..}, 3b-47 {..}]". A mantissa beyond 2^53 is rounded: one ulp on top.
std::optional<double> largest(const std::string& interval) {
  double result = 0;
  std::size_t begin = interval.find('[');
  if (begin == std::string::npos) return std::nullopt;
  for (int end = 0; end < 2; ++end) {
    const std::size_t first = interval.find_first_not_of(" [", begin);
    if (first == std::string::npos) return std::nullopt;
    const std::size_t last = interval.find_first_of(" ,]{", first);
    const auto value = dyadic(interval.substr(first, last - first));
    if (!value) return std::nullopt;
    const bool rounded = last - first > 17;
    result = std::max(result, rounded ? std::nextafter(std::abs(*value), INFINITY) : std::abs(*value));
    if (end == 1) break;
    const std::size_t brace = interval.find('}', last);
    begin = interval.find(',', interval[last] == ',' || brace == std::string::npos ? last : brace);
    if (begin == std::string::npos) return std::nullopt;
    ++begin;
  }
  return result;
}

/// Waits for a child, which is killed when its time is over: its exit status, or empty.
std::optional<int> wait_for(pid_t child, double seconds) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  int status = 0;
  for (;;) {
    if (waitpid(child, &status, WNOHANG) == child) return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    if (std::chrono::steady_clock::now() > deadline) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  return std::nullopt;
}

}  // namespace

std::string find_program(const std::string& name) {
  if (name.find('/') != std::string::npos) return access(name.c_str(), X_OK) == 0 ? name : "";
  const char* path = std::getenv("PATH");
  std::stringstream folders(path == nullptr ? "" : path);
  std::string folder;
  while (std::getline(folders, folder, ':')) {
    const std::string candidate = folder + "/" + name;
    if (!folder.empty() && access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  return "";
}

GappaAnswer read_gappa_answer(const std::string& text, int exit_status) {
  GappaAnswer answer;
  answer.status = exit_status == 0 ? GappaAnswer::Status::proved : GappaAnswer::Status::failed;
  std::stringstream lines(text);
  std::string line;
  bool unproved = false;
  while (std::getline(lines, line)) {
    const std::size_t in = line.find(" in [");
    if (in != std::string::npos && !unproved) answer.found = largest(line.substr(in + 4));
    if (line.find("some properties were not satisfied") != std::string::npos) {
      unproved = true;
      answer.status = GappaAnswer::Status::not_proved;
    } else if (unproved) {
      answer.unproved += line + "\n";
    }
  }
  // Every script asks for the bound that Gappa finds itself: a proof without it is no answer of Gappa's.
  if (answer.status == GappaAnswer::Status::proved && !answer.found) answer.status = GappaAnswer::Status::failed;
  return answer;
}

GappaAnswer run_gappa(const std::string& program, const std::string& script, const std::string& log, double seconds) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  std::string arguments[] = {program, script};
  char* argv[] = {arguments[0].data(), arguments[1].data(), nullptr};
  pid_t child = 0;
  const int error = posix_spawn(&child, program.c_str(), &actions, nullptr, argv, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return {};
  const std::optional<int> status = wait_for(child, seconds);
  if (!status) return {GappaAnswer::Status::timed_out, std::nullopt, ""};
  std::ifstream stream(log);
  std::stringstream text;
  text << stream.rdbuf();
  return read_gappa_answer(text.str(), *status);
}

}  // namespace tightrope::codegen
