#include "stability/index_page.h"

#include <fmt/format.h>

#include <cmath>

#include "codegen/charts/text.h"
#include "stability/index_script.h"
#include "stability/rates.h"

namespace tightrope::ccd::stability {
namespace {

using charts::escaped;

std::string total(Figure figure, const Atlas& atlas, Real real, std::size_t method) {
  Rate sum;
  for (const Map& map : atlas.maps) {
    if (map.real == real) sum += rate(figure, map, map.methods[method]);
  }
  if (figure == Figure::misses) return sum.count == 0 ? "0" : fmt::format("{} ({})", sum.count, percent(sum));
  return percent(sum);
}

/// The family whose rate of false alarms is the highest.
std::string worst_family(const Atlas& atlas, Real real, std::size_t method) {
  std::string worst = "-";
  double highest = 0;
  for (const Map& map : atlas.maps) {
    const Rate alarms = rate(Figure::false_alarms, map, map.methods[method]);
    if (map.real != real || !alarms.known() || alarms.value() <= highest) continue;
    highest = alarms.value();
    worst = fmt::format("{}, {}: {}", map.family, name(map.kind), percent(alarms));
  }
  return worst;
}

/// The largest distance at which, all families together and at the least offset, more than one of a hundred queries
/// without contact is a false alarm.
std::string doubt(const Atlas& atlas, Real real, std::size_t method) {
  const Axes& axes = atlas.axes;
  for (std::size_t d = axes.distances.size(); d-- > 0;) {
    Rate alarms;
    for (const Map& map : atlas.maps) {
      for (std::size_t s = 0; map.real == real && s < axes.scales.size(); ++s) {
        alarms += rate(Figure::false_alarms, map, map.methods[method], axes.cell(0, d, s));
      }
    }
    if (alarms.known() && alarms.value() > 0.01) return fmt::format("{}", axes.distances[d]);
  }
  return "nowhere";
}

std::string table(const Atlas& atlas) {
  std::string text = "<div class=\"scroll\"><table>\n<thead><tr><th>method</th><th>type</th>";
  for (const Figure figure : all_figures) text += fmt::format("<th>{}</th>", name(figure));
  text += "<th>1 % false alarms up to distance</th><th>most false alarms</th></tr></thead>\n<tbody>\n";
  for (const Real real : {Real::in_double, Real::in_float}) {
    bool any = false;
    for (const Map& map : atlas.maps) any |= map.real == real;
    for (std::size_t m = 0; any && m < atlas.methods.size(); ++m) {
      text += fmt::format("<tr><th>{}</th><td>{}</td>", escaped(atlas.methods[m].name), name(real));
      for (const Figure figure : all_figures) {
        const std::string figures = total(figure, atlas, real, m);
        const bool wrong = figure == Figure::misses && figures != "0";
        text += fmt::format("<td{}>{}</td>", wrong ? " class=\"alarm\"" : "", escaped(figures));
      }
      text +=
          fmt::format("<td>{}</td><td>{}</td></tr>\n", doubt(atlas, real, m), escaped(worst_family(atlas, real, m)));
    }
  }
  return text + "</tbody>\n</table></div>\n";
}

/// One page as a section; scripts find what it shows by its attributes.
std::string section(const Page& page) {
  return fmt::format(
             "<section class=\"page\" id=\"{}\" data-kind=\"{}\" data-real=\"{}\" data-method=\"{}\">\n<figure>\n",
             page.file, name(page.kind), name(page.real), escaped(page.method)) +
         charts::heat_map_svg(page.maps) + "</figure>\n</section>\n";
}

/// Links to all pages, one line a kind and type.
std::string list_of_pages(std::span<const Page> pages) {
  std::string text = "<nav aria-label=\"pages\">\n";
  for (std::size_t i = 0; i < pages.size(); ++i) {
    const Page& page = pages[i];
    if (page.method.empty()) {
      text += fmt::format("{}<p><b>{}, {}:</b>", i > 0 ? "</p>\n" : "", name(page.kind), name(page.real));
    }
    text += fmt::format(" <a href=\"#{}\">{}</a>", page.file, escaped(page.link));
  }
  return text + "</p>\n</nav>\n";
}

/// The families, as `generate --list` tells them.
std::string list_of_families(const Atlas& atlas) {
  std::string text = "<dl>\n";
  for (const Family& family : atlas.families) {
    text += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escaped(family.name), escaped(family.what));
  }
  return text + "</dl>\n";
}

/// JSON that no markup can end; only its strings contain such characters.
std::string embedded(const std::string& json) {
  std::string text;
  for (const char c : json) {
    if (c == '<' || c == '>' || c == '&') {
      text += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace

std::string index_page(const Atlas& atlas, std::span<const Page> pages, const std::string& json) {
  std::string text =
      "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>Stability atlas</title>\n";
  text += fmt::format("<style>{}</style>\n</head>\n<body>\n<h1>Stability atlas</h1>\n", index_style);
  text += fmt::format(
      "<p>Where collision queries get into trouble: {} families of degenerate queries, moved away from their "
      "degeneracy "
      "by 0 to {} of their size, at scales from 2<sup>{}</sup> to 2<sup>{}</sup> (in float half the exponents) and up "
      "to 2<sup>{}</sup> sizes away from the origin. Every answer is compared with that of exact arithmetic. A miss is "
      "a contact denied, a false alarm one claimed where there is none. {} queries a cell, seed {}.</p>\n",
      atlas.families.size(), atlas.axes.distances.back(), atlas.axes.scales.front(), atlas.axes.scales.back(),
      std::log2(atlas.axes.offsets.back()), atlas.queries, atlas.seed);
  text += table(atlas);
  text += list_of_pages(pages);
  text +=
      "<p id=\"card\" role=\"status\">Point at a cell, or press Tab to come to a map and the arrow keys to walk on "
      "it.</p>\n";
  for (const Page& page : pages) text += section(page);
  text += fmt::format("<h2>How to read it</h2>\n{}<h2>The families</h2>\n{}", index_text, list_of_families(atlas));
  text += fmt::format("<script type=\"application/json\" id=\"atlas\">{}</script>\n", embedded(json));
  text += fmt::format("<script>//<![CDATA[{}//]]></script>\n</body>\n</html>\n", index_script);
  return text;
}

}  // namespace tightrope::ccd::stability
