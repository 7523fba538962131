#include "codegen/charts/heat_map.h"

#include <fmt/format.h>

#include <algorithm>

#include "codegen/charts/style.h"
#include "codegen/charts/text.h"

namespace tightrope::charts {
namespace {

constexpr double width = 800;
constexpr double margin = 12;
constexpr double body_size = 12;
constexpr double small_size = 10;
constexpr double column_gap = 10;
constexpr double row_gap = 18;    // the notes stand in it
constexpr double tick_room = 40;  // for the labels of the rows of cells
constexpr double least_map_height = 60;

class Picture {
 public:
  explicit Picture(const HeatMapPage& page) : page_(page) {
    for (const std::string& row : page.rows) left_ = std::max(left_, text_width(printable(row), body_size));
    left_ += margin + tick_room;
    const auto columns = static_cast<double>(page.columns.size());
    map_width_ = (width - margin - left_ - column_gap * (columns - 1)) / columns;
    const auto cell_rows = static_cast<double>(page.cell_rows);
    cell_height_ = std::max(5.0, least_map_height / cell_rows);
    cell_width_ = map_width_ / static_cast<double>(page.cell_columns);
    map_height_ = cell_height_ * cell_rows;
  }

  std::string text() {
    add_head();
    add_legend();
    add_column_heads();
    for (std::size_t row = 0; row < page_.rows.size(); ++row) add_row(row);
    add_x_labels();
    y_ += 8;
    add_paragraph(page_.caption, small_size);
    const double height = y_ + margin;
    return fmt::format(
               "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
               "{1:.0f}\" font-family=\"DejaVu Sans, Verdana, sans-serif\" role=\"img\">\n<title>{2}</title>\n",
               width, height, escaped(printable(page_.title))) +
           hatching() +
           fmt::format("<rect class=\"paper\" width=\"{:.0f}\" height=\"{:.0f}\" fill=\"#FFFFFF\"/>\n", width, height) +
           body_ + "</svg>\n";
  }

 private:
  std::string hatching() const {
    return fmt::format(
        "<defs><pattern id=\"{}-hatching\" width=\"4\" height=\"4\" patternUnits=\"userSpaceOnUse\"><path "
        "class=\"rule\" "
        "d=\"M-1 1l2 -2M0 4l4 -4M3 5l2 -2\" stroke=\"#A0A0A0\" stroke-width=\"0.7\"/></pattern></defs>\n",
        page_.name);
  }

  void add_text(double x, double y, const std::string& text, double size, const char* more = "",
                std::uint32_t colour = text_colour) {
    body_ += fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{:.0f}\" fill=\"{}\"{}>{}</text>\n",
                         colour == alarm_colour ? "alarm" : "ink", x, y, size, colour_text(colour), more,
                         escaped(printable(text)));
  }

  void add_paragraph(const std::string& text, double size) {
    for (const std::string& line : wrapped(printable(text), width - 2 * margin, size)) {
      y_ += size * 1.4;
      add_text(margin, y_, line, size);
    }
  }

  void add_head() {
    y_ = margin + 14;
    add_text(margin, y_, page_.title, 16, " font-weight=\"bold\"");
    y_ += 4;
    add_paragraph(page_.subtitle, body_size);
  }

  std::string look(std::size_t k) const {
    const CellClass& look = page_.classes[k];
    return fmt::format("class=\"k{}\" fill=\"{}\"", k,
                       look.hatched ? fmt::format("url(#{}-hatching)", page_.name) : colour_text(look.colour));
  }

  void add_legend() {
    constexpr double box = 12;
    double x = margin;
    y_ += 10;
    for (std::size_t k = 0; k < page_.classes.size(); ++k) {
      const double needed = box + 5 + text_width(printable(page_.classes[k].text), small_size);
      if (x + needed > width - margin) {
        x = margin;
        y_ += box + 6;
      }
      body_ += fmt::format(
          "<rect {} x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.0f}\" height=\"{:.0f}\" stroke=\"#707070\" "
          "stroke-width=\"0.7\"/>\n",
          look(k), x, y_, box, box);
      add_text(x + box + 5, y_ + box - 2, page_.classes[k].text, small_size);
      x += needed + 16;
    }
    y_ += box + 20;
  }

  double map_left(std::size_t column) const { return left_ + static_cast<double>(column) * (map_width_ + column_gap); }

