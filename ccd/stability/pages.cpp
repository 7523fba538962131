#include "stability/pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "stability/rates.h"

namespace tightrope::ccd::stability {
namespace {

// Classes of cells, by their places in the legend.
constexpr std::uint8_t nothing = 0;
constexpr std::uint8_t zero = 1;
constexpr std::array<double, 5> limits = {0.02, 0.1, 0.3, 0.6, 1};  ///< of the blue ones that follow
constexpr std::uint8_t first_blue = 2;
constexpr std::uint8_t missed = first_blue + limits.size();

std::vector<charts::CellClass> classes() {
  constexpr std::array<std::uint32_t, limits.size()> blues = {0xC9DDF0, 0x8FBBDF, 0x4A8FC6, 0x1B5E9E, 0x072F5F};
  std::vector<charts::CellClass> result = {{"nothing to count", 0xFFFFFF, true}, {"0", 0xFFFFFF}};
  for (std::size_t i = 0; i < limits.size(); ++i) {
    result.push_back({fmt::format("up to {:.0f} %", 100 * limits[i]), blues[i]});
  }
  result.push_back({"contacts missed", 0xD00000});
  return result;
}

std::uint8_t class_of(const Rate& rate) {
  if (!rate.known()) return nothing;
  if (rate.count == 0) return zero;
  std::uint8_t i = 0;
  while (rate.value() > limits[i]) ++i;
  return static_cast<std::uint8_t>(first_blue + i);
}

std::string superscript(int number) {
  static constexpr std::array<const char*, 10> digits = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string result;
  for (const char c : std::to_string(number)) result += c == '-' ? "⁻" : digits[static_cast<std::size_t>(c - '0')];
  return result;
}

/// "0", "1", "10^-16", "2^40"
std::string power(double base, double value) {
  if (value == 0 || value == 1) return fmt::format("{}", value);
  const double exponent = std::round(std::log(value) / std::log(base));
  return fmt::format("{}{}", base, superscript(static_cast<int>(exponent)));
}

/// The first, the middle and the last distance; the largest is at the top.
std::vector<charts::CellLabel> distance_labels(const Axes& axes) {
  std::vector<charts::CellLabel> labels;
  const std::size_t last = axes.distances.size() - 1;
  for (const std::size_t row : {std::size_t{0}, last / 2, last}) {
    if (labels.empty() || labels.back().cell < static_cast<double>(row)) {
      labels.push_back({static_cast<double>(row), power(10, axes.distances[last - row])});
    }
  }
  return labels;
}

std::vector<charts::CellLabel> scale_labels(const Axes& axes, Real real) {
  std::vector<charts::CellLabel> labels;
  const std::size_t last = axes.scales.size() - 1;
  for (const std::size_t column : {std::size_t{0}, last}) {
    if (column == 0 && last == 0) continue;
    labels.push_back({static_cast<double>(column), "2" + superscript(scale_exponent(axes.scales[column], real))});
  }
  return labels;
}

std::vector<charts::CellLabel> offset_labels(const Axes& axes) {
  std::vector<charts::CellLabel> labels;
  const auto group = static_cast<double>(axes.scales.size());
  for (std::size_t i = 0; i < axes.offsets.size(); ++i) {
    labels.push_back({group * (static_cast<double>(i) + 0.5) - 0.5, power(2, axes.offsets[i])});
  }
  return labels;
}

std::string scale_range(const Axes& axes, Real real) {
  return fmt::format("2{} to 2{}", superscript(scale_exponent(axes.scales.front(), real)),
                     superscript(scale_exponent(axes.scales.back(), real)));
}

/// What the pages of one kind and type have in common.
charts::HeatMapPage blank_page(const Atlas& atlas, std::span<const Map* const> maps) {
  charts::HeatMapPage page;
  page.classes = classes();
  page.cell_rows = atlas.axes.distances.size();
  page.y_labels = distance_labels(atlas.axes);
  page.y_title = "distance (of size)";
  for (const Map* map : maps) page.rows.push_back(map->family);
  return page;
}

std::string note(std::uint64_t misses) {
  if (misses == 0) return "";
  return misses < 10'000 ? fmt::format("{} missed", misses) : fmt::format("{}k missed", misses / 1000);
}

/// Distance over scale; false alarms of all offsets together, or misses.
charts::HeatMap overview_map(const Axes& axes, const Map& map, const MethodCounts& method) {
  charts::HeatMap result;
  for (std::size_t d = axes.distances.size(); d-- > 0;) {
    for (std::size_t s = 0; s < axes.scales.size(); ++s) {
      Rate misses, alarms;
      for (std::size_t o = 0; o < axes.offsets.size(); ++o) {
        misses += rate(Figure::misses, map, method, axes.cell(o, d, s));
        alarms += rate(Figure::false_alarms, map, method, axes.cell(o, d, s));
      }
      result.cells.push_back(misses.count > 0 ? missed : class_of(alarms));
    }
  }
  result.note = note(rate(Figure::misses, map, method).count);
  return result;
}

/// Distance over offset and, in each offset, scale.
charts::HeatMap figure_map(Figure figure, const Axes& axes, const Map& map, const MethodCounts& method) {
  charts::HeatMap result;
  for (std::size_t d = axes.distances.size(); d-- > 0;) {
    for (std::size_t o = 0; o < axes.offsets.size(); ++o) {
      for (std::size_t s = 0; s < axes.scales.size(); ++s) {
        const Rate cell = rate(figure, map, method, axes.cell(o, d, s));
        result.cells.push_back(figure == Figure::misses && cell.count > 0 ? missed : class_of(cell));
      }
    }
  }
  if (figure == Figure::misses) result.note = note(rate(figure, map, method).count);
  return result;
}

std::string where(Kind kind, Real real) { return fmt::format("{}, {}", name(kind), name(real)); }

Page overview(const Atlas& atlas, Kind kind, Real real, std::span<const Map* const> maps) {
  const Axes& axes = atlas.axes;
  Page page{.file = fmt::format("overview-{}-{}", name(kind), name(real)),
            .link = "all methods",
            .kind = kind,
            .real = real,
            .method = {},
            .maps = blank_page(atlas, maps)};
  charts::HeatMapPage& drawn = page.maps;
  drawn.title = fmt::format("Where each method fails: {}", where(kind, real));
  drawn.subtitle = "Rate of false alarms among queries without contact; red where a contact was missed.";
  drawn.caption = fmt::format(
      "Each map: distance from degeneracy (0 below, {} of the query's size at the top) over the scene's scale ({}), "
      "all "
      "offsets from the origin together; {} queries a cell and offset, truth by exact arithmetic.",
      power(10, axes.distances.back()), scale_range(axes, real), atlas.queries);
  drawn.cell_columns = axes.scales.size();
  drawn.x_labels = scale_labels(axes, real);
  drawn.x_title = "scale of the scene";
  for (const AtlasMethod& method : atlas.methods) drawn.columns.push_back(method.name);
  for (const Map* map : maps) {
    for (const MethodCounts& method : map->methods) drawn.maps.push_back(overview_map(axes, *map, method));
  }
  return page;
}

Page method_page(const Atlas& atlas, Kind kind, Real real, std::span<const Map* const> maps, std::size_t m) {
  const Axes& axes = atlas.axes;
  const AtlasMethod& method = atlas.methods[m];
  Page page{.file = fmt::format("{}-{}-{}", method.name, name(kind), name(real)),
            .link = method.name,
            .kind = kind,
            .real = real,
            .method = method.name,
            .maps = blank_page(atlas, maps)};
  charts::HeatMapPage& drawn = page.maps;
  drawn.title = fmt::format("{}: {}", method.name, where(kind, real));
  drawn.subtitle = fmt::format("{}{}", method.conservative ? "Promises to miss no contact" : "Promises nothing",
                               method.exact ? ", and to claim none that is not there." : ".");
  drawn.caption = fmt::format(
      "Each map: distance from degeneracy (0 below, {} of the query's size at the top) over the distance from the "
      "origin, "
      "in sizes, and in each of its columns over the scene's scale, {}. {} queries a cell, truth by exact arithmetic. "
      "Misses are of contacts, false alarms of queries without contact, uncertain signs of all signs read{}.",
      power(10, axes.distances.back()), scale_range(axes, real), atlas.queries,
      maps.front()->methods[m].exact.empty() ? "" : ", exact arithmetic of all queries");
  drawn.cell_columns = axes.offsets.size() * axes.scales.size();
  drawn.group = axes.scales.size();
  drawn.x_labels = offset_labels(axes);
  drawn.x_title = "distance from the origin";
  std::vector<Figure> figures(all_figures.begin(), all_figures.end());
  if (maps.front()->methods[m].exact.empty()) std::erase(figures, Figure::exact);
  for (const Figure figure : figures) drawn.columns.emplace_back(name(figure));
  for (const Map* map : maps) {
    for (const Figure figure : figures) drawn.maps.push_back(figure_map(figure, axes, *map, map->methods[m]));
  }
  return page;
}

}  // namespace

std::vector<Page> pages(const Atlas& atlas) {
  std::vector<Page> result;
  for (const Real real : {Real::in_double, Real::in_float}) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      std::vector<const Map*> maps;
      for (const Map& map : atlas.maps) {
        if (map.kind == kind && map.real == real) maps.push_back(&map);
      }
      if (maps.empty()) continue;
      result.push_back(overview(atlas, kind, real, maps));
      for (std::size_t m = 0; m < atlas.methods.size(); ++m) {
        result.push_back(method_page(atlas, kind, real, maps, m));
      }
    }
  }
  for (Page& page : result) page.maps.name = page.file;
  return result;
}

}  // namespace tightrope::ccd::stability
