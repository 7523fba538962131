#pragma once
/// Where everything in a chart stands.

#include <optional>
#include <string>
#include <vector>

#include "codegen/charts/chart.h"
#include "codegen/charts/geometry.h"
#include "codegen/charts/labels.h"
#include "codegen/charts/ticks.h"

namespace tightrope::charts {

inline constexpr double page_width = 800;
inline constexpr double font_size = 12;

struct Text {
  enum class Anchor { left, middle, right };
  std::string text;
  Place at;  ///< height: its middle
  Anchor anchor = Anchor::left;
  double size = font_size;
  std::string exponent = {};  ///< raised behind the text
  bool upright = false;       ///< turned to the left by a right angle
  std::uint32_t colour = text_colour;

  Box box() const;  ///< what it covers at most
};

/// From values to pixels.
struct Scale {
  double low = 1;  ///< values at the ends of the frame
  double high = 10;
  double first = 0;  ///< pixels at the ends
  double last = 1;

  double at(double value) const;
};

struct DatumPlace {
  std::size_t series = 0;
  std::size_t datum = 0;
  Place place;
};

struct PanelLayout {
  Box frame;
  Scale x;
  Scale y;
  std::optional<Box> zero_band;
  double zero = 0;  ///< the value of y that stands for 0
  std::vector<Tick> x_ticks;
  std::vector<Tick> y_ticks;
  std::vector<DatumPlace> data;  ///< those with markers
  std::vector<Segment> leaders;
};

struct LegendMark {
  enum class Kind { marker, ring, cross };
  Place at;
  Kind kind = Kind::marker;
  Style style = {};
};

struct LegendLine {
  Segment segment;
  Style style;
  Line line = Line::solid;
};

struct Layout {
  double height = 0;  ///< its width is page_width
  std::vector<PanelLayout> panels;
  std::vector<Text> texts;  ///< all that is written, labels and ticks included
  std::vector<LegendMark> legend_marks;
  std::vector<LegendLine> legend_lines;
  int labels_left_out = 0;  ///< there was no room
};

Layout layout(const Chart& chart);

}  // namespace tightrope::charts
