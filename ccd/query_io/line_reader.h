#pragma once
/// Lines of a text file, in bounded memory.

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "query_io/query_block.h"

namespace tightrope::ccd {

class LineReader {
 public:
  static constexpr std::size_t max_line_bytes = std::size_t{1} << 20;

  explicit LineReader(std::filesystem::path path);

  /// The next line that is neither blank nor a comment ("#..."), without its end and without surrounding blanks;
  /// empty at the end of the file or on an error(). Valid until the next call.
  std::string_view next();

  std::size_t line_number() const { return line_; }  ///< of the line that next() gave, from 1
  const std::optional<FileError>& error() const { return error_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::optional<std::string_view> raw_line();
  bool refill();

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;  ///< unread bytes: buffer_[begin_, end_)
  std::size_t end_ = 0;
  std::size_t line_ = 0;
  bool at_end_ = false;
  std::optional<FileError> error_;
};

}  // namespace tightrope::ccd
