#include "dsl/diagnostic.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "dsl/utf8.h"

namespace tightrope::dsl {

namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

/// A line ends at "\n", or at a "\r" that no "\n" follows.
bool ends_line(std::string_view text, std::size_t i) {
  return text[i] == '\n' || (text[i] == '\r' && (i + 1 == text.size() || text[i + 1] != '\n'));
}

/// Where the line that holds `offset` begins; the byte order mark belongs to no line.
std::size_t line_begin(std::string_view text, std::size_t offset) {
  std::size_t begin = offset;
  while (begin > 0 && !ends_line(text, begin - 1)) --begin;
  if (begin == 0 && text.starts_with(byte_order_mark)) begin = byte_order_mark.size();
  return begin;
}

std::size_t line_end(std::string_view text, std::size_t offset) {
  std::size_t end = offset;
  while (end < text.size() && !ends_line(text, end)) ++end;
  if (end < text.size() && text[end] == '\n' && end > offset && text[end - 1] == '\r') --end;
  return end;
}

/// One piece of a source line as it is shown: a character, an escaped byte, or a tab's spaces.
struct Cell {
  std::string text;
  int width = 1;
  bool marked = false;  ///< under the caret
};

/// The cells of `line`, whose bytes [mark_begin, mark_end) get the caret (a caret of zero length marks nothing here).
std::vector<Cell> display_cells(std::string_view line, std::size_t mark_begin, std::size_t mark_end) {
  constexpr int tab_stop = 4;
  std::vector<Cell> cells;
  int column = 0;
  for (std::size_t i = 0; i < line.size();) {
    const CodePoint c = decode_utf8(line, i);
    Cell cell;
    if (line[i] == '\t') {
      cell.width = tab_stop - column % tab_stop;
      cell.text.assign(static_cast<std::size_t>(cell.width), ' ');
    } else if (!c.valid || needs_escape(c.value)) {
      cell.text = c.valid && c.value > 0x7F ? fmt::format("<U+{:04X}>", c.value) : fmt::format("<{:02X}>", c.value);
      cell.width = static_cast<int>(cell.text.size());
    } else {
      cell.text = line.substr(i, c.length);
      cell.width = display_width(c.value);
    }
    cell.marked = i >= mark_begin && i < mark_end;
    column += cell.width;
    i += c.length;
    cells.push_back(std::move(cell));
  }
  return cells;
}

/// The part of a long line around its caret that is shown: bytes [begin, end) of the line, cut between characters.
struct Window {
  std::size_t begin = 0, end = 0;
};

Window clip(std::string_view line, std::size_t mark_begin) {
  constexpr std::size_t most = 120, before = 60;
  if (line.size() <= most) return {0, line.size()};
  const auto inside_character = [&](std::size_t i) {
    return i < line.size() && (static_cast<unsigned char>(line[i]) & 0xC0) == 0x80;
  };
  Window window;
  window.begin = mark_begin > before ? mark_begin - before : 0;
  window.begin = std::min(window.begin, line.size() - most);
  window.end = window.begin + most;
  // A character is at most four bytes; malformed text may hold longer runs of continuation bytes, cut anywhere.
  for (int i = 0; i < 3 && inside_character(window.begin) && window.begin < mark_begin; ++i) ++window.begin;
  for (int i = 0; i < 3 && inside_character(window.end); ++i) ++window.end;
  return window;
}

/// The source line and the caret line below it.
std::string render_excerpt(std::string_view line, std::size_t mark_begin, std::size_t mark_end) {
  const Window window = clip(line, mark_begin);
  std::string shown, carets;
  if (window.begin > 0) {
    shown = "...";
    carets = "   ";
  }
  bool any = false;
  for (const Cell& cell : display_cells(line.substr(window.begin, window.end - window.begin), mark_begin - window.begin,
                                        std::max(mark_end, window.begin) - window.begin)) {
    shown += cell.text;
    for (int i = 0; i < cell.width; ++i) {
      carets += !cell.marked ? ' ' : any ? '~' : '^';
      any = any || cell.marked;
    }
  }
  if (!any) {  // a place between characters, or behind the line
    carets.clear();
    const std::string_view left = line.substr(window.begin, mark_begin - window.begin);
    int width = window.begin > 0 ? 3 : 0;
    for (const Cell& cell : display_cells(left, left.size(), left.size())) width += cell.width;
    carets.assign(static_cast<std::size_t>(width), ' ');
    carets += '^';
  }
  if (window.end < line.size()) shown += "...";
  carets.erase(carets.find_last_not_of(' ') + 1);
  return fmt::format("{}\n{}\n", shown, carets);
}

std::string render_one(const SourceMap& sources, const Diagnostic& diagnostic) {
  const SourceSpan& span = diagnostic.span;
  const SourceFile& file = sources.file(span.file);
  const auto size = static_cast<std::uint32_t>(file.text.size());
  const std::uint32_t offset = std::min(span.begin, size);
  const SourceMap::Position at = sources.position(span.file, offset);
  const std::string_view line = sources.line_text(span.file, offset);
  const std::size_t begin = line_begin(file.text, offset);
  const std::size_t mark_begin = std::min<std::size_t>(std::max<std::size_t>(offset, begin) - begin, line.size());
  const std::size_t mark_end =
      std::clamp<std::size_t>(std::min(span.end, size), begin + mark_begin, begin + line.size());
  std::string text = fmt::format("{}:{}:{}: error: {}\n", file.path, at.line, at.column, diagnostic.message);
  text += render_excerpt(line, mark_begin, mark_end - begin);
  if (!diagnostic.hint.empty()) text += fmt::format("hint: {}\n", diagnostic.hint);
  return text;
}

}  // namespace

