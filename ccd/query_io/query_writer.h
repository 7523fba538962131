#pragma once
/// Query files, written in blocks. Nothing appears under the final name before commit().

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "query_io/query_block.h"

namespace tightrope::ccd {

class QueryWriter {
 public:
  QueryWriter() = default;
  QueryWriter(const QueryWriter&) = delete;
  QueryWriter& operator=(const QueryWriter&) = delete;
  virtual ~QueryWriter() = default;  ///< removes what was not committed

  /// Appends queries with their truths (`block.has_truth()`), all coordinates finite.
  [[nodiscard]] virtual std::optional<FileError> append(const QueryBlock& block) = 0;
  [[nodiscard]] virtual std::optional<FileError> commit() = 0;
};

using OpenedWriter = std::variant<std::unique_ptr<QueryWriter>, FileError>;

/// HDF5 with float64 queries and one-byte truths; a group for each kind that is appended.
OpenedWriter create_hdf5(const std::filesystem::path& path);

/// DIRECTORY/KIND/STEM.csv in the rational format for each kind that is appended; makes the directories.
OpenedWriter create_rational_csv(const std::filesystem::path& directory, const std::string& stem);

/// create_hdf5 for .h5 and .hdf5, else create_rational_csv with a directory (which may exist).
OpenedWriter create_queries(const std::filesystem::path& output, const std::string& stem);

}  // namespace tightrope::ccd
