#include "dsl/reporter.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tightrope::dsl {

std::string_view Reporter::text(SourceSpan span) const {
  const std::string_view all = sources_.file(span.file).text;
  const std::size_t begin = std::min<std::size_t>(span.begin, all.size());
  return all.substr(begin, span.end - begin);
}

std::string Reporter::place(SourceSpan span) const {
  const SourceMap::Position position = sources_.position(span.file, span.begin);
  return fmt::format("{}:{}:{}", sources_.file(span.file).path, position.line, position.column);
}

void Reporter::error(SourceSpan span, std::string message, std::string hint) {
  if (errors_left_ == 0 || !reported_.insert(span).second) return;
  --errors_left_;
  if (hint.empty() && !context_.empty()) {
    const Entry& c = context_.back();
    hint = fmt::format("{}`{}`{} at {}", c.before, c.name, c.after, place(c.span));
  }
  diagnostics_.error(span, std::move(message), std::move(hint));
}

}  // namespace tightrope::dsl
