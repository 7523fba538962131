#include "codegen/charts/style.h"

#include <fmt/format.h>

#include <array>

namespace tightrope::charts {

Style style_of(std::size_t i) {
  static constexpr std::array<Style, 7> styles = {{
      {0x666666, Shape::asterisk},
      {0xE69F00, Shape::square},
      {0x0072B2, Shape::circle},
      {0x009E73, Shape::diamond},
      {0x56B4E9, Shape::inverted_triangle},
      {0xCC79A7, Shape::pentagon},
      {0x000000, Shape::triangle},
  }};
  return styles[i % styles.size()];
}

std::string colour_text(std::uint32_t colour) { return fmt::format("#{:06X}", colour); }

}  // namespace tightrope::charts
