#include "codegen/charts/layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "codegen/charts/text.h"

namespace tightrope::charts {
namespace {

constexpr double margin = 10;  // pixels around everything
constexpr double title_size = 16;
constexpr double panel_title_size = 13;
constexpr double line_height = 16;     // of text of the usual size
constexpr double exponent_size = 0.8;  // of the size of what it stands behind
constexpr double y_title_width = 20;
constexpr double tick_width = 56;    // what labels of the ticks of y take
constexpr double right_margin = 24;  // half a label of a tick
constexpr double gap = 14;           // between panels
constexpr double frame_height = 250;
constexpr double band_height = 66;
constexpr double swatch_width = 44;                  // a piece of line in the legend
constexpr std::size_t most_labels_side_by_side = 8;  // in a panel of half the page's width

double exponent_width(const Text& t) { return text_width(t.exponent, exponent_size * t.size); }

std::string label_text(const Datum& datum) {
  return datum.alarm.empty() ? datum.label : datum.label + ": " + datum.alarm;
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = 0;

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  /// At least `decades`, and a part more at both ends, so that markers stay inside.
  void widen(double decades, double part) {
    const double missing = std::max(0.0, decades - std::log10(high / low)) / 2;
    const double more = std::pow(10.0, missing + part * (std::log10(high / low) + 2 * missing));
    low /= more;
    high *= more;
  }
};

struct Axes {
  Range x;
  Range y;
  bool zeros = false;
};

/// Of these panels.
Axes axes_of(const Chart& chart, std::span<const Panel> panels) {
  Axes axes;
  axes.zeros = chart.y.zero_band;
  for (const Panel& panel : panels) {
    for (const Series& series : panel.series) {
      for (const Datum& datum : series.data) {
        axes.x.add(datum.x);
        if (datum.y > 0) axes.y.add(datum.y);
        if (datum.y == 0) axes.zeros = true;
      }
    }
  }
  if (axes.x.high == 0) axes.x = {1, 10};
  if (axes.y.high == 0) axes.y.add(chart.y.least > 0 ? chart.y.least : 1);
  axes.x.widen(1, 0.06);
  axes.y.widen(1.5, 0.08);
  return axes;
}

class Page {
 public:
  explicit Page(const Chart& chart) : chart_(chart), axes_(axes_of(chart, chart.panels)) {}

  Layout run() {
    place_head();
    place_legend();
    place_panels();
    place_lines(chart_.caption, font_size, faint_colour);
    if (result_.labels_left_out > 0) place_lines("Labels are missing for lack of room.", font_size, alarm_colour);
    result_.height = std::ceil(y_ + margin);
    return std::move(result_);
  }

 private:
  void place_lines(const std::string& text, double size, std::uint32_t colour) {
    for (const std::string& line : wrapped(printable(text), page_width - 2 * margin, size)) {
      const double height = size * line_height / font_size;
      result_.texts.push_back({.text = line, .at = {margin, y_ + height / 2}, .size = size, .colour = colour});
      y_ += height;
    }
  }

  void place_head() {
    place_lines(chart_.title, title_size, text_colour);
    place_lines(chart_.subtitle, font_size, faint_colour);
    y_ += 4;
  }

  /// Entries behind one another, a new row where one would not fit.
  void place_legend() {
    if (chart_.legend.empty()) return;
    constexpr double row = 20;
    double x = margin;
    for (const LegendEntry& entry : chart_.legend) {
      const std::string text = printable(entry.text);
      const double swatch = entry.line != Line::none ? swatch_width : 0;
      const double marks =
          static_cast<double>(entry.markers.size()) * 16 + (entry.alarm || (entry.ring && swatch == 0) ? 22 : 0);
      const double width = std::max(swatch, marks) + 5 + text_width(text, font_size);
      if (x > margin && x + width > page_width - margin) {
        x = margin;
        y_ += row;
      }
      place_swatch(entry, {x, y_ + row / 2});
      result_.texts.push_back({.text = text, .at = {x + std::max(swatch, marks) + 5, y_ + row / 2}});
      x += width + 18;
    }
    y_ += row + 4;
  }

