#pragma once
/// Diagnostics of elaboration: one for each place, however often loops and calls pass by it.

#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "dsl/diagnostic.h"

namespace tightrope::dsl {

class Reporter {
 public:
  Reporter(const SourceMap& sources, Diagnostics& diagnostics) : sources_(sources), diagnostics_(diagnostics) {}

  /// Reports unless something has been reported at this very place before, or very much already. Without a hint of its
  /// own a diagnostic tells how its place was reached, if through a call or an instance.
  void error(SourceSpan span, std::string message, std::string hint = {});
  /// Whether to look for a name similar to an unknown one: for so many of them only, it takes time.
  bool may_suggest() { return suggestions_left_ > 0 && suggestions_left_-- > 0; }
  const SourceMap& sources() const { return sources_; }
  /// The text that `span` covers.
  std::string_view text(SourceSpan span) const;
  /// "shapes.pred:3:7"
  std::string place(SourceSpan span) const;

  /// While it lives, errors are reached through `before` + `name` + `after` ("`area` is called") at `span`. The texts
  /// must live as long.
  class Context {
   public:
    Context(Reporter& reporter, std::string_view before, std::string_view name, std::string_view after, SourceSpan span)
        : reporter_(reporter) {
      reporter.context_.push_back({before, name, after, span});
    }
    ~Context() { reporter_.context_.pop_back(); }
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

   private:
    Reporter& reporter_;
  };

 private:
  struct Entry {
    std::string_view before, name, after;
    SourceSpan span;
  };
  struct SpanHash {
    std::size_t operator()(const SourceSpan& s) const {
      return static_cast<std::size_t>(((std::uint64_t{s.begin} << 32) | s.end) * 0x9E3779B97F4A7C15ull) ^ s.file;
    }
  };
  struct SpanEqual {
    bool operator()(const SourceSpan& a, const SourceSpan& b) const {
      return a.file == b.file && a.begin == b.begin && a.end == b.end;
    }
  };
  const SourceMap& sources_;
  Diagnostics& diagnostics_;
  std::unordered_set<SourceSpan, SpanHash, SpanEqual> reported_;
  std::vector<Entry> context_;
  int suggestions_left_ = 40;
  int errors_left_ = 1000;
};

}  // namespace tightrope::dsl
