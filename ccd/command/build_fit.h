#pragma once
/// Builds the folder that a fit has written, with the CMake that is found at run time.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tightrope::ccd {

class FitBuild {
 public:
  /// prefix: where Tightrope is installed; empty: where this command is.
  FitBuild(const std::filesystem::path& folder, std::string name, std::string prefix);

  const std::filesystem::path& path() const { return path_; }  ///< the build folder

  /// Configures and builds; or what is wrong, with the last lines that CMake printed.
  [[nodiscard]] std::optional<std::string> run_build() const;

  /// Runs the check program, which prints; false: it found a difference, or could not run.
  [[nodiscard]] bool run_check(const std::vector<std::string>& arguments) const;

 private:
  std::filesystem::path folder_;
  std::filesystem::path path_;
  std::string name_;
  std::string prefix_;
};

}  // namespace tightrope::ccd
