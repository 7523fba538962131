#pragma once
/// Colours, markers and lines that differ in colour, in shape and in print.

#include <cstddef>
#include <cstdint>
#include <string>

namespace tightrope::charts {

enum class Shape { circle, square, triangle, inverted_triangle, diamond, pentagon, asterisk };

/// How a series looks: a colour of Okabe and Ito's palette (2008), which colour-blind readers tell apart, and a shape.
struct Style {
  std::uint32_t colour = 0;  ///< 0xRRGGBB
  Shape shape = Shape::circle;
  bool filled = true;  ///< the asterisk: a plain plus if not
};

enum class Line { none, solid, dashed, dotted };

/// The i-th of seven looks, again from the first on after them. Vermillion is not among them: it says "wrong".
Style style_of(std::size_t i);

inline constexpr std::uint32_t alarm_colour = 0xC00000;
inline constexpr std::uint32_t text_colour = 0x000000;
inline constexpr std::uint32_t faint_colour = 0x707070;
inline constexpr double marker_radius = 5.5;  ///< pixels
inline constexpr double marker_reach = 7.8;   ///< of the corners of a diamond
inline constexpr double cross_radius = 10;    ///< of rings, too

std::string colour_text(std::uint32_t colour);  ///< "#0072B2"

}  // namespace tightrope::charts