  void place_swatch(const LegendEntry& entry, Place at) {
    if (entry.line != Line::none) {
      result_.legend_lines.push_back({{at, {at.x + swatch_width, at.y}}, entry.style, entry.line});
    }
    double x = at.x + (entry.line != Line::none ? swatch_width / 2 : 8);
    if (entry.ring) result_.legend_marks.push_back({.at = {x, at.y}, .kind = LegendMark::Kind::ring});
    for (const Style& style : entry.markers) {
      result_.legend_marks.push_back({.at = {x, at.y}, .kind = LegendMark::Kind::marker, .style = style});
      x += 16;
    }
    if (entry.alarm) result_.legend_marks.push_back({.at = {x + 3, at.y}, .kind = LegendMark::Kind::cross});
  }

  std::size_t columns() const {
    std::size_t most = 0;
    for (const Panel& panel : chart_.panels) {
      std::size_t labels = 0;
      for (const Series& series : panel.series) {
        for (const Datum& datum : series.data) labels += label_text(datum).empty() ? 0 : 1;
      }
      most = std::max(most, labels);
    }
    return chart_.panels.size() > 1 && most <= most_labels_side_by_side ? 2 : 1;
  }

  void place_panels() {
    const std::size_t columns = this->columns();
    const auto n = static_cast<double>(columns);
    const double width =
        (page_width - margin - right_margin - y_title_width - n * tick_width - (n - 1) * gap) / n;  // of one frame
    const bool room_for_zeros = axes_.zeros;                                                        // of any panel
    const double height = frame_height + (room_for_zeros ? band_height : 0);
    for (std::size_t i = 0; i < chart_.panels.size(); ++i) {
      const std::size_t column = i % columns;
      const double left =
          margin + y_title_width + tick_width + static_cast<double>(column) * (width + gap + tick_width);
      const double top = y_ + 24;
      place_panel(i, {left, top, left + width, top + height});
      if (column == 0) {
        result_.texts.push_back({.text = printable(chart_.y.title),
                                 .at = {margin + y_title_width / 2, top + height / 2},
                                 .anchor = Text::Anchor::middle,
                                 .upright = true});
      }
      if (column + 1 == columns || i + 1 == chart_.panels.size()) y_ = top + height + 2 * line_height + 16;
    }
  }

  void place_panel(std::size_t index, const Box& frame) {
    const Panel& panel = chart_.panels[index];
    if (!chart_.y.shared) {
      const Axes own = axes_of(chart_, std::span(chart_.panels).subspan(index, 1));
      axes_.y = own.y;
      axes_.zeros = own.zeros;
    }
    PanelLayout place{
        .frame = frame, .x = {}, .y = {}, .zero_band = {}, .x_ticks = {}, .y_ticks = {}, .data = {}, .leaders = {}};
    place.x = {axes_.x.low, axes_.x.high, frame.left, frame.right};
    place.y = {axes_.y.low, axes_.y.high, frame.bottom, frame.top};
    if (axes_.zeros) {
      const double pixels_per_decade = (frame.height() - band_height) / std::log10(axes_.y.high / axes_.y.low);
      place.y.low /= std::pow(10.0, band_height / pixels_per_decade);
      place.zero = axes_.y.low / std::pow(10.0, band_height / 2 / pixels_per_decade);
      place.zero_band = {frame.left, frame.bottom - band_height, frame.right, frame.bottom};
    }
    result_.texts.push_back(
        {.text = printable(panel.title), .at = {frame.left, frame.top - 10}, .size = panel_title_size});
    place_ticks(place);
    place_data(panel, place);
    result_.panels.push_back(std::move(place));
  }

