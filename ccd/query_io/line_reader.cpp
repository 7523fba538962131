#include "query_io/line_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace tightrope::ccd {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace

LineReader::LineReader(std::filesystem::path path)
    : path_(std::move(path)), file_(std::fopen(path_.c_str(), "rb")), buffer_(max_line_bytes) {
  if (!file_) error_ = FileError{fmt::format("{}: {}", path_.string(), std::strerror(errno))};
}

std::string_view LineReader::next() {
  while (const auto raw = raw_line()) {
    std::string_view line = *raw;
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (line_ == 1 && line.starts_with(byte_order_mark)) line.remove_prefix(byte_order_mark.size());
    line = trimmed(line);
    if (!line.empty() && line.front() != '#') return line;
  }
  return {};
}

std::optional<std::string_view> LineReader::raw_line() {
  if (error_) return std::nullopt;
  std::size_t searched = 0;
  while (true) {
    const char* start = buffer_.data() + begin_;
    const std::size_t available = end_ - begin_;
    const void* found = available > searched ? std::memchr(start + searched, '\n', available - searched) : nullptr;
    if (found != nullptr || (at_end_ && available > 0)) {
      const std::size_t length =
          found != nullptr ? static_cast<std::size_t>(static_cast<const char*>(found) - start) : available;
      begin_ = std::min(begin_ + length + 1, end_);
      ++line_;
      return std::string_view(start, length);
    }
    if (at_end_) return std::nullopt;
    searched = available;
    if (!refill()) return std::nullopt;
  }
}

/// Moves the unread bytes to the front and reads on behind them; false on an error.
bool LineReader::refill() {
  if (begin_ == 0 && end_ == buffer_.size()) {
    error_ = FileError{fmt::format("{}:{}: line longer than {} bytes", path_.string(), line_ + 1, max_line_bytes)};
    return false;
  }
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  const std::size_t count = std::fread(buffer_.data() + end_, 1, buffer_.size() - end_, file_.get());
  end_ += count;
  at_end_ = count == 0;
  if (std::ferror(file_.get()) != 0) {
    error_ = FileError{fmt::format("{}: {}", path_.string(), std::strerror(errno))};
    return false;
  }
  return true;
}

}  // namespace tightrope::ccd
