#include "dsl/lexer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "dsl/utf8.h"

namespace tightrope::dsl {

namespace {

struct Spelling {
  TokenKind kind;
  std::string_view text;
};

constexpr std::array<Spelling, 25> keywords{{
    {TokenKind::keyword_predicate, "predicate"},
    {TokenKind::keyword_function, "function"},
    {TokenKind::keyword_instance, "instance"},
    {TokenKind::keyword_import, "import"},
    {TokenKind::keyword_stage, "stage"},
    {TokenKind::keyword_let, "let"},
    {TokenKind::keyword_sign, "sign"},
    {TokenKind::keyword_value, "value"},
    {TokenKind::keyword_for, "for"},
    {TokenKind::keyword_in, "in"},
    {TokenKind::keyword_range, "range"},
    {TokenKind::keyword_group, "group"},
    {TokenKind::keyword_property, "property"},
    {TokenKind::keyword_of, "of"},
    {TokenKind::keyword_as, "as"},
    {TokenKind::keyword_return, "return"},
    {TokenKind::keyword_bounded, "bounded"},
    {TokenKind::keyword_moving, "moving"},
    {TokenKind::keyword_static, "static"},
    {TokenKind::keyword_scalar, "scalar"},
    {TokenKind::keyword_vec2, "vec2"},
    {TokenKind::keyword_vec3, "vec3"},
    {TokenKind::keyword_point, "point"},
    {TokenKind::keyword_point2, "point2"},
    {TokenKind::keyword_at, "at"},
}};

/// Longer spellings first where one begins another.
constexpr std::array<Spelling, 19> symbols{{
    {TokenKind::dot_dot, ".."},
    {TokenKind::less_or_equal, "<="},
    {TokenKind::plus, "+"},
    {TokenKind::minus, "-"},
    {TokenKind::star, "*"},
    {TokenKind::slash, "/"},
    {TokenKind::caret, "^"},
    {TokenKind::left_parenthesis, "("},
    {TokenKind::right_parenthesis, ")"},
    {TokenKind::left_bracket, "["},
    {TokenKind::right_bracket, "]"},
    {TokenKind::left_brace, "{"},
    {TokenKind::right_brace, "}"},
    {TokenKind::comma, ","},
    {TokenKind::semicolon, ";"},
    {TokenKind::colon, ":"},
    {TokenKind::equals, "="},
    {TokenKind::bar, "|"},
    {TokenKind::dot, "."},
}};

/// What people write from habit, and what it is here.
struct ForeignSpelling {
  std::string_view text, hint;
};

constexpr std::array<ForeignSpelling, 19> foreign{{
    {"**", "a power is written `a ^ 2`"},
    {"==", "comparisons are not part of the language; `sign a - b` tells how a and b compare"},
    {"!=", "comparisons are not part of the language; `sign a - b` tells how a and b compare"},
    {">=", "comparisons are not part of the language; `sign a - b` tells how a and b compare"},
    {"->", "a function is written `function f(a, b) = a + b`"},
    {"=>", "a function is written `function f(a, b) = a + b`"},
    {":=", "a name is bound with `let x = ...`"},
    {"+=", "a name is bound once, with `let x = ...`"},
    {"-=", "a name is bound once, with `let x = ...`"},
    {"*=", "a name is bound once, with `let x = ...`"},
    {"/=", "a name is bound once, with `let x = ...`"},
    {"<", "comparisons are not part of the language; `sign a - b` tells how a and b compare"},
    {">", "comparisons are not part of the language; `sign a - b` tells how a and b compare"},
    {"#", "a comment is written `// ...`"},
    {"\xE2\x88\x92", "minus is written `-`"},
    {"\xE2\x80\x93", "minus is written `-`"},
    {"\xC3\x97", "a product is written `*`, a cross product `cross(a, b)`"},
    {"\xC2\xB7", "a product is written `*`, a dot product `dot(a, b)`"},
    {"\xE2\x89\xA4", "`range |x| <= 4` is written with `<=`"},
}};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_name_start(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_name_part(char c) { return is_name_start(c) || is_digit(c); }

/// Whether people may take it for a letter: above ASCII, and neither punctuation nor a mathematical sign.
bool looks_like_letter(std::uint32_t c) {
  const bool symbol = (c >= 0x2000 && c <= 0x2BFF) || (c >= 0x3000 && c <= 0x303F) || c == 0xD7 || c == 0xF7;
  return c >= 0xC0 && !symbol && !needs_escape(c);
}

class Lexer {
 public:
  Lexer(std::string_view text, std::uint32_t file, Diagnostics& diagnostics)
      : text_(text), file_(file), diagnostics_(diagnostics) {}

  TokenList run() {
    if (text_.size() > max_file_size) {
      error(0, 0, fmt::format("the file is larger than {} MiB", max_file_size >> 20));
      given_up_ = true;
    } else if (text_.starts_with("\xFF\xFE") || text_.starts_with("\xFE\xFF")) {
      error(0, 2, "the file is UTF-16 text", "save it as UTF-8");
      given_up_ = true;
    } else {
      if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
      while (at_ < text_.size() && !given_up_) lex_one();
    }
    list_.complete = !given_up_;
    const std::uint32_t end = list_.tokens.empty() ? 0 : list_.tokens.back().end;
    list_.tokens.push_back({TokenKind::end, true, line_, end, end});
    return std::move(list_);
  }

 private:
  char peek(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
  bool looking_at(std::string_view what) const { return text_.substr(at_).starts_with(what); }

  void error(std::size_t begin, std::size_t end, std::string message, std::string hint = {}) {
    diagnostics_.error({file_, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)}, std::move(message),
                       std::move(hint));
    given_up_ = ++errors_ >= max_errors;
  }

  /// The token [begin, at_).
  void push(TokenKind kind, std::size_t begin) {
    list_.tokens.push_back(
        {kind, line_is_fresh_, line_, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(at_)});
    line_is_fresh_ = false;
  }

  void lex_one() {
    const char c = peek();
    if (c == '\n' || c == '\r') {
      end_line();
      ++at_;
    } else if (c == ' ' || c == '\t' || c == '\v' || c == '\f') {
      ++at_;
    } else if (is_digit(c) || (c == '.' && is_digit(peek(1)))) {
      lex_number();
    } else if (is_name_start(c) || at_foreign_letter()) {
      lex_name();
    } else if (looking_at("//")) {
      lex_line_comment();
    } else if (looking_at("/*")) {
      lex_block_comment();
    } else if (c == '"') {
      lex_string();
    } else {
      lex_symbol();
    }
  }

  /// At a line end; "\r\n" counts at its "\n".
  void end_line() {
    line_is_fresh_ = true;
    if (peek() == '\n' || peek(1) != '\n') ++line_;
  }

  void lex_name() {
    const std::size_t begin = at_;
    while (is_name_part(peek())) ++at_;
    if (at_foreign_letter()) return lex_foreign_name(begin);
    const std::string_view name = text_.substr(begin, at_ - begin);
    const auto* keyword =
        std::find_if(keywords.begin(), keywords.end(), [&](const Spelling& s) { return s.text == name; });
    push(keyword == keywords.end() ? TokenKind::identifier : keyword->kind, begin);
  }

  bool at_foreign_letter() const {
    if (at_ >= text_.size() || static_cast<unsigned char>(text_[at_]) < 0x80) return false;
    const CodePoint code_point = decode_utf8(text_, at_);
    return code_point.valid && looks_like_letter(code_point.value);
  }

  /// A name with letters outside ASCII, from byte `begin` on.
  void lex_foreign_name(std::size_t begin) {
    while (is_name_part(peek()) || at_foreign_letter()) at_ += decode_utf8(text_, at_).length;
    error(begin, at_, fmt::format("{} is no name", quote(text_.substr(begin, at_ - begin))),
          "names are made of ASCII letters, digits and `_`");
    push(TokenKind::malformed, begin);
  }

  void skip_digits() {
    while (is_digit(peek())) ++at_;
  }

  /// digits [. digits] [e [+-] digits]; `0..3` is a number, `..` and a number.
  void lex_number() {
    const std::size_t begin = at_;
    const bool no_whole_part = peek() == '.';
    skip_digits();
    const bool hexadecimal = at_ == begin + 1 && text_[begin] == '0' && (peek() == 'x' || peek() == 'X');
    bool no_fraction = false;
    if (peek() == '.' && peek(1) != '.') {
      ++at_;
      no_fraction = !is_digit(peek());
      skip_digits();
    }
    if ((peek() == 'e' || peek() == 'E') &&
        (is_digit(peek(1)) || ((peek(1) == '+' || peek(1) == '-') && is_digit(peek(2))))) {
      at_ += 2;
      skip_digits();
    }
    const std::size_t number_end = at_;
    while (is_name_part(peek()) || (peek() == '.' && is_digit(peek(1)))) ++at_;
    const std::string_view number = text_.substr(begin, at_ - begin);
    if (no_whole_part) {
      const bool after_operand =
          begin > 0 && (is_name_part(text_[begin - 1]) || text_[begin - 1] == ']' || text_[begin - 1] == ')');
      error(begin, at_, "a number starts with a digit",
            after_operand ? std::string("a component is written `v.x` or `v[0]`")
                          : fmt::format("write {}", quote("0" + std::string(number))));
    } else if (hexadecimal) {
      error(begin, at_, fmt::format("{} is not a number", quote(number)),
            "numbers are decimal; a power of two is written `2^-30`");
    } else if (no_fraction) {
      error(begin, at_, "a digit must follow the point of a number",
            fmt::format("write {}", quote(std::string(text_.substr(begin, number_end - begin)) + "0")));
    } else if (number_end != at_) {
      const std::string_view rest = text_.substr(number_end, at_ - number_end);
      error(begin, at_, fmt::format("{} is not a number", quote(number)),
            is_name_start(rest[0]) && rest.find('.') == rest.npos
                ? fmt::format("a product is written {}",
                              quote(fmt::format("{} * {}", text_.substr(begin, number_end - begin), rest)))
                : std::string());
    } else {
      return push(TokenKind::number, begin);
    }
    push(TokenKind::malformed, begin);
  }

  /// Steps over one character of a comment or string, checking its encoding.
  void step_over_text() {
    const unsigned char c = static_cast<unsigned char>(text_[at_]);
    if (c == 0) {
      report_zero_bytes();
    } else if (c < 0x80) {
      ++at_;
    } else if (const CodePoint code_point = decode_utf8(text_, at_); code_point.valid) {
      at_ += code_point.length;
    } else {
      report_malformed_utf8();
    }
  }

  /// One error for a run of zero bytes.
  void report_zero_bytes() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && text_[at_] == '\0') ++at_;
    error(begin, at_, "the text holds a zero byte", "is this a text file?");
  }

