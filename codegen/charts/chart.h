#pragma once
/// What a chart shows, before it has places and sizes: panels of series over logarithmic axes.

#include <string>
#include <vector>

#include "codegen/charts/style.h"

namespace tightrope::charts {

/// One line of what a reader sees about a datum: "false positives", "33".
struct Fact {
  std::string name;
  std::string value;
};

struct Datum {
  double x = 0;                  ///< positive
  double y = 0;                  ///< positive, or 0: drawn in the band of zeros
  std::string label = {};        ///< beside the marker; empty: none
  std::string alarm = {};        ///< not empty: a red cross over the marker, and this text behind the label
  bool ring = false;             ///< a ring around the marker: chosen
  std::vector<Fact> facts = {};  ///< shown by the HTML page
};

struct Series {
  std::string name;
  Style style = {};
  Line line = Line::none;  ///< that joins the data
  bool markers = true;
  std::vector<Datum> data = {};
};

struct Panel {
  std::string name;  ///< short, for tables
  std::string title;
  std::vector<Series> series;
};

/// Logarithmic.
struct Axis {
  std::string title;
  bool shared = true;      ///< of y: all panels have the same range; x always is shared
  bool zero_band = false;  ///< of y: there is a band for zeros, also where no datum is 0
  double least = 0;        ///< of y: the least value above 0 that could be met, for charts where nothing is above 0
};

/// A line of the legend: markers, a piece of a line, the ring, the red cross, and what they mean.
struct LegendEntry {
  std::string text;
  std::vector<Style> markers = {};
  Style style = {};
  Line line = Line::none;
  bool ring = false;
  bool alarm = false;
};

struct Chart {
  std::string title;
  std::string subtitle;
  std::string caption;  ///< what is what, below the panels
  Axis x;
  Axis y;
  std::vector<Panel> panels;  ///< at least one
  std::vector<LegendEntry> legend;
};

}  // namespace tightrope::charts