  void add_column_heads() {
    for (std::size_t column = 0; column < page_.columns.size(); ++column) {
      add_text(map_left(column), y_, page_.columns[column], body_size, " font-weight=\"bold\"");
    }
    add_text(margin, y_, page_.y_title, small_size);
  }

  void add_row(std::size_t row) {
    y_ += row_gap;
    add_text(margin, y_ + body_size, page_.rows[row], body_size);
    for (const CellLabel& label : page_.y_labels) {
      add_text(left_ - 5, y_ + (label.cell + 0.5) * cell_height_ + 3.5, label.text, small_size, " text-anchor=\"end\"");
    }
    for (std::size_t column = 0; column < page_.columns.size(); ++column) {
      add_map(page_.maps[row * page_.columns.size() + column], map_left(column));
    }
    y_ += map_height_;
  }

  void add_map(const HeatMap& map, double x) {
    body_ += "<g class=\"map\" shape-rendering=\"crispEdges\">\n";
    for (std::size_t k = 0; k < page_.classes.size(); ++k) {
      const std::string path = cells_of(map, k, x);
      if (!path.empty()) body_ += fmt::format("<path {} d=\"{}\"/>\n", look(k), path);
    }
    for (std::size_t c = page_.group; page_.group > 0 && c < page_.cell_columns; c += page_.group) {
      body_ += fmt::format("<path class=\"rule\" d=\"M{:.1f} {:.1f}v{:.1f}\" stroke=\"#707070\" stroke-width=\"1\"/>\n",
                           x + static_cast<double>(c) * cell_width_, y_, map_height_);
    }
    body_ += fmt::format(
        "<rect class=\"frame\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"transparent\" "
        "stroke=\"{}\" stroke-width=\"1\"/>\n</g>\n",
        x, y_, map_width_, map_height_, colour_text(map.note.empty() ? faint_colour : alarm_colour));
    if (!map.note.empty()) {
      add_text(x + map_width_, y_ - 4, map.note, small_size, " text-anchor=\"end\" font-weight=\"bold\"", alarm_colour);
    }
  }

  /// The cells of one class, neighbours in a row as one rectangle.
  std::string cells_of(const HeatMap& map, std::size_t k, double x) const {
    std::string path;
    for (std::size_t r = 0; r < page_.cell_rows; ++r) {
      for (std::size_t c = 0; c < page_.cell_columns;) {
        const auto is = [&](std::size_t column) { return map.cells[r * page_.cell_columns + column] == k; };
        std::size_t end = c + 1;
        if (is(c)) {
          while (end < page_.cell_columns && is(end)) ++end;
          path += fmt::format("M{:.2f} {:.2f}h{:.2f}v{:.2f}h{:.2f}z", x + static_cast<double>(c) * cell_width_,
                              y_ + static_cast<double>(r) * cell_height_, static_cast<double>(end - c) * cell_width_,
                              cell_height_, -static_cast<double>(end - c) * cell_width_);
        }
        c = end;
      }
    }
    return path;
  }

  void add_x_labels() {
    y_ += small_size + 4;
    for (std::size_t column = 0; column < page_.columns.size(); ++column) {
      for (const CellLabel& label : page_.x_labels) add_x_label(label, map_left(column));
    }
    y_ += small_size + 4;
    add_text(left_, y_, page_.x_title, small_size);
  }

  /// Below its cell, but not beyond the map.
  void add_x_label(const CellLabel& label, double map) {
    const double half = text_width(printable(label.text), small_size) / 2;
    const double at = (label.cell + 0.5) * cell_width_;
    if (at < half) {
      add_text(map, y_, label.text, small_size);
    } else if (at > map_width_ - half) {
      add_text(map + map_width_, y_, label.text, small_size, " text-anchor=\"end\"");
    } else {
      add_text(map + at, y_, label.text, small_size, " text-anchor=\"middle\"");
    }
  }

  const HeatMapPage& page_;
  std::string body_;
  double left_ = 0;  ///< of the maps
  double map_width_ = 0;
  double map_height_ = 0;
  double cell_width_ = 0;
  double cell_height_ = 0;
  double y_ = 0;  ///< how far down the page is
};

}  // namespace

std::string heat_map_svg(const HeatMapPage& page) { return Picture(page).text(); }

}  // namespace tightrope::charts
