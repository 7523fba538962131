#pragma once
/// One query file, read in blocks.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <variant>

#include "query_io/query_block.h"

namespace tightrope::ccd {

class QueryReader {
 public:
  QueryReader() = default;
  QueryReader(const QueryReader&) = delete;
  QueryReader& operator=(const QueryReader&) = delete;
  virtual ~QueryReader() = default;

  /// Replaces `block` by the next queries, at most `limit` > 0 and all of one kind, with truths for all or none; an
  /// empty block is the end of the file. After an error the reader is not to be used again.
  [[nodiscard]] virtual std::optional<FileError> next(std::size_t limit, QueryBlock& block) = 0;

  /// Passes over the queries that next(limit) would give, without reading them; how many they are. CSV files cannot: 0.
  virtual std::uint64_t skip(std::size_t limit) {
    static_cast<void>(limit);
    return 0;
  }

  /// Rational coordinates read so far that are no doubles and were rounded to nearest.
  virtual std::uint64_t rounded() const { return 0; }
};

using OpenedReader = std::variant<std::unique_ptr<QueryReader>, FileError>;

/// CSV, told apart by the first row: 7 fields are the rational format, 8 rows a query; 24 or 25 the plain one.
OpenedReader open_csv(const std::filesystem::path& path, Kind kind);

/// HDF5; without `kind` first the vertex-face queries, then the edge-edge ones.
OpenedReader open_hdf5(const std::filesystem::path& path, std::optional<Kind> kind);

}  // namespace tightrope::ccd
