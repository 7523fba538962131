#include "query_io/hdf5_guard.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>

namespace tightrope::ccd::hdf5 {
namespace {

// A signal handler has no arguments of ours.
std::atomic<const std::string*> current{nullptr};
static_assert(decltype(current)::is_always_lock_free);

void tell_and_exit(int) {
  constexpr int wrong_file = 2;  // as for every file that cannot be read
  if (const std::string* message = current.load()) {
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message->data(), message->size());
  }
  ::_exit(wrong_file);
}

}  // namespace

CrashGuard::CrashGuard(const std::filesystem::path& path)
    : message_(
          fmt::format("tightrope-ccd: error: {}: damaged, so that the HDF5 library cannot read it\n", path.string())) {
  current.store(&message_);
  struct sigaction action {};
  action.sa_handler = tell_and_exit;
  ::sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < signals.size(); ++i) ::sigaction(signals[i], &action, &before_[i]);
}

CrashGuard::~CrashGuard() {
  for (std::size_t i = 0; i < signals.size(); ++i) ::sigaction(signals[i], &before_[i], nullptr);
  current.store(nullptr);
}

}  // namespace tightrope::ccd::hdf5
