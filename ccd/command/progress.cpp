#include "command/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

namespace tightrope::ccd {

Progress::Progress(std::string what)
    : what_(std::move(what)),
      terminal_(!what_.empty() && ::isatty(STDERR_FILENO) == 1),
      next_(std::chrono::steady_clock::now()) {}

Progress::~Progress() {
  if (shown_) fmt::print(stderr, "\r\033[K");
}

void Progress::show(std::uint64_t done, std::uint64_t total) {
  const auto now = std::chrono::steady_clock::now();
  if (!terminal_ || now < next_) return;
  next_ = now + std::chrono::milliseconds(200);
  shown_ = true;
  if (total > 0) {
    fmt::print(stderr, "\r{}: {} of {} queries", what_, done, total);
  } else {
    fmt::print(stderr, "\r{}: {} queries", what_, done);
  }
  std::fflush(stderr);
}

}  // namespace tightrope::ccd
