#pragma once
/// Output folders that appear whole or not at all.

#include <filesystem>
#include <optional>
#include <string>

namespace tightrope::ccd {

/// A temporary folder beside its final place; commit() moves it there, the destructor removes it if that did not
/// happen.
class UnfinishedFolder {
 public:
  /// A folder that is there already may be replaced if it is empty or holds the file `mark`.
  UnfinishedFolder(const std::filesystem::path& final_path, std::string mark);
  ~UnfinishedFolder();
  UnfinishedFolder(const UnfinishedFolder&) = delete;
  UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;

  /// Makes the temporary folder; or what is wrong, in one line.
  [[nodiscard]] std::optional<std::string> create();

  const std::filesystem::path& path() const { return temporary_; }  ///< write here

  /// Replaces the folder that was there.
  [[nodiscard]] std::optional<std::string> commit();

 private:
  std::filesystem::path final_;
  std::filesystem::path temporary_;
  std::string mark_;
};

}  // namespace tightrope::ccd
