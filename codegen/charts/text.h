#pragma once
/// Text as it will be drawn: how wide, broken into lines, safe to write into other languages.

#include <string>
#include <string_view>
#include <vector>

namespace tightrope::charts {

/// Pixels, at a font size in pixels, at most: the widths of DejaVu Sans, wider than what most systems call sans-serif.
/// Characters beyond ASCII count as the widest.
double text_width(std::string_view text, double size);

/// Lines that are no wider than `width`, broken at spaces. A longer word stands alone.
std::vector<std::string> wrapped(std::string_view text, double width, double size);

/// Valid UTF-8 without control characters: bytes that are no such thing become '?', controls become spaces.
std::string printable(std::string_view text);

/// For XML and HTML, in text and in attributes.
std::string escaped(std::string_view text);

}  // namespace tightrope::charts
