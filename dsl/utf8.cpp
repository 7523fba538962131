#include "dsl/utf8.h"

#include <algorithm>
#include <array>

namespace tightrope::dsl {

CodePoint decode_utf8(std::string_view text, std::size_t offset) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])); };
  const std::uint32_t lead = byte(offset);
  if (lead < 0x80) return {lead, 1, true};
  const CodePoint malformed{lead, 1, false};
  // 0x80..0xC1 continue a sequence or would start an overlong one; nothing starts with 0xF5 or above.
  if (lead < 0xC2 || lead > 0xF4) return malformed;
  const std::size_t length = lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  if (text.size() - offset < length) return malformed;
  std::uint32_t value = lead & (0xFFu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    const std::uint32_t continuation = byte(offset + i);
    if ((continuation & 0xC0) != 0x80) return malformed;
    value = (value << 6) | (continuation & 0x3F);
  }
  const bool overlong = (length == 3 && value < 0x800) || (length == 4 && value < 0x10000);
  const bool surrogate = value >= 0xD800 && value <= 0xDFFF;
  if (overlong || surrogate || value > 0x10FFFF) return malformed;
  return {value, length, true};
}

namespace {

struct Interval {
  std::uint32_t first, last;
};

template <std::size_t n>
bool contains(const std::array<Interval, n>& intervals, std::uint32_t c) {
  return std::any_of(intervals.begin(), intervals.end(), [c](Interval i) { return c >= i.first && c <= i.last; });
}

}  // namespace

int display_width(std::uint32_t c) {
  if (c < 0x300) return 1;
  constexpr std::array<Interval, 6> combining{
      {{0x300, 0x36F}, {0x1AB0, 0x1AFF}, {0x1DC0, 0x1DFF}, {0x20D0, 0x20FF}, {0xFE00, 0xFE0F}, {0xFE20, 0xFE2F}}};
  if (contains(combining, c)) return 0;
  constexpr std::array<Interval, 9> wide{{{0x1100, 0x115F},
                                          {0x2E80, 0x303E},
                                          {0x3041, 0xA4CF},
                                          {0xAC00, 0xD7A3},
                                          {0xF900, 0xFAFF},
                                          {0xFE30, 0xFE6F},
                                          {0xFF00, 0xFF60},
                                          {0x1F300, 0x1FAFF},
                                          {0x20000, 0x3FFFD}}};
  return contains(wide, c) ? 2 : 1;
}

bool needs_escape(std::uint32_t c) {
  constexpr std::array<Interval, 7> unprintable{{{0x00, 0x1F},
                                                 {0x7F, 0x9F},
                                                 {0x200B, 0x200F},
                                                 {0x2028, 0x202E},
                                                 {0x2060, 0x206F},
                                                 {0xFEFF, 0xFEFF},
                                                 {0xFFF9, 0xFFFB}}};
  return contains(unprintable, c);
}

}  // namespace tightrope::dsl
