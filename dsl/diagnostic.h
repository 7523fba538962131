#pragma once
/// Source text, positions and diagnostics. User errors are values: they are collected in `Diagnostics`, never thrown.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tightrope::dsl {

/// A half-open range of bytes [begin, end) of one source file of a `SourceMap`.
struct SourceSpan {
  std::uint32_t file = 0;
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

/// One loaded file. `path` is what the user wrote (or the importing file's folder joined with the import).
struct SourceFile {
  std::string path;
  std::string text;
};

/// All files of one compilation, addressed by `SourceSpan::file`.
class SourceMap {
 public:
  /// Adds a file and returns its index.
  std::uint32_t add(std::string path, std::string text);
  const SourceFile& file(std::uint32_t index) const { return files_[index]; }
  std::uint32_t size() const { return static_cast<std::uint32_t>(files_.size()); }

  struct Position {
    std::uint32_t line = 1;    ///< from 1
    std::uint32_t column = 1;  ///< from 1, in code points (a tab counts as one)
  };
  Position position(std::uint32_t file, std::uint32_t offset) const;
  /// The text of the line that holds `offset`, without its line end.
  std::string_view line_text(std::uint32_t file, std::uint32_t offset) const;

 private:
  std::vector<SourceFile> files_;
};

struct Diagnostic {
  SourceSpan span;
  /// One sentence, lower case, no full stop: "cannot add a vector of degree 2 and a scalar of degree 3".
  std::string message;
  std::string hint;  ///< optional: "did you mean `cross`?"
};

/// The errors of a compilation, in the order found; `render` sorts them by place.
class Diagnostics {
 public:
  void error(SourceSpan span, std::string message, std::string hint = {});
  bool has_errors() const { return !entries_.empty(); }
  const std::vector<Diagnostic>& entries() const { return entries_; }

  /// "file:line:column: error: message", the source line, a caret line, and "hint: ..." where there is one, for each
  /// diagnostic, sorted by file and place. At most `limit` are shown; the rest are counted in a last line.
  std::string render(const SourceMap& sources, std::size_t limit = 50) const;

 private:
  std::vector<Diagnostic> entries_;
};

/// The candidate closest to `name` by edit distance (at most 2, and under half of the name's length), or empty.
std::string_view closest_name(std::string_view name, const std::vector<std::string_view>& candidates);

}  // namespace tightrope::dsl
