#pragma once
/// Other programs, and a folder for what they read and write.

#include <filesystem>
#include <string>
#include <vector>

namespace tightrope::codegen::explore {

/// A folder of its own below the system's temporary one, removed with all in it at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();  ///< throws std::filesystem::filesystem_error
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A program (a path) with its arguments, and the file for all that it prints.
struct Command {
  std::vector<std::string> words;
  std::filesystem::path log;
};

/// Runs the commands, as many at once as the machine has processors. Returns the index of the first that did not exit
/// with status 0, or -1.
int run_all(const std::vector<Command>& commands);

std::string file_text(const std::filesystem::path& path);

}  // namespace tightrope::codegen::explore
