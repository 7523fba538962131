#pragma once
/// Output that is held back until all of it is known.

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace tightrope::ccd {

/// Text in order: in memory while it is short, then in an unnamed temporary file, which ends with the process.
class Spool {
 public:
  /// What went wrong, if anything did ("..: No space left on device"); empty: nothing.
  [[nodiscard]] std::string append(std::string_view text);

  /// Writes everything to stdout and gives the exit status back, as print() of command.h.
  int print();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  [[nodiscard]] std::string write_out();

  std::string text_;  ///< what is not in the file yet
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace tightrope::ccd