  /// One error for a run of malformed bytes.
  void report_malformed_utf8() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && static_cast<unsigned char>(text_[at_]) >= 0x80 && !decode_utf8(text_, at_).valid)
      ++at_;
    error(begin, at_, "malformed UTF-8", "save the file as UTF-8");
  }

  bool at_line_end() const { return at_ >= text_.size() || text_[at_] == '\n' || text_[at_] == '\r'; }

  void lex_line_comment() {
    const std::size_t begin = at_;
    while (!at_line_end() && !given_up_) step_over_text();
    list_.line_comments.push_back(
        {TokenKind::end, line_is_fresh_, line_, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(at_)});
  }

  void lex_block_comment() {
    const std::size_t begin = at_;
    at_ += 2;
    while (at_ < text_.size() && !looking_at("*/") && !given_up_) {
      if (at_line_end()) end_line();
      step_over_text();
    }
    if (given_up_) return;
    if (at_ >= text_.size()) {
      error(begin, begin + 2, "this comment is not closed", "a comment that begins with `/*` ends with `*/`");
    } else {
      at_ += 2;
    }
  }

  void lex_string() {
    const std::size_t begin = at_++;
    const int errors_before = errors_;
    while (!at_line_end() && text_[at_] != '"' && !given_up_) {
      const CodePoint code_point = decode_utf8(text_, at_);
      if (code_point.valid && code_point.value != 0 && needs_escape(code_point.value)) {
        report_unexpected(code_point);
      } else {
        step_over_text();
      }
    }
    if (given_up_) return;
    if (at_line_end()) {
      error(begin, at_, "this string is not closed on its line");
      return push(TokenKind::malformed, begin);
    }
    ++at_;
    push(errors_ == errors_before ? TokenKind::string : TokenKind::malformed, begin);
  }

  /// One error for a run of one character that has no meaning here.
  void report_unexpected(CodePoint c) {
    const std::size_t begin = at_;
    const std::string_view character = text_.substr(at_, c.length);
    while (at_ < text_.size() && looking_at(character)) at_ += c.length;
    error(begin, at_,
          fmt::format("unexpected character {}",
                      needs_escape(c.value) ? fmt::format("U+{:04X}", c.value) : quote(character)),
          c.value >= 0x80 ? "characters outside ASCII may stand in comments only" : "");
  }

  void lex_symbol() {
    const std::size_t begin = at_;
    for (const ForeignSpelling& spelling : foreign) {
      if (!looking_at(spelling.text) || looking_at("<=")) continue;
      at_ += spelling.text.size();
      error(begin, at_, fmt::format("unexpected {}", quote(spelling.text)), std::string(spelling.hint));
      return push(TokenKind::malformed, begin);
    }
    for (const Spelling& symbol : symbols) {
      if (!looking_at(symbol.text)) continue;
      at_ += symbol.text.size();
      return push(symbol.kind, begin);
    }
    const CodePoint code_point = decode_utf8(text_, at_);
    if (code_point.valid && code_point.value == 0) {
      report_zero_bytes();
    } else if (!code_point.valid) {
      report_malformed_utf8();
    } else {
      report_unexpected(code_point);
    }
    push(TokenKind::malformed, begin);
  }

  std::string_view text_;
  std::uint32_t file_;
  Diagnostics& diagnostics_;
  TokenList list_;
  std::size_t at_ = 0;
  std::uint32_t line_ = 1;
  bool line_is_fresh_ = true;
  bool given_up_ = false;
  int errors_ = 0;
};

}  // namespace

TokenList lex(const SourceMap& sources, std::uint32_t file, Diagnostics& diagnostics) {
  return Lexer(sources.file(file).text, file, diagnostics).run();
}

std::string_view spelling(TokenKind kind) {
  const auto has_kind = [kind](const Spelling& s) { return s.kind == kind; };
  if (const auto* s = std::find_if(keywords.begin(), keywords.end(), has_kind); s != keywords.end()) return s->text;
  if (const auto* s = std::find_if(symbols.begin(), symbols.end(), has_kind); s != symbols.end()) return s->text;
  return {};
}

bool is_keyword(TokenKind kind) { return kind >= TokenKind::keyword_predicate; }

std::string quote(std::string_view text) {
  constexpr std::size_t longest = 60;
  if (text.size() <= longest) return fmt::format("`{}`", text);
  std::size_t end = longest - 3;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // between two characters
  return fmt::format("`{}...`", text.substr(0, end));
}

}  // namespace tightrope::dsl
