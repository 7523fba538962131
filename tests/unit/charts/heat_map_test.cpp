#include "codegen/charts/heat_map.h"

#include <gtest/gtest.h>

#include <map>
#include <regex>

#include "codegen/charts/geometry.h"
#include "codegen/charts/text.h"
#include "tests/unit/charts/xml.h"

namespace tightrope::charts {
namespace {

/// Three rows, two columns of maps of 4 x 6 cells, in three classes.
HeatMapPage example() {
  HeatMapPage page;
  page.name = "example";
  page.title = "What & why";
  page.subtitle = "A page < another";
  page.caption = std::string(60, 'x') + " " + std::string(60, 'y') + " " + std::string(60, 'z');
  page.classes = {{"nothing", 0xFFFFFF, true}, {"some", 0x8FBBDF}, {"wrong", 0xD00000}};
  page.columns = {"left", "right"};
  page.rows = {"first", "second", "a rather long name of a row"};
  page.cell_columns = 6;
  page.cell_rows = 4;
  page.group = 3;
  page.x_labels = {{0, "2⁻²⁰⁰"}, {5, "2²⁰⁰"}};
  page.y_labels = {{0, "1"}, {3, "0"}};
  page.x_title = "scale";
  page.y_title = "distance";
  for (std::size_t m = 0; m < 6; ++m) {
    HeatMap map;
    for (std::size_t i = 0; i < 24; ++i) map.cells.push_back(static_cast<std::uint8_t>((i * (m + 1) / 5 + m) % 3));
    page.maps.push_back(map);
  }
  page.maps[3].note = "7 wrong";
  return page;
}

Box box_of(const std::string& element) {
  const auto number = [&](const std::string& name) {
    std::smatch match;
    EXPECT_TRUE(std::regex_search(element, match, std::regex(" " + name + "=\"([-0-9.]+)\""))) << element;
    return std::stod(match[1]);
  };
  const double x = number("x"), y = number("y");
  return {x, y, x + number("width"), y + number("height")};
}

std::vector<std::string> elements(const std::string& svg, const std::string& pattern) {
  std::vector<std::string> found;
  const std::regex regex(pattern);
  for (std::sregex_iterator at(svg.begin(), svg.end(), regex), end; at != end; ++at) found.push_back(at->str());
  return found;
}

/// How large an area of each class is inside of `frame`, in cells.
std::map<std::string, double> areas(const std::string& svg, const Box& frame, const HeatMapPage& page) {
  const double width = frame.width() / static_cast<double>(page.cell_columns);
  const double height = frame.height() / static_cast<double>(page.cell_rows);
  static const std::regex run(R"(M([-0-9.]+) ([-0-9.]+)h([-0-9.]+)v([-0-9.]+)h([-0-9.]+)z)");
  std::map<std::string, double> result;
  for (const std::string& path : elements(svg, "<path class=\"k\\d\"[^>]*>")) {
    const std::string name = path.substr(13, 2);
    for (std::sregex_iterator at(path.begin(), path.end(), run), end; at != end; ++at) {
      const Box cells = {std::stod((*at)[1]), std::stod((*at)[2]), std::stod((*at)[1]) + std::stod((*at)[3]),
                         std::stod((*at)[2]) + std::stod((*at)[4])};
      if (!frame.contains(box_around(cells.centre(), 0, 0))) continue;
      result[name] += cells.width() * cells.height() / (width * height);
    }
  }
  return result;
}

TEST(HeatMap, IsWellFormedAndEscapesItsTexts) {
  const std::string svg = heat_map_svg(example());
  EXPECT_EQ(xml_error(svg), "");
  EXPECT_NE(svg.find("What &amp; why"), std::string::npos);
  EXPECT_NE(svg.find("A page &lt; another"), std::string::npos);
  EXPECT_EQ(svg, heat_map_svg(example())) << "the same bytes every time";
}

TEST(HeatMap, EveryCellHasItsColour) {
  const HeatMapPage page = example();
  const std::string svg = heat_map_svg(page);
  const auto frames = elements(svg, "<rect class=\"frame\"[^>]*>");
  ASSERT_EQ(frames.size(), page.maps.size());
  for (std::size_t m = 0; m < frames.size(); ++m) {
    std::map<std::string, double> expected;
    for (const std::uint8_t k : page.maps[m].cells) expected["k" + std::to_string(k)] += 1;
    const auto found = areas(svg, box_of(frames[m]), page);
    ASSERT_EQ(found.size(), expected.size()) << m;
    for (const auto& [name, cells] : expected) EXPECT_NEAR(found.at(name), cells, 0.05) << m << " " << name;
  }
}

TEST(HeatMap, MapsLieOnThePageAndApart) {
  const HeatMapPage page = example();
  const std::string svg = heat_map_svg(page);
  std::smatch size;
  ASSERT_TRUE(std::regex_search(svg, size, std::regex("viewBox=\"0 0 800 (\\d+)\"")));
  const Box whole = {0, 0, 800, std::stod(size[1])};
  std::vector<Box> boxes;
  for (const std::string& frame : elements(svg, "<rect class=\"frame\"[^>]*>")) boxes.push_back(box_of(frame));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    EXPECT_TRUE(whole.contains(boxes[i])) << i;
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(overlap(boxes[i], boxes[j])) << i << " " << j;
  }
}

/// Widths as text_width() has them, at most; no text runs into another one or off the page.
TEST(HeatMap, TextsDoNotOverlap) {
  const std::string svg = heat_map_svg(example());
  static const std::regex element(
      R"re(<text class="\w+" x="([-0-9.]+)" y="([-0-9.]+)" font-size="(\d+)" fill="#\w+"([^>]*)>([^<]*)</text>)re");
  std::vector<std::pair<std::string, Box>> texts;
  for (std::sregex_iterator at(svg.begin(), svg.end(), element), end; at != end; ++at) {
    const std::smatch& match = *at;
    const double size = std::stod(match[3]), width = text_width(match[5].str(), size), y = std::stod(match[2]);
    double x = std::stod(match[1]);
    if (match[4].str().find("\"end\"") != std::string::npos) x -= width;
    if (match[4].str().find("\"middle\"") != std::string::npos) x -= width / 2;
    texts.emplace_back(match[5], Box{x, y - 0.8 * size, x + width, y + 0.2 * size});
  }
  ASSERT_GT(texts.size(), 20U);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    EXPECT_GE(texts[i].second.left, 0) << texts[i].first;
    EXPECT_LE(texts[i].second.right, 800) << texts[i].first;
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_FALSE(overlap(texts[i].second, texts[j].second)) << texts[i].first << " and " << texts[j].first;
    }
  }
}

TEST(HeatMap, NotesStandInRedAboveTheirMapsOnly) {
  HeatMapPage page = example();
  EXPECT_EQ(elements(heat_map_svg(page), "<text class=\"alarm\"[^>]*>7 wrong</text>").size(), 1U);
  page.maps[3].note = "";
  EXPECT_EQ(heat_map_svg(page).find("class=\"alarm\""), std::string::npos);
}

}  // namespace
}  // namespace tightrope::charts
