#pragma once
/// A line on stderr that counts, if stderr is a terminal.

#include <chrono>
#include <cstdint>
#include <string>

namespace tightrope::ccd {

class Progress {
 public:
  explicit Progress(std::string what);  ///< empty: nothing is shown
  ~Progress();                          ///< clears the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `total` 0: unknown.
  void show(std::uint64_t done, std::uint64_t total = 0);

 private:
  std::string what_;
  bool terminal_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace tightrope::ccd
