#pragma once
/// The unchanging parts of the interactive page.

namespace tightrope::ccd::stability {

inline constexpr const char* index_style = R"(
:root { color-scheme: light dark }
body { margin: 1rem auto; max-width: 1000px; padding: 0 1rem; font: 14px/1.45 sans-serif; color: #111; background: #fff }
h1 { font-size: 1.5rem } h2 { font-size: 1.15rem; margin-top: 2rem }
figure { margin: 0 } section { scroll-margin-top: 5rem } nav p { margin: .2rem 0 } nav a { margin-left: .4rem } nav a.on { font-weight: bold }
a { color: #0057a0 } .scroll { overflow-x: auto }
section svg { display: block; width: 100%; height: auto; touch-action: pan-y pinch-zoom }
.map { cursor: crosshair } .frame:focus { outline: none; stroke-width: 3 }
#cursor { fill: none; stroke: #e69f00; stroke-width: 2; pointer-events: none }
#card { position: sticky; top: 0; min-height: 3.2em; margin: .6rem 0; padding: .4rem .7rem; border: 1px solid #8888;
  border-radius: 4px; background: #f4f4f4; font-variant-numeric: tabular-nums }
table { border-collapse: collapse; margin: 1rem 0; font-size: 13px; font-variant-numeric: tabular-nums }
th, td { padding: .2rem .7rem .2rem 0; border-bottom: 1px solid #8884; text-align: left; vertical-align: bottom }
td, tbody th { white-space: nowrap }
.alarm { color: #c00000; font-weight: bold }
dt { font-weight: bold; float: left; clear: left; width: 9.5rem } dd { margin: 0 0 .3rem 9.5rem }
@media (prefers-color-scheme: dark) {
  body { color: #e6e6e6; background: #141414 } a { color: #7db8e8 } #card { background: #222 }
  .paper { fill: #141414 } .ink { fill: #e6e6e6 } .rule, .frame { stroke: #8a8a8a }
  .k1 { fill: #262626 } .k2 { fill: #1d3f5c } .k3 { fill: #24608f } .k4 { fill: #3f8cc4 } .k5 { fill: #86bde3 }
  .k6 { fill: #d3e8f8 } .k7 { fill: #ff3b30 } .alarm { color: #ff6a60; fill: #ff6a60 }
}
@media print { #card { display: none } }
)";

inline constexpr const char* index_text = R"(
<p>A map is a family of queries in one method's hands. At its bottom (distance 0) the queries are as degenerate as their
family says, touching in one point or along an edge, or missing by 2<sup>-45</sup> to 2<sup>-10</sup> of their size while all
else stays degenerate. In the rows above, every coordinate of touching queries is moved at random by up to the distance given
(times the size: the largest difference of two points' coordinates), so that half of them or more come apart by about as
much. Then the query is carried away from the origin, multiplied with a power of two, and rounded to the type; the truth is
that of the numbers which are left.</p>
<p>Doubles cannot tell all these distances. At the origin 10<sup>-18</sup> of the size moves those coordinates only that are
(almost) zero, and from an offset of 1 on it moves none; at offset 2<sup>40</sup> everything below 10<sup>-4</sup> is rounded
away. There the rows repeat what touching queries give.</p>
<p>White: none. Hatched: there is nothing to count, as in maps of false alarms where all queries are contacts. Red: contacts
were missed. A method that promises to miss none must have no red at all.</p>
<h2>Why</h2>
<p>Without error bounds, numbers that should be 0 come out with either sign, and one wrong sign separates what touches: red at and
just above distance 0, most of it at corners. With bounds such signs are left open, which costs false alarms instead, up to the distance
at which what is computed outgrows its bound: some units in the last place in general position, the root of a unit roundoff where faces are flat,
edges parallel, or hardly anything moves, because normals shrink with the distance there. Exact methods pay with exact arithmetic where
bounds leave signs open. The scale changes nothing, as all methods normalise by powers of two; the offset nothing but the grid of the
coordinates. docs/stability.md of the sources tells more.</p>
)";

inline constexpr const char* index_script = R"(
'use strict';
const atlas = JSON.parse(document.getElementById('atlas').textContent);
const card = document.getElementById('card');
const pages = [...document.querySelectorAll('section.page')];
const links = [...document.querySelectorAll('nav a')];
const { offset, distance, scale_exponent } = atlas.axes;
const cursor = document.createElementNS('http://www.w3.org/2000/svg', 'rect');
cursor.id = 'cursor';

function choose() {
  const wanted = location.hash.slice(1);
  const chosen = pages.find(page => page.id === wanted) || pages[0];
  for (const page of pages) page.style.display = page === chosen ? '' : 'none';
  for (const link of links) link.classList.toggle('on', link.hash === '#' + chosen.id);
  cursor.remove();
}

const power = exponent => '2^' + exponent;
const rate = (count, all) => all === 0 ? 'none of 0' : `${count} of ${all} (${(100 * count / all).toFixed(1)} %)`;

// What a cell of a map shows: sums over the cells of the atlas that it stands for.
function tell(page, index, row, column) {
  const { kind, real } = page.dataset;
  const maps = atlas.maps.filter(map => map.kind === kind && map.real === real);
  const overview = !page.dataset.method;
  const heads = overview ? atlas.methods.length : page.heads;
  const map = maps[Math.floor(index / heads)];
  const method = overview ? atlas.methods[index % heads].name : page.dataset.method;
  const scales = scale_exponent[real];
  const d = distance.length - 1 - row;
  const offsets = overview ? offset.map((_, i) => i) : [Math.floor(column / scales.length)];
  const cells = offsets.map(o => (o * distance.length + d) * scales.length + column % scales.length);
  const sum = list => list ? cells.reduce((all, cell) => all + list[cell], 0) : 0;
  const counts = map.methods[method];
  const queries = sum(map.queries), contacts = sum(map.contacts);
  const where = overview ? 'all offsets' : 'offset ' + offset[offsets[0]];
  let text = `${method}, ${map.family}: distance ${distance[d]}, scale ${power(scales[column % scales.length])}, ${where}. ` +
    `${queries} queries, ${contacts} contacts. Missed ${rate(sum(counts.misses), contacts)}; ` +
    `false alarms ${rate(sum(counts.false_alarms), queries - contacts)}; ` +
    `uncertain signs ${rate(sum(counts.uncertain_signs), sum(counts.signs))}, met by ${sum(counts.uncertain)} queries`;
  if (counts.exact) text += `; exact arithmetic ${rate(sum(counts.exact), queries)}`;
  card.textContent = text + '.';
  card.classList.toggle('alarm', sum(counts.misses) > 0);
}

for (const page of pages) {
  const frames = [...page.querySelectorAll('.frame')];
  const families = atlas.maps.filter(map => map.kind === page.dataset.kind && map.real === page.dataset.real).length;
  page.heads = frames.length / families;
  const rows = distance.length;
  const columns = scale_exponent[page.dataset.real].length * (page.dataset.method ? offset.length : 1);
  frames.forEach((frame, index) => {
    let row = rows - 1, column = 0;
    const show = () => {
      const [x, y, w, h] = ['x', 'y', 'width', 'height'].map(name => Number(frame.getAttribute(name)));
      const place = { x: x + column * w / columns, y: y + row * h / rows, width: w / columns, height: h / rows };
      for (const name in place) cursor.setAttribute(name, place[name]);
      frame.parentNode.append(cursor);
      tell(page, index, row, column);
    };
    const point = event => {
      const box = frame.getBoundingClientRect();
      const at = (value, count) => Math.max(0, Math.min(count - 1, Math.floor(value * count)));
      row = at((event.clientY - box.top) / box.height, rows);
      column = at((event.clientX - box.left) / box.width, columns);
      show();
    };
    frame.setAttribute('tabindex', '0');
    frame.setAttribute('role', 'application');
    frame.setAttribute('aria-label', 'map ' + (index + 1));
    frame.addEventListener('pointermove', point);
    frame.addEventListener('pointerdown', point);
    frame.addEventListener('focus', show);
    frame.addEventListener('keydown', event => {
      const step = { ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowDown: [1, 0], ArrowUp: [-1, 0] }[event.key];
      if (!step) return;
      event.preventDefault();
      row = Math.max(0, Math.min(rows - 1, row + step[0]));
      column = Math.max(0, Math.min(columns - 1, column + step[1]));
      show();
    });
  });
}
addEventListener('hashchange', choose);
choose();
)";

}  // namespace tightrope::ccd::stability
