#include "codegen/write_files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include <vector>

namespace tightrope::codegen {
namespace {

namespace fs = std::filesystem;

/// Makes `directory` and its missing parents; appends those it made, outermost first.
std::error_code make_directories(const fs::path& directory, std::vector<fs::path>& made) {
  std::error_code error;
  std::vector<fs::path> missing;
  for (fs::path d = directory; !d.empty() && !fs::exists(d, error); d = d.parent_path()) {
    missing.push_back(d);
    if (d == d.parent_path()) break;
  }
  for (auto d = missing.rbegin(); d != missing.rend(); ++d) {
    if (fs::create_directory(*d, error)) made.push_back(*d);
    if (error) return error;
  }
  if (!directory.empty() && !fs::is_directory(directory, error)) {
    return error ? error : std::make_error_code(std::errc::not_a_directory);
  }
  return {};
}

void remove_all_of(const std::vector<fs::path>& files, const std::vector<fs::path>& directories) {
  std::error_code ignored;
  for (const fs::path& file : files) fs::remove(file, ignored);
  for (auto d = directories.rbegin(); d != directories.rend(); ++d) fs::remove(*d, ignored);  // only if empty
}

std::string write_text(const fs::path& path, const std::string& text) {
  errno = 0;
  std::ofstream stream(path, std::ios::binary | std::ios::trunc);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  return stream ? "" : std::strerror(errno);
}

}  // namespace

std::string write_files(std::span<const TextFile> files) {
  std::vector<fs::path> directories;
  std::vector<fs::path> written;
  std::vector<fs::path> temporary;
  for (const TextFile& file : files) {
    std::string failure;
    if (const std::error_code error = make_directories(file.path.parent_path(), directories)) {
      failure = error.message();
    } else if (std::error_code ignored; fs::is_directory(file.path, ignored)) {
      failure = "is a directory";
    } else {
      temporary.push_back(file.path.string() + fmt::format(".{}.tmp", ::getpid()));
      written.push_back(temporary.back());
      failure = write_text(temporary.back(), file.text);
    }
    if (!failure.empty()) {
      remove_all_of(written, directories);
      return fmt::format("cannot write {}: {}", file.path.string(), failure);
    }
  }
  for (std::size_t i = 0; i < files.size(); ++i) {
    std::error_code error;
    fs::rename(temporary[i], files[i].path, error);
    if (error) {
      remove_all_of(written, directories);
      return fmt::format("cannot write {}: {}", files[i].path.string(), error.message());
    }
    written.push_back(files[i].path);
  }
  return {};
}

}  // namespace tightrope::codegen
