#pragma once
/// UTF-8, as the lexer checks it and as diagnostics show it.

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tightrope::dsl {

struct CodePoint {
  std::uint32_t value = 0;
  std::size_t length = 1;  ///< bytes taken; 1 for a malformed byte
  bool valid = false;      ///< false: the byte at the offset starts no well-formed sequence (RFC 3629)
};

/// The code point at byte `offset` < text.size(). Overlong forms, surrogates and values above U+10FFFF are malformed.
CodePoint decode_utf8(std::string_view text, std::size_t offset);

/// Terminal columns of a printable code point: 0 (combining), 1, or 2 (wide East Asian characters and emoji).
int display_width(std::uint32_t code_point);

/// Control characters and the invisible ones that reorder text: shown escaped, never sent to a terminal.
bool needs_escape(std::uint32_t code_point);

}  // namespace tightrope::dsl
