#pragma once
/// A page of small heat maps, all of one shape, as SVG. Cells are exact rectangles, which scale to any size.

#include <cstdint>
#include <string>
#include <vector>

namespace tightrope::charts {

/// A class of cells, and a line of the legend.
struct CellClass {
  std::string text;
  std::uint32_t colour = 0;
  bool hatched = false;  ///< nothing to be told: lines in place of the colour
};

/// One small heat map.
struct HeatMap {
  std::vector<std::uint8_t> cells;  ///< indices of classes, row by row from the top
  std::string note = {};            ///< short, above its right end, in the colour of alarm
};

/// A label at a cell of an axis.
struct CellLabel {
  double cell = 0;  ///< its middle: 0 is the first cell
  std::string text;
};

struct HeatMapPage {
  std::string name;  ///< letters, digits and hyphens: makes the ids of the page's parts unique in a document
  std::string title;
  std::string subtitle;
  std::string caption;  ///< below the maps
  std::vector<CellClass> classes;
  std::vector<std::string> columns;  ///< heads
  std::vector<std::string> rows;
  std::vector<HeatMap> maps;  ///< row by row, columns.size() * rows.size() of them
  std::size_t cell_columns = 0;
  std::size_t cell_rows = 0;
  std::size_t group = 0;  ///< a line stands after every `group` columns of cells; 0: none
  std::vector<CellLabel> x_labels;
  std::vector<CellLabel> y_labels;
  std::string x_title;
  std::string y_title;
};

/// The picture, 800 pixels wide, without XML declaration, so that it can stand in a page of HTML as it is. Its cells
/// have the classes k0, k1, .. of CSS, texts the class ink, lines the class rule, the background the class paper; each
/// map is a group of class `map` that ends with a rectangle of class `frame` around its cells. The bytes depend on the
/// page alone.
std::string heat_map_svg(const HeatMapPage& page);

}  // namespace tightrope::charts
