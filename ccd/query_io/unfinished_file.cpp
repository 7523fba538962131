#include "query_io/unfinished_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>
#include <utility>

namespace tightrope::ccd {

UnfinishedFile::UnfinishedFile(std::filesystem::path final_path)
    : final_(std::move(final_path)),
      temporary_(final_.parent_path() / fmt::format(".{}.{}.unfinished", final_.filename().string(), ::getpid())) {}

UnfinishedFile::UnfinishedFile(UnfinishedFile&& other) noexcept
    : final_(std::move(other.final_)), temporary_(std::exchange(other.temporary_, {})) {}

UnfinishedFile::~UnfinishedFile() {
  std::error_code ignored;
  if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

std::optional<FileError> UnfinishedFile::commit() {
  std::error_code error;
  std::filesystem::rename(temporary_, final_, error);
  if (error) return FileError{fmt::format("{}: {}", final_.string(), error.message())};
  temporary_.clear();
  return std::nullopt;
}

}  // namespace tightrope::ccd
