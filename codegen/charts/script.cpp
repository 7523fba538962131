#include "codegen/charts/script.h"

#include <fmt/format.h>

#include "codegen/charts/text.h"

namespace tightrope::charts {
namespace {

/// In single quotes, between which nothing but they themselves means anything to gnuplot. An apostrophe becomes a
/// typographic one: gnuplot 5.4 does not read '' as one at the beginning of a text.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') {
      result += "\u2019";
    } else {
      result += c;
    }
  }
  return result + "'";
}

int point_type(const Style& style) {
  switch (style.shape) {
    case Shape::asterisk:
      return style.filled ? 3 : 1;
    case Shape::square:
      return style.filled ? 5 : 4;
    case Shape::circle:
      return style.filled ? 7 : 6;
    case Shape::triangle:
      return style.filled ? 9 : 8;
    case Shape::inverted_triangle:
      return style.filled ? 11 : 10;
    case Shape::diamond:
      return style.filled ? 13 : 12;
    case Shape::pentagon:
      return style.filled ? 15 : 14;
  }
  return 7;
}

std::string point(const Style& style) {
  return fmt::format("pt {} ps {} lw {} lc rgb \"{}\"", point_type(style), marker_radius / 4.5,
                     style.filled && style.shape != Shape::asterisk ? 1 : 1.8, colour_text(style.colour));
}

std::string cross_point() {
  return fmt::format("pt 2 ps {} lw 3 lc rgb \"{}\"", cross_radius / 4.5, colour_text(alarm_colour));
}

std::string ring_point() {
  return fmt::format("pt 6 ps {} lw 1.2 lc rgb \"{}\"", cross_radius / 4.5, colour_text(faint_colour));
}

/// gnuplot's SVG goes on with the dashes of the line before where colour and width are the same: widths differ a
/// little.
std::string stroke(const Style& style, Line line) {
  const char* look = line == Line::dashed   ? "lw 2.02 dt (6,4)"
                     : line == Line::dotted ? "lw 2.01 dt (2,3)"
                                            : "lw 2 dt 1";
  return fmt::format("{} lc rgb \"{}\"", look, colour_text(style.colour));
}

class Script {
 public:
  Script(const Chart& chart, const Layout& layout) : chart_(chart), layout_(layout) {}

  std::string text(Terminal terminal) {
    add_head(terminal);
    for (std::size_t i = 0; i < layout_.panels.size(); ++i) {
      if (i + 1 == layout_.panels.size()) add_words();  // above all that the panels before draw
      add_panel(chart_.panels[i], layout_.panels[i]);
      result_ += "unset label\nunset arrow\nunset object\n";
    }
    return result_ + "unset multiplot\n";
  }

 private:
  void add_head(Terminal terminal) {
    const auto width = static_cast<int>(page_width);
    const auto height = static_cast<int>(layout_.height);
    result_ = "set encoding utf8\n";
    if (terminal == Terminal::svg) {
      result_ += fmt::format("set terminal svg size {},{} dynamic enhanced font 'sans-serif,{}' background '#FFFFFF'\n",
                             width, height, font_size);
    } else {
      // Cairo counts fonts in points, 72 of which make 96 pixels; its markers are 2/3 of the size of those in SVG.
      font_unit_ = 0.75;
      result_ += fmt::format(
          "set terminal pngcairo size {},{} enhanced font 'sans-serif,{}' fontscale 2 linewidth 2 pointscale 3 "
          "dashlength 2 background '#FFFFFF'\n",
          2 * width, 2 * height, font_size * font_unit_);
    }
    result_ += "set multiplot\nunset key\nset border 15 lc rgb '#707070'\n";
    result_ += "set tics nomirror out scale 0.6,0.3\nset grid xtics ytics lc rgb '#E4E4E4' lw 1 dt 1\n";
    result_ += "set logscale xy\n";
  }

  void add_words() {
    for (const Text& text : layout_.texts) add(text);
    for (const LegendLine& line : layout_.legend_lines) add_arrow(line.segment, stroke(line.style, line.line));
    for (const LegendMark& mark : layout_.legend_marks) {
      const auto add = [&](const std::string& look) {
        result_ += fmt::format("set label '' at {} point {}\n", screen(mark.at), look);
      };
      if (mark.kind == LegendMark::Kind::ring) add(ring_point());
      if (mark.kind == LegendMark::Kind::cross) add(cross_point());
      if (mark.kind == LegendMark::Kind::marker) add(point(mark.style));
    }
  }

  /// A place as fractions of the page, from below.
  std::string screen(Place p) const {
    return fmt::format("screen {:.6f},{:.6f}", p.x / page_width, 1 - p.y / layout_.height);
  }

