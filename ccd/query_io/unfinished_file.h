#pragma once
/// Output files that appear whole or not at all.

#include <filesystem>
#include <optional>

#include "query_io/query_block.h"

namespace tightrope::ccd {

/// A temporary file beside its final place; commit() moves it there, the destructor removes it if that did not happen.
class UnfinishedFile {
 public:
  explicit UnfinishedFile(std::filesystem::path final_path);
  ~UnfinishedFile();
  UnfinishedFile(UnfinishedFile&& other) noexcept;
  UnfinishedFile& operator=(UnfinishedFile&&) = delete;
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  const std::filesystem::path& path() const { return temporary_; }  ///< write here
  const std::filesystem::path& final_path() const { return final_; }

  /// To be called when the file is written and closed. Replaces a file that was there.
  [[nodiscard]] std::optional<FileError> commit();

 private:
  std::filesystem::path final_;
  std::filesystem::path temporary_;  ///< empty when committed or moved from
};

}  // namespace tightrope::ccd
