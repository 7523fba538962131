#include "query_io/query_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

namespace tightrope::ccd {
namespace {

namespace fs = std::filesystem;

bool is_hdf5_name(const fs::path& path) { return path.extension() == ".h5" || path.extension() == ".hdf5"; }

/// By the eight bytes that HDF5 files begin with.
bool has_hdf5_signature(const fs::path& path) {
  constexpr std::string_view signature("\x89HDF\r\n\x1a\n", 8);
  std::array<char, 8> start{};
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return false;
  const std::size_t count = std::fread(start.data(), 1, start.size(), file);
  std::fclose(file);
  return std::string_view(start.data(), count) == signature;
}

bool is_hdf5(const fs::path& path) { return is_hdf5_name(path) || has_hdf5_signature(path); }

std::variant<std::vector<fs::path>, FileError> files_below(const fs::path& directory) {
  std::vector<fs::path> found;
  std::error_code error;
  fs::recursive_directory_iterator entry(directory, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    const fs::path& path = entry->path();
    const bool hidden = path.filename().string().starts_with('.');
    std::error_code ignored;
    if (entry->is_directory(ignored)) {
      if (hidden) entry.disable_recursion_pending();
    } else if (!hidden && (path.extension() == ".csv" || is_hdf5_name(path))) {
      found.push_back(path);
    }
  }
  if (error) return FileError{fmt::format("{}: {}", directory.string(), error.message())};
  if (found.empty()) {
    return FileError{fmt::format("{}: no query files (.csv, .h5, .hdf5) below this directory", directory.string())};
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// Adds one file, unless it is of the other kind.
std::optional<FileError> add_file(const fs::path& path, std::optional<Kind> kind, std::vector<QueryFile>& files) {
  if (is_hdf5(path)) {
    files.push_back({path, kind});
    return std::nullopt;
  }
  std::error_code ignored;
  const fs::path absolute = fs::absolute(path, ignored);
  const auto told = kind_of_path(absolute);
  if (!told && !kind) {
    return FileError{
        fmt::format("{}: vertex-face or edge-edge? No folder on its path is called so; --kind vertex-face or --kind "
                    "edge-edge tells",
                    path.string())};
  }
  if (told && kind && *told != *kind) return std::nullopt;
  files.push_back({path, told ? told : kind});
  return std::nullopt;
}

}  // namespace

std::optional<Kind> kind_of_path(const fs::path& path) {
  std::optional<Kind> kind;
  for (const fs::path& component : path) {
    const fs::path stem = component.extension() == ".csv" ? component.stem() : component;
    if (stem == name(Kind::vertex_face)) kind = Kind::vertex_face;
    if (stem == name(Kind::edge_edge)) kind = Kind::edge_edge;
  }
  return kind;
}

std::variant<std::vector<QueryFile>, FileError> find_query_files(std::span<const std::string> paths,
                                                                 std::optional<Kind> kind) {
  std::vector<QueryFile> files;
  for (const std::string& argument : paths) {
    const fs::path path(argument);
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status)) return FileError{fmt::format("{}: no such file or directory", argument)};
    std::vector<fs::path> found = {path};
    if (fs::is_directory(status)) {
      auto below = files_below(path);
      if (auto* wrong = std::get_if<FileError>(&below)) return *wrong;
      found = std::get<std::vector<fs::path>>(std::move(below));
    }
    for (const fs::path& file : found) {
      if (auto wrong = add_file(file, kind, files)) return *wrong;
    }
  }
  if (files.empty()) return FileError{fmt::format("{}: no {} queries", fmt::join(paths, " "), name(*kind))};
  return files;
}

std::optional<FileError> QueryStream::next(std::size_t limit, QueryBlock& block) {
  block.clear();
  for (; file_ < files_.size(); ++file_) {
    if (!reader_) {
      const QueryFile& file = files_[file_];
      divides_ = is_hdf5(file.path);
      if (!divides_ && !is_mine()) {
        ++unit_;
        continue;
      }
      auto opened = divides_ ? open_hdf5(file.path, file.kind) : open_csv(file.path, *file.kind);
      if (auto* wrong = std::get_if<FileError>(&opened)) return *wrong;
      reader_ = std::get<std::unique_ptr<QueryReader>>(std::move(opened));
    }
    if (auto wrong = next_of_file(limit, block)) return wrong;
    queries_ += block.size();
    if (block.size() > 0) return std::nullopt;
    if (!divides_) ++unit_;
    rounded_ += reader_->rounded();
    reader_.reset();
  }
  if (queries_ == 0 && share_.count == 1) return no_queries();
  return std::nullopt;
}

std::optional<FileError> QueryStream::next_of_file(std::size_t limit, QueryBlock& block) {
  if (divides_) {
    if (given_) ++unit_;
    given_ = false;
    for (; !is_mine(); ++unit_) {
      if (reader_->skip(limit) == 0) return std::nullopt;
    }
  }
  auto wrong = reader_->next(limit, block);
  given_ = block.size() > 0;
  return wrong;
}

FileError QueryStream::no_queries() const {
  return {fmt::format("{}{}: no queries", files_.front().path.string(), files_.size() > 1 ? " .." : "")};
}

}  // namespace tightrope::ccd
