#pragma once
/// The parser's place in the token list, and its way of saying what it expected there.

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dsl/lexer.h"

namespace tightrope::dsl {

inline constexpr std::array statement_keywords = {
    TokenKind::keyword_let,      TokenKind::keyword_sign,   TokenKind::keyword_value,
    TokenKind::keyword_for,      TokenKind::keyword_stage,  TokenKind::keyword_range,
    TokenKind::keyword_property, TokenKind::keyword_return, TokenKind::keyword_group};

inline constexpr std::array declaration_keywords = {TokenKind::keyword_predicate, TokenKind::keyword_function,
                                                    TokenKind::keyword_instance, TokenKind::keyword_import};

class TokenCursor {
 public:
  TokenCursor(std::string_view text, std::uint32_t file, std::vector<Token> tokens, Diagnostics& diagnostics);

  const Token& peek(std::size_t ahead = 0) const;
  TokenKind kind(std::size_t ahead = 0) const { return peek(ahead).kind; }
  /// The token before the current one (the current one at the file's begin).
  const Token& previous() const;
  const Token& take();
  bool accept(TokenKind kind);
  bool at_end() const { return kind() == TokenKind::end; }
  /// An identifier, or `at`, which is a name wherever no operator can stand.
  bool at_name(std::size_t ahead = 0) const;
  std::string_view text(const Token& token) const { return text_.substr(token.begin, token.end - token.begin); }
  SourceSpan span(const Token& token) const { return {file_, token.begin, token.end}; }
  /// From byte `begin` to the end of the last token taken.
  SourceSpan since(std::uint32_t begin) const;

  void error(SourceSpan span, std::string message, std::string hint = {});
  /// "expected WHAT, found `x`" at the current token; behind the previous token when the current one is on a later
  /// line. Says nothing at a malformed token, and nothing twice at one token.
  void expected(std::string_view what, std::string hint = {});
  /// The same, always at the current token.
  void expected_here(std::string_view what, std::string hint = {});
  bool expect(TokenKind kind, std::string hint = {});
  /// Closes what `open` opened: "expected `)` to close the `(` of line 3".
  bool expect_close(TokenKind close, const Token& open);
  /// A name, or nullptr and "expected WHAT"; a keyword in its place is reported and taken.
  const Token* expect_name(std::string_view what);

  /// Which of `keywords` the name here is nearly; `identifier` if none.
  TokenKind nearest(std::span<const TokenKind> keywords) const;

  /// One level of nesting deeper; false, and an error, where that is more than `max_nesting`.
  bool enter(std::string_view hint);
  void leave() { --depth_; }

  /// At `let`, `sign`, ... or a declaration's keyword; a `for` only if it heads a loop (not a comprehension).
  bool at_normalize() const;
  bool at_statement() const;
  bool at_declaration() const;
  /// To what looks like the next statement, to the `}` of this block or to the next declaration; blocks on the way are
  /// stepped over.
  void skip_to_statement();
  /// To the next declaration.
  void skip_to_declaration();
  /// To the `{` that this statement or declaration still has; false, and not moved, if it has none.
  bool skip_to_block();
  /// From a `{` over its block.
  void skip_block();

 private:
  bool heads_loop() const;
  bool looks_like_statement() const;
  bool looks_like_declaration() const;

  std::string_view text_;
  std::uint32_t file_;
  std::vector<Token> tokens_;
  Diagnostics& diagnostics_;
  std::size_t at_ = 0;
  std::size_t last_error_at_ = static_cast<std::size_t>(-1);
  int depth_ = 0;
  int errors_ = 0;
};

/// One level of nesting, as long as it lives.
class Nesting {
 public:
  explicit Nesting(TokenCursor& cursor, std::string_view hint = "name a part of it with `let`")
      : cursor_(cursor), entered_(cursor.enter(hint)) {}
  Nesting(const Nesting&) = delete;
  Nesting& operator=(const Nesting&) = delete;
  ~Nesting() {
    if (entered_) cursor_.leave();
  }
  explicit operator bool() const { return entered_; }

 private:
  TokenCursor& cursor_;
  bool entered_;
};

}  // namespace tightrope::dsl
