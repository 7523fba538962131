#include "dsl/token_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "dsl/ast.h"

namespace tightrope::dsl {

namespace {

template <std::size_t n>
bool contains(const std::array<TokenKind, n>& kinds, TokenKind kind) {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

}  // namespace

TokenCursor::TokenCursor(std::string_view text, std::uint32_t file, std::vector<Token> tokens, Diagnostics& diagnostics)
    : text_(text), file_(file), tokens_(std::move(tokens)), diagnostics_(diagnostics) {}

const Token& TokenCursor::peek(std::size_t ahead) const { return tokens_[std::min(at_ + ahead, tokens_.size() - 1)]; }

const Token& TokenCursor::previous() const { return tokens_[at_ > 0 ? at_ - 1 : 0]; }

const Token& TokenCursor::take() {
  const Token& token = tokens_[at_];
  if (token.kind != TokenKind::end) ++at_;
  return token;
}

bool TokenCursor::accept(TokenKind wanted) {
  if (kind() != wanted) return false;
  take();
  return true;
}

bool TokenCursor::at_name(std::size_t ahead) const {
  return kind(ahead) == TokenKind::identifier || kind(ahead) == TokenKind::keyword_at;
}

SourceSpan TokenCursor::since(std::uint32_t begin) const { return {file_, begin, std::max(begin, previous().end)}; }

void TokenCursor::error(SourceSpan span, std::string message, std::string hint) {
  if (errors_ == max_errors) return;
  diagnostics_.error(span, std::move(message), std::move(hint));
  if (++errors_ == max_errors) at_ = tokens_.size() - 1;
  last_error_at_ = at_;
}

void TokenCursor::expected(std::string_view what, std::string hint) {
  if (!peek().starts_line || at_ == 0) return expected_here(what, std::move(hint));
  if (last_error_at_ == at_ || kind() == TokenKind::malformed) return;
  const std::uint32_t end = previous().end;
  error({file_, end, end}, fmt::format("expected {}{}", what, at_end() ? ", but the file ends here" : ""),
        std::move(hint));
}

void TokenCursor::expected_here(std::string_view what, std::string hint) {
  if (last_error_at_ == at_ || kind() == TokenKind::malformed) return;
  const Token& token = peek();
  const std::string found = token.kind == TokenKind::string ? "a string" : quote(text(token));
  error(span(token), fmt::format("expected {}, found {}", what, found), std::move(hint));
}

bool TokenCursor::expect(TokenKind wanted, std::string hint) {
  if (accept(wanted)) return true;
  expected(fmt::format("`{}`", spelling(wanted)), std::move(hint));
  return false;
}

bool TokenCursor::expect_close(TokenKind close, const Token& open) {
  if (accept(close)) return true;
  const std::uint32_t line = peek().starts_line ? previous().line : peek().line;
  expected(fmt::format("`{}` to close the `{}`{}", spelling(close), spelling(open.kind),
                       open.line == line ? "" : fmt::format(" of line {}", open.line)));
  return false;
}

const Token* TokenCursor::expect_name(std::string_view what) {
  if (at_name()) return &take();
  if (is_keyword(kind()) && !peek().starts_line) {
    if (last_error_at_ != at_) {
      error(span(peek()), fmt::format("{} is a keyword and cannot be a name", quote(text(peek()))));
    }
    return &take();
  }
  expected(what);
  return nullptr;
}

TokenKind TokenCursor::nearest(std::span<const TokenKind> keywords) const {
  std::vector<std::string_view> spellings;
  for (const TokenKind keyword : keywords) spellings.push_back(spelling(keyword));
  const std::string_view closest = closest_name(text(peek()), spellings);
  for (const TokenKind keyword : keywords) {
    if (!closest.empty() && spelling(keyword) == closest) return keyword;
  }
  return TokenKind::identifier;
}

bool TokenCursor::enter(std::string_view hint) {
  if (depth_ < max_nesting) {
    ++depth_;
    return true;
  }
  if (last_error_at_ != at_) {
    error(span(peek()), fmt::format("this is nested more than {} levels deep", max_nesting), std::string(hint));
  }
  return false;
}

bool TokenCursor::at_declaration() const { return contains(declaration_keywords, kind()); }

/// `for i in a..b {`: a `{` comes before anything that a loop's head cannot hold.
bool TokenCursor::heads_loop() const {
  int open = 0;
  for (std::size_t ahead = 1;; ++ahead) {
    const TokenKind k = kind(ahead);
    if (k == TokenKind::left_brace) return true;
    if (k == TokenKind::left_bracket || k == TokenKind::left_parenthesis) ++open;
    const bool closes = k == TokenKind::right_bracket || k == TokenKind::right_parenthesis;
    if (closes && --open < 0) return false;
    if (k == TokenKind::end || k == TokenKind::right_brace || k == TokenKind::semicolon ||
        contains(statement_keywords, k) || contains(declaration_keywords, k)) {
      return false;
    }
  }
}

/// `normalize a`: a word that is a statement's first only before a name, so that functions may be called so.
bool TokenCursor::at_normalize() const {
  return kind() == TokenKind::identifier && text(peek()) == "normalize" && kind(1) == TokenKind::identifier;
}

bool TokenCursor::at_statement() const {
  if (at_normalize()) return true;
  if (kind() == TokenKind::keyword_for) return heads_loop();  // not the one of a comprehension
  return contains(statement_keywords, kind()) || at_declaration();
}

/// After an error a keyword in the middle of a line may be a name of the user's; one that begins a line is a statement,
/// and so is a misspelt one, or `x = ...`.
bool TokenCursor::looks_like_statement() const {
  const TokenKind before = previous().kind;
  const bool fresh = peek().starts_line || before == TokenKind::semicolon || before == TokenKind::left_brace ||
                     before == TokenKind::right_brace;
  if (!fresh) return at_declaration();
  if (at_statement()) return true;
  if (kind() != TokenKind::identifier) return false;
  return kind(1) == TokenKind::equals || (at_name(1) && nearest(statement_keywords) != TokenKind::identifier);
}

bool TokenCursor::looks_like_declaration() const {
  if (at_declaration()) return true;
  return kind() == TokenKind::identifier && peek().starts_line && (at_name(1) || kind(1) == TokenKind::string) &&
         nearest(declaration_keywords) != TokenKind::identifier;
}

void TokenCursor::skip_to_statement() {
  while (!at_end() && kind() != TokenKind::right_brace && !looks_like_statement()) {
    // A `;` ends the statement, unless more of it follows on the line: `[a; b]`.
    if (accept(TokenKind::semicolon) && (peek().starts_line || at_statement())) return;
    if (kind() == TokenKind::left_brace) {
      skip_block();
    } else {
      take();
    }
  }
}

void TokenCursor::skip_to_declaration() {
  while (!at_end() && !looks_like_declaration()) {
    if (kind() == TokenKind::left_brace) {
      skip_block();
    } else {
      take();
    }
  }
}

bool TokenCursor::skip_to_block() {
  const std::size_t from = at_;
  while (!at_end() && kind() != TokenKind::right_brace && kind() != TokenKind::semicolon && !at_statement()) {
    if (kind() == TokenKind::left_brace) return true;
    take();
  }
  at_ = from;
  return false;
}

void TokenCursor::skip_block() {
  int open = 0;
  while (!at_end() && !at_declaration()) {
    if (kind() == TokenKind::left_brace) ++open;
    const bool closes = kind() == TokenKind::right_brace;
    take();
    if (closes && --open == 0) return;
  }
}

}  // namespace tightrope::dsl
