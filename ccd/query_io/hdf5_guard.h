#pragma once
/// What the HDF5 library itself does wrong on damaged files.

#include <array>
#include <csignal>
#include <filesystem>
#include <string>

namespace tightrope::ccd::hdf5 {

/// While it lives, a crash of the process is an error of the file: one line on stderr and exit status 2. For around
/// HDF5 calls, in one thread at a time: HDF5 1.10 divides by zero, or reads where nothing is, on some files whose
/// structures were damaged and have no checksums, and offers no way to find out before.
class CrashGuard {
 public:
  explicit CrashGuard(const std::filesystem::path& path);
  ~CrashGuard();
  CrashGuard(const CrashGuard&) = delete;
  CrashGuard& operator=(const CrashGuard&) = delete;

 private:
  static constexpr std::array signals = {SIGSEGV, SIGFPE, SIGBUS, SIGABRT};
  std::string message_;
  std::array<struct sigaction, signals.size()> before_{};
};

}  // namespace tightrope::ccd::hdf5
