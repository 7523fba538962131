#include "command/unfinished_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>
#include <utility>

namespace tightrope::ccd {
namespace {

namespace fs = std::filesystem;

/// Without a separator at its end: "here/" is "here".
fs::path plain(const fs::path& path) {
  const fs::path normal = fs::absolute(path).lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

fs::path beside(const fs::path& path, const char* what) {
  return path.parent_path() / fmt::format(".{}.{}.{}", path.filename().string(), ::getpid(), what);
}

}  // namespace

UnfinishedFolder::UnfinishedFolder(const fs::path& final_path, std::string mark)
    : final_(plain(final_path)), temporary_(beside(final_, "unfinished")), mark_(std::move(mark)) {}

UnfinishedFolder::~UnfinishedFolder() {
  std::error_code ignored;
  fs::remove_all(temporary_, ignored);
}

std::optional<std::string> UnfinishedFolder::create() {
  std::error_code error;
  if (fs::exists(final_, error)) {
    if (!fs::is_directory(final_, error)) return fmt::format("{}: is no folder", final_.string());
    if (!fs::is_empty(final_, error) && !fs::exists(final_ / mark_, error)) {
      return fmt::format("{}: has other files in it, and no {}", final_.string(), mark_);
    }
  }
  fs::create_directory(temporary_, error);
  if (error) return fmt::format("{}: {}", final_.string(), error.message());
  return std::nullopt;
}

std::optional<std::string> UnfinishedFolder::commit() {
  std::error_code error;
  std::error_code ignored;
  const fs::path old = beside(final_, "old");
  const bool replaces = fs::exists(final_, error);
  if (replaces) fs::rename(final_, old, error);
  if (!error) fs::rename(temporary_, final_, error);
  if (error) {
    const std::string message = fmt::format("{}: {}", final_.string(), error.message());
    if (replaces && !fs::exists(final_, ignored)) fs::rename(old, final_, ignored);
    return message;
  }
  if (replaces) fs::remove_all(old, ignored);
  return std::nullopt;
}

}  // namespace tightrope::ccd
