#include "codegen/charts/html.h"

#include <fmt/format.h>

#include <algorithm>

#include "codegen/charts/text.h"

namespace tightrope::charts {
namespace {

constexpr const char* style_sheet = R"(
body { margin: 1rem auto; max-width: 1000px; padding: 0 1rem; font: 14px/1.4 sans-serif; color: #111; background: #fff }
figure { margin: 0 }
svg { display: block; width: 100%; height: auto; touch-action: pan-y pinch-zoom }
.datum { fill: none; pointer-events: all; stroke: none; outline: none; cursor: pointer }
.datum.on { stroke: #111; stroke-width: 2 }
#card { position: absolute; max-width: 22rem; padding: .4rem .6rem; border: 1px solid #888; border-radius: 4px;
  color: #111; background: #fff; box-shadow: 0 2px 8px #0004; pointer-events: none }
#card b { font-weight: normal; opacity: .7 }
.scroll { overflow-x: auto }
table { border-collapse: collapse; margin: 1rem 0; font-size: 13px; font-variant-numeric: tabular-nums }
th, td { padding: .2rem .6rem; border-bottom: 1px solid #8884; text-align: left; white-space: nowrap }
tbody tr { cursor: pointer }
tr.on { background: #56b4e944 }
@media (prefers-color-scheme: dark) {
  body, #card { color: #e6e6e6; background: #141414 }
  svg { filter: invert(.92) hue-rotate(180deg) }
}
@media print { #card { display: none } svg { filter: none } }
)";

constexpr const char* script = R"(
'use strict';
const svg = document.querySelector('svg');
const marks = [...svg.querySelectorAll('.datum')];
const rows = [...document.querySelectorAll('tbody tr')];
const names = [...document.querySelectorAll('thead th')].map(cell => cell.textContent);
const card = document.getElementById('card');
let shown = -1;

function show(i) {
  if (i === shown) return;
  for (const list of [marks, rows]) {
    if (shown >= 0) list[shown].classList.remove('on');
    if (i >= 0) list[i].classList.add('on');
  }
  shown = i;
  card.hidden = i < 0;
  if (i < 0) return;
  card.replaceChildren(...[...rows[i].cells].flatMap((cell, column) => {
    if (!cell.textContent) return [];
    const line = document.createElement('div');
    const name = document.createElement('b');
    name.textContent = names[column] + ': ';
    line.append(name, cell.textContent);
    return [line];
  }));
  const mark = marks[i].getBoundingClientRect();
  const room = document.documentElement.clientWidth - card.offsetWidth - 8;
  const left = mark.right + 8 > room ? mark.left - card.offsetWidth - 8 : mark.right + 8;
  card.style.left = Math.max(8, Math.min(left, room)) + scrollX + 'px';
  card.style.top = mark.bottom + 4 + scrollY + 'px';
}

function nearest(event) {
  let best = -1;
  let least = 28;
  marks.forEach((mark, i) => {
    const box = mark.getBoundingClientRect();
    const distance = Math.hypot(event.clientX - (box.left + box.right) / 2, event.clientY - (box.top + box.bottom) / 2);
    if (distance < least) { least = distance; best = i; }
  });
  return best;
}

svg.addEventListener('pointermove', event => show(nearest(event)));
svg.addEventListener('pointerdown', event => show(nearest(event)));
svg.addEventListener('pointerleave', event => { if (event.pointerType === 'mouse') show(-1); });
marks.forEach((mark, i) => {
  mark.addEventListener('focus', () => show(i));
  mark.addEventListener('blur', () => show(-1));
});
rows.forEach((row, i) => row.addEventListener('click', () => { show(-1); show(i); }));
document.addEventListener('keydown', event => {
  const at = marks.indexOf(document.activeElement);
  const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
  if (event.key === 'Escape') show(-1);
  if (at < 0 || !step) return;
  event.preventDefault();
  marks[(at + step + marks.length) % marks.length].focus();
});
)";

const Series& series_of(const Chart& chart, std::size_t panel, const DatumPlace& place) {
  return chart.panels[panel].series[place.series];
}

/// The names of all facts, in the order in which they first come.
std::vector<std::string> fact_names(const Chart& chart, const Layout& layout) {
  std::vector<std::string> names;
  for (std::size_t p = 0; p < layout.panels.size(); ++p) {
    for (const DatumPlace& place : layout.panels[p].data) {
      for (const Fact& fact : series_of(chart, p, place).data[place.datum].facts) {
        if (std::find(names.begin(), names.end(), fact.name) == names.end()) names.push_back(fact.name);
      }
    }
  }
  return names;
}

std::string cell(const std::string& text) { return "<td>" + escaped(printable(text)) + "</td>"; }

/// One line a marker.
std::string table(const Chart& chart, const Layout& layout) {
  const std::vector<std::string> names = fact_names(chart, layout);
  std::string text = "<table>\n<thead><tr><th>panel</th><th>series</th>";
  for (const std::string& name : names) text += "<th>" + escaped(printable(name)) + "</th>";
  text += "</tr></thead>\n<tbody>\n";
  for (std::size_t p = 0; p < layout.panels.size(); ++p) {
    for (const DatumPlace& place : layout.panels[p].data) {
      const Series& series = series_of(chart, p, place);
      text += "<tr>" + cell(chart.panels[p].name) + cell(series.name);
      const std::vector<Fact>& facts = series.data[place.datum].facts;
      for (const std::string& name : names) {
        const auto fact = std::find_if(facts.begin(), facts.end(), [&](const Fact& f) { return f.name == name; });
        text += cell(fact == facts.end() ? "" : fact->value);
      }
      text += "</tr>\n";
    }
  }
  return text + "</tbody>\n</table>\n";
}

/// The places of the markers, in the order of the table.
std::string targets(const Chart& chart, const Layout& layout) {
  std::string text = "<g id=\"data\">\n";
  for (std::size_t p = 0; p < layout.panels.size(); ++p) {
    for (const DatumPlace& place : layout.panels[p].data) {
      const Series& series = series_of(chart, p, place);
      std::string words = chart.panels[p].name + ", " + series.name;
      for (const Fact& fact : series.data[place.datum].facts) words += ", " + fact.name + " " + fact.value;
      text += fmt::format(
          "<circle class=\"datum\" fill=\"none\" pointer-events=\"all\" cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"9\" "
          "tabindex=\"0\" role=\"img\" "
          "aria-label=\"{}\"/>\n",
          place.place.x, place.place.y, escaped(printable(words)));
    }
  }
  return text + "</g>\n";
}

/// The picture without its XML declaration, the targets at its end.
std::string picture(const Chart& chart, const Layout& layout, const std::string& svg) {
  const std::size_t begin = svg.find("<svg");
  const std::size_t end = svg.rfind("</svg>");
  if (begin == std::string::npos || end == std::string::npos) return svg;
  return svg.substr(begin, end - begin) + targets(chart, layout) + "</svg>\n";
}

}  // namespace

std::string html_page(const Chart& chart, const Layout& layout, const std::string& svg) {
  std::string page = "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n";
  page += "<meta charset=\"utf-8\"/>\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n";
  page += fmt::format("<title>{}</title>\n", escaped(printable(chart.title)));
  page += fmt::format("<style>{}</style>\n</head>\n<body>\n<figure>\n", style_sheet);
  page += picture(chart, layout, svg);
  page += "</figure>\n<div id=\"card\" role=\"status\" hidden=\"hidden\"></div>\n<div class=\"scroll\">\n";
  page += table(chart, layout);
  page += fmt::format("</div>\n<script>//<![CDATA[{}//]]></script>\n</body>\n</html>\n", script);
  return page;
}

}  // namespace tightrope::charts
