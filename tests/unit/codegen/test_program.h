#pragma once
/// Programs for tests, from text.

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "dsl/program.h"

namespace tightrope::testing_support {

/// A folder of its own, removed at the end.
class ScratchFolder {
 public:
  ScratchFolder() {
    static std::atomic<int> count = 0;
    const std::string name = "tightrope_test_" + std::to_string(::getpid()) + "_" + std::to_string(count++);
    path_ = std::filesystem::temp_directory_path() / name;
    std::filesystem::create_directories(path_);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The program of a text that must be correct.
inline dsl::Program program(const std::string& text) {
  const ScratchFolder folder;
  dsl::SourceMap sources;
  dsl::Diagnostics diagnostics;
  dsl::Program result = dsl::load_program(folder.write("test.pred", text).string(), sources, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.render(sources);
  return result;
}

}  // namespace tightrope::testing_support
