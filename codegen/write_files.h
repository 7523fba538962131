#pragma once
/// Writing all files of one run of the command, or none.

#include <filesystem>
#include <span>
#include <string>

namespace tightrope::codegen {

struct TextFile {
  std::filesystem::path path;
  std::string text;
};

/// Writes every file, to a temporary name beside it first, then renames all; makes missing folders. Returns "" or,
/// after removing whatever was written, one line on what failed.
std::string write_files(std::span<const TextFile> files);

}  // namespace tightrope::codegen
