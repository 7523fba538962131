#include "dsl/diagnostic.h"

#include <gtest/gtest.h>

#include <string>

namespace tightrope::dsl {
namespace {

std::string render_at(std::string text, std::uint32_t begin, std::uint32_t end, std::string hint = {}) {
  SourceMap sources;
  Diagnostics diagnostics;
  sources.add("a.pred", std::move(text));
  diagnostics.error({0, begin, end}, "wrong", std::move(hint));
  return diagnostics.render(sources);
}

TEST(Diagnostics, ShowPlaceLineCaretAndHint) {
  EXPECT_EQ(render_at("let a = b\nlet c = crss(a)\n", 18, 22, "did you mean `cross`?"),
            "a.pred:2:9: error: wrong\n"
            "let c = crss(a)\n"
            "        ^~~~\n"
            "hint: did you mean `cross`?\n");
}

TEST(Diagnostics, PutTheCaretUnderTheCharactersWhateverTheLineHolds) {
  const struct {
    const char* what;
    std::string text;
    std::uint32_t begin, end;
    const char* rendered;
  } table[] = {
      {"empty file", "", 0, 0, "a.pred:1:1: error: wrong\n\n^\n"},
      {"behind the file", "ab", 2, 2, "a.pred:1:3: error: wrong\nab\n  ^\n"},
      {"span beyond the file", "ab", 7, 9, "a.pred:1:3: error: wrong\nab\n  ^\n"},
      {"place without characters", "ab cd", 3, 3, "a.pred:1:4: error: wrong\nab cd\n   ^\n"},
      {"empty line between others", "a\n\nb", 2, 2, "a.pred:2:1: error: wrong\n\n^\n"},
      {"span over several lines", "ab cd\nef", 3, 8, "a.pred:1:4: error: wrong\nab cd\n   ^~\n"},
      {"line end of Windows", "ab\r\ncd\r\n", 4, 6, "a.pred:2:1: error: wrong\ncd\n^~\n"},
      {"at the line end of Windows", "ab\r\ncd\r\n", 2, 4, "a.pred:1:3: error: wrong\nab\n  ^\n"},
      {"old line end", "ab\rcd\r", 3, 5, "a.pred:2:1: error: wrong\ncd\n^~\n"},
      {"byte order mark", "\xEF\xBB\xBFxy", 4, 5, "a.pred:1:2: error: wrong\nxy\n ^\n"},
      {"byte order mark itself", "\xEF\xBB\xBFxy", 0, 3, "a.pred:1:1: error: wrong\nxy\n^\n"},
      {"tabs", "\ta\tbb c", 3, 5, "a.pred:1:4: error: wrong\n    a   bb c\n        ^~\n"},
      {"tab within the span", "a\tb", 0, 3, "a.pred:1:1: error: wrong\na   b\n^~~~~\n"},
      {"two-byte character", "\xC3\xA9 x", 3, 4, "a.pred:1:3: error: wrong\n\xC3\xA9 x\n  ^\n"},
      {"wide character", "\xE9\x95\xB7 x", 4, 5, "a.pred:1:3: error: wrong\n\xE9\x95\xB7 x\n   ^\n"},
      {"combining character", "e\xCC\x81 x", 4, 5, "a.pred:1:4: error: wrong\ne\xCC\x81 x\n  ^\n"},
      {"malformed byte",
       "a\xFF"
       "b",
       1, 2, "a.pred:1:2: error: wrong\na<FF>b\n ^~~~\n"},
      {"escape sequence", "a\x1B[2J b", 6, 7, "a.pred:1:7: error: wrong\na<1B>[2J b\n         ^\n"},
      {"reordering character",
       "a\xE2\x80\xAE"
       "b",
       4, 5, "a.pred:1:3: error: wrong\na<U+202E>b\n         ^\n"},
  };
  for (const auto& row : table) EXPECT_EQ(render_at(row.text, row.begin, row.end), row.rendered) << row.what;
}

/// The shown line and its caret line, without the first line and its place.
std::pair<std::string, std::string> excerpt(const std::string& rendered) {
  const std::size_t line = rendered.find('\n') + 1;
  const std::size_t carets = rendered.find('\n', line) + 1;
  return {rendered.substr(line, carets - line - 1), rendered.substr(carets, rendered.find('\n', carets) - carets)};
}

TEST(Diagnostics, ClipLongLinesAroundTheCaret) {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += std::to_string(1000 + i) + " ";
  for (std::uint32_t at : {0u, 5u, 55u, 100u, 2500u, 4900u, 4995u}) {
    const auto [line, carets] = excerpt(render_at(text, at, at + 4));
    EXPECT_LE(line.size(), 130u);
    EXPECT_EQ(line.substr(carets.find('^'), 4), text.substr(at, 4)) << at;
    EXPECT_EQ(carets.substr(carets.find('^')), "^~~~");
    EXPECT_EQ(line.starts_with("..."), at > 60) << at;
    EXPECT_EQ(line.ends_with("..."), at + 60 < text.size()) << at;
  }
  const auto [line, carets] = excerpt(render_at(text, 2500, 4900));
  EXPECT_LE(carets.size(), line.size());
}

TEST(Diagnostics, ClipLongLinesBetweenCharacters) {
  std::string text;
  for (int i = 0; i < 500; ++i) text += "\xE2\x88\x86";
  text += "x";
  for (std::uint32_t at = 0; at < 1500; at += 3) {
    const std::string rendered = render_at(text, at, at + 3);
    EXPECT_EQ(rendered.find('<'), std::string::npos) << rendered;  // no half of a character, shown as <E2>
  }
  const std::string continuation_bytes(1000, '\x80');
  EXPECT_LT(render_at(continuation_bytes, 500, 501).size(), 1200u);
}

TEST(Diagnostics, AreSortedByPlaceAndShownOnce) {
  SourceMap sources;
  Diagnostics diagnostics;
  sources.add("a.pred", "a\nb\n");
  sources.add("b.pred", "c\n");
  diagnostics.error({1, 0, 1}, "third");
  diagnostics.error({0, 2, 3}, "second");
  diagnostics.error({0, 0, 1}, "first");
  diagnostics.error({0, 2, 3}, "second");
  EXPECT_EQ(diagnostics.entries().size(), 4u);
  EXPECT_EQ(diagnostics.render(sources),
            "a.pred:1:1: error: first\na\n^\n"
            "a.pred:2:1: error: second\nb\n^\n"
            "b.pred:1:1: error: third\nc\n^\n");
}

TEST(Diagnostics, BeyondTheLimitAreCounted) {
  SourceMap sources;
  Diagnostics diagnostics;
  sources.add("a.pred", "abcd");
  for (std::uint32_t i = 0; i < 4; ++i) diagnostics.error({0, i, i + 1}, "wrong");
  EXPECT_EQ(diagnostics.render(sources, 4).find("more"), std::string::npos);
  EXPECT_TRUE(diagnostics.render(sources, 3).ends_with("\n... and 1 more error\n"));
  EXPECT_EQ(diagnostics.render(sources, 0), "... and 4 more errors\n");
}

TEST(SourceMap, ColumnsCountCodePoints) {
  SourceMap sources;
  sources.add("a.pred", "a\n\t\xC3\xA9\xE2\x82\xACx\xFF!");
  const auto column = [&](std::uint32_t offset) { return sources.position(0, offset).column; };
  EXPECT_EQ(sources.position(0, 2).line, 2u);
  EXPECT_EQ(column(2), 1u);  // the tab
  EXPECT_EQ(column(3), 2u);
  EXPECT_EQ(column(5), 3u);
  EXPECT_EQ(column(8), 4u);
  EXPECT_EQ(column(9), 5u);   // the malformed byte
  EXPECT_EQ(column(10), 6u);  // !
  EXPECT_EQ(column(99), 7u);  // clamped to the file's end
  EXPECT_EQ(sources.line_text(0, 0), "a");
  EXPECT_EQ(sources.line_text(0, 1), "a");
}

TEST(ClosestName, IsTheNearestWithinTwoEditsAndHalfTheLength) {
  const std::vector<std::string_view> names{"cross", "dot", "det", "diff", "elevate", "coefficients"};
  EXPECT_EQ(closest_name("crss", names), "cross");
  EXPECT_EQ(closest_name("corss", names), "cross");  // neighbours exchanged: one edit
  EXPECT_EQ(closest_name("Dot", names), "dot");
  EXPECT_EQ(closest_name("elvate", names), "elevate");
  EXPECT_EQ(closest_name("coeficient", names), "coefficients");
  EXPECT_EQ(closest_name("coefs", names), "");
  EXPECT_EQ(closest_name("dx", names), "");       // half of the name would be another
  EXPECT_EQ(closest_name("dfi", names), "");      // two edits of three characters
  EXPECT_EQ(closest_name("elevate", names), "");  // it is the name: nothing to suggest
  EXPECT_EQ(closest_name("", names), "");
  EXPECT_EQ(closest_name(std::string(1'000'000, 'x'), names), "");
}

}  // namespace
}  // namespace tightrope::dsl
