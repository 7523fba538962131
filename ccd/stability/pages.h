#pragma once
/// The atlas as pages of heat maps.

#include <string>
#include <vector>

#include "codegen/charts/heat_map.h"
#include "stability/atlas.h"

namespace tightrope::ccd::stability {

struct Page {
  std::string file;  ///< name without extension
  std::string link;  ///< in a list of pages
  Kind kind{};
  Real real{};
  std::string method;  ///< empty: the overview of all methods
  charts::HeatMapPage maps;
};

/// Per kind and type an overview (a row a family, a column a method; in each map distance over scale, all offsets
/// together; false alarms, and misses in red), then a page a method (a column a figure; in each map distance over
/// offset and scale).
std::vector<Page> pages(const Atlas& atlas);

}  // namespace tightrope::ccd::stability