  void add(const Text& text) {
    const char* anchor = text.anchor == Text::Anchor::left     ? "left"
                         : text.anchor == Text::Anchor::middle ? "center"
                                                               : "right";
    const std::string words = text.exponent.empty() ? text.text : text.text + "^{" + text.exponent + "}";
    result_ += fmt::format("set label {} at {} {}{}{} font ',{}' tc rgb '{}' front\n", quoted(words), screen(text.at),
                           anchor, text.upright ? " rotate by 90" : "", text.exponent.empty() ? " noenhanced" : "",
                           text.size * font_unit_, colour_text(text.colour));
  }

  void add_arrow(const Segment& segment, const std::string& look) {
    result_ += fmt::format("set arrow from {} to {} nohead {}\n", screen(segment.from), screen(segment.to), look);
  }

  void add_panel(const Panel& panel, const PanelLayout& place) {
    const Box& frame = place.frame;
    result_ += fmt::format("set lmargin at screen {:.6f}\nset rmargin at screen {:.6f}\n", frame.left / page_width,
                           frame.right / page_width);
    result_ += fmt::format("set tmargin at screen {:.6f}\nset bmargin at screen {:.6f}\n",
                           1 - frame.top / layout_.height, 1 - frame.bottom / layout_.height);
    result_ +=
        fmt::format("set xrange [{}:{}]\nset yrange [{}:{}]\n", place.x.low, place.x.high, place.y.low, place.y.high);
    add_ticks("x", place.x_ticks);
    add_ticks("y", place.y_ticks);
    for (const Segment& leader : place.leaders) add_arrow(leader, "lw 0.7 dt 1 lc rgb '#909090'");
    if (place.zero_band) {
      const Box& band = *place.zero_band;
      result_ += fmt::format("set object rectangle from {} to {} fc rgb '#F0F0F0' fs solid noborder behind\n",
                             screen({band.left, band.bottom}), screen({band.right, band.top}));
      add_arrow({{band.left, band.top}, {band.right, band.top}}, "lw 1 dt (3,3) lc rgb '#707070'");
    }
    add_plots(panel, place);
  }

  void add_ticks(const char* axis, const std::vector<Tick>& ticks) {
    std::string list;
    for (const Tick& tick : ticks) {
      list += fmt::format("{}'' {}{}", list.empty() ? "" : ", ", tick.value, tick.label.empty() ? " 1" : "");
    }
    result_ += fmt::format("set {}tics ({})\n", axis, list);
  }

  void add_plots(const Panel& panel, const PanelLayout& place) {
    std::string plots;
    const auto plot = [&](const std::string& name, const std::string& with, const std::string& title) {
      plots += fmt::format("{} {} using 1:2 with {} title {} noenhanced", plots.empty() ? "plot" : ", \\\n     ", name,
                           with, quoted(printable(title)));
    };
    for (std::size_t s = 0; s < panel.series.size(); ++s) {
      const Series& series = panel.series[s];
      const std::string name = fmt::format("$data{}", s);
      const auto all = [](const Datum&) { return true; };
      const auto wrong = [](const Datum& datum) { return !datum.alarm.empty(); };
      const auto ringed = [](const Datum& datum) { return datum.ring; };
      if (!add_data(name, series, place.zero, all)) continue;
      if (series.line != Line::none) plot(name, "lines " + stroke(series.style, series.line), series.name + " (line)");
      if (!series.markers) continue;
      plot(name, "points " + point(series.style), series.name);
      if (add_data(name + "_ring", series, place.zero, ringed)) {
        plot(name + "_ring", "points " + ring_point(), series.name + ": ring");
      }
      if (add_data(name + "_wrong", series, place.zero, wrong)) {
        plot(name + "_wrong", "points " + cross_point(), series.name + ": wrong");
      }
    }
    // Without series an empty panel: gnuplot needs something to plot.
    result_ += (plots.empty() ? "plot 1/0 notitle" : plots) + "\n";
  }

  /// Whether there are any that are `wanted`.
  template <class Wanted>
  bool add_data(const std::string& name, const Series& series, double zero, const Wanted& wanted) {
    std::string lines;
    for (const Datum& datum : series.data) {
      if (wanted(datum)) lines += fmt::format("{} {}\n", datum.x, datum.y > 0 ? datum.y : zero);
    }
    if (lines.empty()) return false;
    result_ += fmt::format("{} << END\n{}END\n", name, lines);
    return true;
  }

  const Chart& chart_;
  const Layout& layout_;
  double font_unit_ = 1;  ///< what the terminal counts font sizes in, per pixel
  std::string result_;
};

}  // namespace

std::string gnuplot_script(const Chart& chart, const Layout& layout, Terminal terminal) {
  return Script(chart, layout).text(terminal);
}

}  // namespace tightrope::charts
