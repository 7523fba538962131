#pragma once
/// Which files the arguments of a command stand for, and their queries one after another.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "query_io/query_reader.h"

namespace tightrope::ccd {

struct QueryFile {
  std::filesystem::path path;
  std::optional<Kind> kind;  ///< of a CSV file its kind; of an HDF5 file the only kind to be read, or both
};

/// The kind named by the last component of `path` that is `vertex-face` or `edge-edge`, an extension not counted.
std::optional<Kind> kind_of_path(const std::filesystem::path& path);

/// Files and directories in the order given; a directory stands for all files below it that end in .csv, .h5 or .hdf5
/// (hidden ones excepted), sorted by path. `kind` is that of CSV files whose path tells none, and leaves out what is of
/// the other kind. Errors: a path that does not exist or stands for no file, a CSV file of unknown kind.
std::variant<std::vector<QueryFile>, FileError> find_query_files(std::span<const std::string> paths,
                                                                 std::optional<Kind> kind);

/// The units that one of `count` readers reads: index, index + count, .. A unit is a CSV file, which cannot be divided,
/// or a block of an HDF5 file.
struct Share {
  std::uint64_t index = 0;
  std::uint64_t count = 1;
};

/// Reads file after file.
class QueryStream {
 public:
  explicit QueryStream(std::vector<QueryFile> files, Share share = {}) : files_(std::move(files)), share_(share) {}

  /// As QueryReader::next(); a block never spans two files. Also an error, unless the queries are shared: the end of
  /// the last file without any query. All readers of shares are to use the same `limit`.
  [[nodiscard]] std::optional<FileError> next(std::size_t limit, QueryBlock& block);

  /// Of the last block or error; at the end, the number of units.
  std::uint64_t unit() const { return unit_; }

  FileError no_queries() const;  ///< what is wrong when no reader finds any

  /// The file of the last block.
  const std::filesystem::path& path() const { return files_[file_].path; }

  /// Rational coordinates rounded so far.
  std::uint64_t rounded() const { return rounded_ + (reader_ ? reader_->rounded() : 0); }

 private:
  bool is_mine() const { return unit_ % share_.count == share_.index; }
  std::optional<FileError> next_of_file(std::size_t limit, QueryBlock& block);

  std::vector<QueryFile> files_;
  Share share_;
  std::size_t file_ = 0;
  bool divides_ = false;  ///< the current file: into blocks
  bool given_ = false;    ///< the block `unit_` of it
  std::uint64_t unit_ = 0;
  std::unique_ptr<QueryReader> reader_;
  std::uint64_t rounded_ = 0;  ///< in the files before
  std::uint64_t queries_ = 0;
};

}  // namespace tightrope::ccd
