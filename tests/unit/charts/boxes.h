#pragma once
/// Boxes that must not overlap.

#include <string>
#include <vector>

#include "codegen/charts/layout.h"

namespace tightrope::charts {

/// "'safe' and 'tight'", for the first two texts that overlap; "" if none do.
inline std::string overlapping(const std::vector<Text>& texts) {
  for (std::size_t a = 0; a < texts.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (overlap(texts[a].box(), texts[b].box())) return "'" + texts[b].text + "' and '" + texts[a].text + "'";
    }
  }
  return "";
}

/// The first text that covers a marker, or that leaves the page; "" if there is none.
inline std::string misplaced(const Layout& layout) {
  const Box page{0, 0, page_width, layout.height};
  for (const Text& text : layout.texts) {
    if (!page.contains(text.box())) return "'" + text.text + "' leaves the page";
    for (const PanelLayout& panel : layout.panels) {
      for (const DatumPlace& datum : panel.data) {
        if (overlap(text.box(), box_around(datum.place, 2 * marker_radius, 2 * marker_radius))) {
          return "'" + text.text + "' covers a marker";
        }
      }
    }
  }
  return "";
}

}  // namespace tightrope::charts