std::uint32_t SourceMap::add(std::string path, std::string text) {
  files_.push_back({std::move(path), std::move(text)});
  return size() - 1;
}

SourceMap::Position SourceMap::position(std::uint32_t file, std::uint32_t offset) const {
  const std::string_view text = files_[file].text;
  const std::size_t end = std::min<std::size_t>(offset, text.size());
  Position position;
  for (std::size_t i = 0; i < end; ++i) {
    if (ends_line(text, i)) ++position.line;
  }
  for (std::size_t i = line_begin(text, end); i < end; i += decode_utf8(text, i).length) ++position.column;
  return position;
}

std::string_view SourceMap::line_text(std::uint32_t file, std::uint32_t offset) const {
  const std::string_view text = files_[file].text;
  const std::size_t begin = line_begin(text, std::min<std::size_t>(offset, text.size()));
  return text.substr(begin, line_end(text, begin) - begin);
}

void Diagnostics::error(SourceSpan span, std::string message, std::string hint) {
  entries_.push_back({span, std::move(message), std::move(hint)});
}

std::string Diagnostics::render(const SourceMap& sources, std::size_t limit) const {
  std::vector<const Diagnostic*> sorted;
  sorted.reserve(entries_.size());
  for (const Diagnostic& entry : entries_) sorted.push_back(&entry);
  const auto key = [](const Diagnostic* d) { return std::tie(d->span.file, d->span.begin, d->span.end, d->message); };
  std::sort(sorted.begin(), sorted.end(), [&](const Diagnostic* a, const Diagnostic* b) { return key(a) < key(b); });
  // An inlined function's mistake is found at each of its calls: it is shown once.
  const auto same = [&](const Diagnostic* a, const Diagnostic* b) { return key(a) == key(b); };
  sorted.erase(std::unique(sorted.begin(), sorted.end(), same), sorted.end());
  std::string text;
  for (std::size_t i = 0; i < std::min(limit, sorted.size()); ++i) text += render_one(sources, *sorted[i]);
  if (sorted.size() > limit) {
    const std::size_t rest = sorted.size() - limit;
    text += fmt::format("... and {} more error{}\n", rest, rest == 1 ? "" : "s");
  }
  return text;
}

namespace {

/// Edits that turn `a` into `b`: insertions, removals, replacements, and exchanges of two neighbours (Damerau 1964,
/// each place edited at most once).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> two_back, back(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) back[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({back[j] + 1, row[j - 1] + 1, back[j - 1] + (a[i - 1] == b[j - 1] ? 0u : 1u)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], two_back[j - 2] + 1);
    }
    two_back = std::exchange(back, row);
  }
  return back[b.size()];
}

}  // namespace

std::string_view closest_name(std::string_view name, const std::vector<std::string_view>& candidates) {
  constexpr std::size_t longest_name = 64, most_edits = 2;
  std::string_view best;
  std::size_t best_distance = most_edits + 1;
  if (name.size() > longest_name) return best;
  for (const std::string_view candidate : candidates) {
    const std::size_t longer = std::max(name.size(), candidate.size());
    if (longer - std::min(name.size(), candidate.size()) > most_edits) continue;
    const std::size_t distance = edit_distance(name, candidate);
    if (distance == 0 || distance >= best_distance || 2 * distance >= name.size()) continue;
    best = candidate;
    best_distance = distance;
  }
  return best;
}

}  // namespace tightrope::dsl
