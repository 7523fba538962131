#include "dsl/lexer.h"

#include <gtest/gtest.h>

#include <string>

#include "dsl/utf8.h"

namespace tightrope::dsl {
namespace {

using namespace std::string_literals;

struct Lexed {
  SourceMap sources;
  Diagnostics diagnostics;
  TokenList list;
};

Lexed lex_text(std::string text) {
  Lexed lexed;
  lexed.sources.add("test.pred", std::move(text));
  lexed.list = lex(lexed.sources, 0, lexed.diagnostics);
  return lexed;
}

/// The tokens' texts, each with its kind where the text does not say it, `$` for the end.
std::string describe(const Lexed& lexed) {
  const std::string& text = lexed.sources.file(0).text;
  std::string description;
  for (const Token& token : lexed.list.tokens) {
    if (!description.empty()) description += ' ';
    if (token.kind == TokenKind::end) description += '$';
    if (token.kind == TokenKind::identifier) description += "id:";
    if (token.kind == TokenKind::number) description += "num:";
    if (token.kind == TokenKind::malformed) description += "bad:";
    description += text.substr(token.begin, token.end - token.begin);
  }
  return description;
}

TEST(Lexer, SplitsTextIntoTokens) {
  const struct {
    const char* text;
    const char* tokens;
  } table[] = {
      {"", "$"},
      {"a+b", "id:a + id:b $"},
      {"let x = a^2;", "let id:x = id:a ^ num:2 ; $"},
      {"0..3", "num:0 .. num:3 $"},
      {"1.5..2", "num:1.5 .. num:2 $"},
      {"i..n", "id:i .. id:n $"},
      {"v.x[0]", "id:v . id:x [ num:0 ] $"},
      {"1e10 1.25E-3 2e+5 007", "num:1e10 num:1.25E-3 num:2e+5 num:007 $"},
      {"|a|<=-4", "| id:a | <= - num:4 $"},
      {"letter vec3 vec33 _x1 at", "id:letter vec3 id:vec33 id:_x1 at $"},
      {"a//b\nc/*d\n*/e", "id:a id:c id:e $"},
      {"a/**/b/***/c", "id:a id:b id:c $"},
      {"\"shapes \xC3\xA9.pred\" x", "\"shapes \xC3\xA9.pred\" id:x $"},
      {"\xEF\xBB\xBFlet", "let $"},
      {"a\r\nb\rc\td\ve\ff", "id:a id:b id:c id:d id:e id:f $"},
      {"a:b,{}()", "id:a : id:b , { } ( ) $"},
  };
  for (const auto& row : table) {
    const Lexed lexed = lex_text(row.text);
    EXPECT_EQ(describe(lexed), row.tokens) << row.text;
    EXPECT_FALSE(lexed.diagnostics.has_errors()) << lexed.diagnostics.render(lexed.sources);
  }
}

TEST(Lexer, ReportsMalformedTextOnceAndGoesOn) {
  const struct {
    std::string text;
    std::string tokens;
    std::uint32_t begin, end;  // of the one error
  } table[] = {
      {"a @ b", "id:a bad:@ id:b $", 2, 3},
      {"a @@@ b", "id:a bad:@@@ id:b $", 2, 5},
      {"a ** b", "id:a bad:** id:b $", 2, 4},
      {"a == b", "id:a bad:== id:b $", 2, 4},
      {"2x y", "bad:2x id:y $", 0, 2},
      {"1.e5", "bad:1.e5 $", 0, 4},
      {"1.2.3 4", "bad:1.2.3 num:4 $", 0, 5},
      {"0x10", "bad:0x10 $", 0, 4},
      {".5", "bad:.5 $", 0, 2},
      {"\"abc\nd", "bad:\"abc id:d $", 0, 4},
      {"a /* b", "id:a $", 2, 4},
      {"na\xC3\xAFve x", "bad:na\xC3\xAFve id:x $", 0, 6},
      {"a \x80\xFF b", "id:a bad:\x80\xFF id:b $", 2, 4},
      {"a\0\0b"s, "id:a bad:\0\0 id:b $"s, 1, 3},
      {"// \xE2\x82\nx", "id:x $", 3, 5},
      {"/* \0 */ x"s, "id:x $", 3, 4},
      {"\"\xC0\"", "bad:\"\xC0\" $", 1, 2},
      {"\"a\x1B[2J\" b", "bad:\"a\x1B[2J\" id:b $", 2, 3},
  };
  for (const auto& row : table) {
    const Lexed lexed = lex_text(row.text);
    EXPECT_EQ(describe(lexed), row.tokens);
    ASSERT_EQ(lexed.diagnostics.entries().size(), 1u) << row.text;
    EXPECT_EQ(lexed.diagnostics.entries()[0].span.begin, row.begin) << row.text;
    EXPECT_EQ(lexed.diagnostics.entries()[0].span.end, row.end) << row.text;
  }
}

TEST(Lexer, NumbersLinesAtEveryKindOfLineEnd) {
  const Lexed lexed = lex_text("a\nb\r\nc\rd /*\n\r\n\r*/ e\n\n f // g\r\nh");
  std::vector<std::uint32_t> lines;
  std::string fresh;
  for (const Token& token : lexed.list.tokens) {
    lines.push_back(token.line);
    fresh += token.starts_line ? 'y' : 'n';
  }
  EXPECT_EQ(lines, (std::vector<std::uint32_t>{1, 2, 3, 4, 7, 9, 10, 10}));
  EXPECT_EQ(fresh, "yyyyyyyy");
  EXPECT_EQ(lex_text("a b /* \n */ c d").list.tokens[2].starts_line, true);
  EXPECT_EQ(lex_text("a b /* \n */ c d").list.tokens[3].starts_line, false);
}

TEST(Lexer, KeepsLineCommentsForDocumentation) {
  const Lexed lexed = lex_text("// one\nlet // two\n/* three */");
  ASSERT_EQ(lexed.list.line_comments.size(), 2u);
  EXPECT_EQ(lexed.list.line_comments[0].begin, 0u);
  EXPECT_EQ(lexed.list.line_comments[0].end, 6u);
  EXPECT_TRUE(lexed.list.line_comments[0].starts_line);
  EXPECT_FALSE(lexed.list.line_comments[1].starts_line);
}

TEST(Lexer, GivesUpAFileThatIsNoText) {
  std::string text;
  for (int i = 0; i < 100'000; ++i) text += "p\0"s;
  const Lexed lexed = lex_text(text);
  EXPECT_EQ(lexed.diagnostics.entries().size(), static_cast<std::size_t>(max_errors));
  EXPECT_FALSE(lexed.list.complete);
  EXPECT_EQ(lexed.list.tokens.back().kind, TokenKind::end);
}

TEST(Lexer, RefusesAFileBeyondTheSizeLimit) {
  const Lexed lexed = lex_text(std::string(max_file_size + 1, ' '));
  ASSERT_EQ(lexed.diagnostics.entries().size(), 1u);
  EXPECT_EQ(lexed.diagnostics.entries()[0].message, "the file is larger than 16 MiB");
  EXPECT_FALSE(lexed.list.complete);
  EXPECT_FALSE(lex_text(std::string(max_file_size, ' ')).diagnostics.has_errors());
}

TEST(Lexer, QuotesLongTextCutBetweenCharacters) {
  EXPECT_EQ(quote("abc"), "`abc`");
  EXPECT_EQ(quote(std::string(60, 'a')), "`" + std::string(60, 'a') + "`");
  EXPECT_EQ(quote(std::string(61, 'a')), "`" + std::string(57, 'a') + "...`");
  EXPECT_EQ(quote(std::string(56, 'a') + "\xC3\xA9\xC3\xA9\xC3\xA9"), "`" + std::string(56, 'a') + "...`");
}

TEST(Utf8, DecodesTheEndsOfEveryLengthAndNothingElse) {
  const struct {
    const char* text;
    std::uint32_t value;
    std::size_t length;
  } valid[] = {{"\x7F", 0x7F, 1},
               {"\xC2\x80", 0x80, 2},
               {"\xDF\xBF", 0x7FF, 2},
               {"\xE0\xA0\x80", 0x800, 3},
               {"\xED\x9F\xBF", 0xD7FF, 3},
               {"\xEE\x80\x80", 0xE000, 3},
               {"\xEF\xBF\xBF", 0xFFFF, 3},
               {"\xF0\x90\x80\x80", 0x10000, 4},
               {"\xF4\x8F\xBF\xBF", 0x10FFFF, 4}};
  for (const auto& row : valid) {
    const CodePoint c = decode_utf8(row.text, 0);
    EXPECT_TRUE(c.valid);
    EXPECT_EQ(c.value, row.value);
    EXPECT_EQ(c.length, row.length);
  }
  const char* malformed[] = {"\x80",
                             "\xBF",
                             "\xC0\x80",
                             "\xC1\xBF",
                             "\xC2",
                             "\xC2\x41",
                             "\xE0\x9F\xBF",
                             "\xED\xA0\x80",
                             "\xED\xBF\xBF",
                             "\xE2\x82",
                             "\xE2\x82\x41",
                             "\xF0\x8F\xBF\xBF",
                             "\xF4\x90\x80\x80",
                             "\xF5\x80\x80\x80",
                             "\xFF"};
  for (const char* text : malformed) {
    EXPECT_FALSE(decode_utf8(text, 0).valid) << static_cast<int>(static_cast<unsigned char>(text[0]));
    EXPECT_EQ(decode_utf8(text, 0).length, 1u);
  }
}

}  // namespace
}  // namespace tightrope::dsl
