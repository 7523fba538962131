#pragma once
/// Text to tokens.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dsl/diagnostic.h"

namespace tightrope::dsl {

enum class TokenKind : std::uint8_t {
  identifier,
  number,
  string,     ///< "...", the quotes included
  malformed,  ///< reported by the lexer; whoever meets it reports nothing more
  end,        ///< behind the last token, empty

  plus,
  minus,
  star,
  slash,
  caret,
  left_parenthesis,
  right_parenthesis,
  left_bracket,
  right_bracket,
  left_brace,
  right_brace,
  comma,
  semicolon,
  colon,
  equals,
  less_or_equal,
  bar,
  dot,
  dot_dot,

  keyword_predicate,  ///< the first keyword
  keyword_function,
  keyword_instance,
  keyword_import,
  keyword_stage,
  keyword_let,
  keyword_sign,
  keyword_value,
  keyword_for,
  keyword_in,
  keyword_range,
  keyword_group,
  keyword_property,
  keyword_of,
  keyword_as,
  keyword_return,
  keyword_bounded,
  keyword_moving,
  keyword_static,
  keyword_scalar,
  keyword_vec2,
  keyword_vec3,
  keyword_point,
  keyword_point2,
  keyword_at,  ///< the last keyword; an operator between operands, a name anywhere else
};

struct Token {
  TokenKind kind = TokenKind::end;
  bool starts_line = false;  ///< the first token of its line
  std::uint32_t line = 1;    ///< from 1
  std::uint32_t begin = 0, end = 0;
};

/// The tokens of a file, `end` last, and its `//` comments (slashes included) in order.
struct TokenList {
  std::vector<Token> tokens;
  std::vector<Token> line_comments;  ///< kind is of no meaning
  bool complete = true;              ///< false: the lexer gave the file up
};

/// Malformed text (UTF-8, numbers, characters of no meaning here, open comments and strings) is reported and becomes
/// `malformed` tokens. A file with very many such errors, or larger than `max_file_size`, is given up.
TokenList lex(const SourceMap& sources, std::uint32_t file, Diagnostics& diagnostics);

inline constexpr std::size_t max_file_size = std::size_t{1} << 24;

/// After so many errors the lexer, and likewise the parser, stops.
inline constexpr int max_errors = 1000;

/// "predicate", "(", ...; for the kinds that have one spelling.
std::string_view spelling(TokenKind kind);

bool is_keyword(TokenKind kind);

/// A piece of source text in back quotes for a message; long text is cut.
std::string quote(std::string_view text);

}  // namespace tightrope::dsl