  void place_ticks(PanelLayout& panel) {
    panel.x_ticks = log_ticks(axes_.x.low, axes_.x.high, static_cast<int>(panel.frame.width() / 60));
    panel.y_ticks = log_ticks(axes_.y.low, axes_.y.high, 7);
    const Box& frame = panel.frame;
    for (const Tick& tick : panel.x_ticks) {
      if (tick.label.empty()) continue;
      result_.texts.push_back({.text = tick.label,
                               .at = {panel.x.at(tick.value), frame.bottom + 12},
                               .anchor = Text::Anchor::middle,
                               .exponent = tick.exponent});
    }
    result_.texts.push_back({.text = printable(chart_.x.title),
                             .at = {frame.centre().x, frame.bottom + 12 + line_height},
                             .anchor = Text::Anchor::middle});
    for (const Tick& tick : panel.y_ticks) {
      if (tick.label.empty()) continue;
      result_.texts.push_back({.text = tick.label,
                               .at = {frame.left - 6, panel.y.at(tick.value)},
                               .anchor = Text::Anchor::right,
                               .exponent = tick.exponent});
    }
    if (panel.zero_band) {
      panel.y_ticks.push_back({.value = panel.zero, .label = "0"});
      result_.texts.push_back(
          {.text = "0", .at = {frame.left - 6, panel.y.at(panel.zero)}, .anchor = Text::Anchor::right});
    }
  }

  void place_data(const Panel& panel, PanelLayout& place) {
    std::vector<LabelRequest> requests;
    std::vector<const Datum*> labelled;
    std::vector<Box> obstacles;
    std::vector<Segment> lines;
    for (std::size_t s = 0; s < panel.series.size(); ++s) {
      const Series& series = panel.series[s];
      std::optional<Place> before;
      for (std::size_t d = 0; d < series.data.size(); ++d) {
        const Datum& datum = series.data[d];
        const Place at{place.x.at(datum.x), place.y.at(datum.y > 0 ? datum.y : place.zero)};
        if (series.line != Line::none && before) lines.push_back({*before, at});
        before = at;
        if (!series.markers) continue;
        const double radius = datum.alarm.empty() && !datum.ring ? marker_reach : cross_radius;
        obstacles.push_back(box_around(at, 2 * radius + 1, 2 * radius + 1));
        place.data.push_back({s, d, at});
        if (datum.label.empty()) continue;
        labelled.push_back(&datum);
        requests.push_back({at, radius, text_width(printable(label_text(datum)), font_size) + 2, font_size * 1.2});
      }
    }
    const Box inside{place.frame.left + 2, place.frame.top + 2, place.frame.right - 2, place.frame.bottom - 2};
    const std::vector<LabelPlace> places = place_labels(requests, inside, obstacles, lines);
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (!places[i].placed) {
        ++result_.labels_left_out;
        continue;
      }
      result_.texts.push_back({.text = printable(label_text(*labelled[i])),
                               .at = {places[i].box.left + 1, places[i].box.centre().y},
                               .colour = labelled[i]->alarm.empty() ? text_colour : alarm_colour});
      if (places[i].has_leader) place.leaders.push_back(places[i].leader);
    }
  }

  const Chart& chart_;
  Axes axes_;
  Layout result_;
  double y_ = margin;
};

}  // namespace

Box Text::box() const {
  const double width = text_width(text, size) + exponent_width(*this);
  const double height = 1.2 * size;
  if (upright) return box_around(at, height, width);
  const double left = anchor == Anchor::left ? at.x : anchor == Anchor::middle ? at.x - width / 2 : at.x - width;
  return {left, at.y - height / 2, left + width, at.y + height / 2};
}

double Scale::at(double value) const {
  return first + (last - first) * (std::log10(value / low) / std::log10(high / low));
}

Layout layout(const Chart& chart) { return Page(chart).run(); }

}  // namespace tightrope::charts
