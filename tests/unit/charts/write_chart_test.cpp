#include "codegen/charts/write_chart.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <regex>

#include "codegen/charts/text.h"
#include "tests/unit/ccd/scratch_directory.h"
#include "tests/unit/charts/boxes.h"
#include "tests/unit/charts/evaluation_rows.h"
#include "tests/unit/charts/xml.h"

namespace tightrope::charts {
namespace {

using ccd::ScratchDirectory;
using ccd::text_of;

const std::vector<ccd::Precision> both = {ccd::Precision::in_double, ccd::Precision::in_float};

std::string written(const ScratchDirectory& scratch, const Chart& chart, const std::string& name) {
  const std::string file = (scratch.path() / name).string();
  EXPECT_EQ(check_chart_file(file), "");
  EXPECT_EQ(write_chart(chart, file), "");
  return text_of(file);
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

/// The texts as gnuplot placed them. Its places are those of the baseline, 0.325 font sizes below the middle.
std::vector<Text> texts_in(const std::string& svg) {
  static const std::regex element(
      R"re(<g transform="translate\(([0-9.]+),([0-9.]+)\)( rotate\(-90\))?"[^>]*font-size="([0-9.]+)"\s+text-anchor="(\w+)">\s*<text>(.*)</text>)re");
  std::vector<Text> texts;
  for (std::sregex_iterator at(svg.begin(), svg.end(), element), end; at != end; ++at) {
    const auto& match = *at;
    const std::string words = std::regex_replace(match[6].str(), std::regex("<[^>]*>"), "");
    if (words.empty()) continue;
    const double size = std::stod(match[4]);
    const bool upright = match[3].matched;
    const Place at_baseline{std::stod(match[1]), std::stod(match[2])};
    const Place middle{at_baseline.x - (upright ? 0.325 * size : 0), at_baseline.y - (upright ? 0 : 0.325 * size)};
    texts.push_back({.text = words,
                     .at = middle,
                     .anchor = match[5] == "start"    ? Text::Anchor::left
                               : match[5] == "middle" ? Text::Anchor::middle
                                                      : Text::Anchor::right,
                     .size = size,
                     .upright = upright});
  }
  return texts;
}

TEST(WriteChart, SvgKeepsItsTextsAsTextsThatDoNotOverlap) {
  const ScratchDirectory scratch;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Chart chart = ccd::evaluation_chart(ccd::random_rows(seed, both), "samples");
    const std::string svg = written(scratch, chart, "a.svg");
    EXPECT_EQ(xml_error(svg), "");
    const std::vector<Text> texts = texts_in(svg);
    EXPECT_EQ(overlapping(texts), "");
    const Layout place = layout(chart);
    EXPECT_EQ(texts.size(), place.texts.size());
    for (const Text& wanted : place.texts) {
      const bool there = std::any_of(texts.begin(), texts.end(), [&](const Text& t) {
        return t.text == wanted.text + wanted.exponent && std::abs(t.at.x - wanted.at.x) < 1 &&
               std::abs(t.at.y - wanted.at.y) < 1.5;
      });
      EXPECT_TRUE(there) << wanted.text;
    }
    for (const ccd::MethodInfo& method : ccd::methods()) {
      EXPECT_EQ(count(svg, "<title>" + std::string(method.name) + ", double</title>"), 2U);
      EXPECT_EQ(count(svg, "<title>" + std::string(method.name) + ", float</title>"), 2U);
    }
    EXPECT_EQ(count(svg, "<title>" + chart.title + "</title>"), 1U);
  }
}

/// Where this fails, the picture is older than the methods: docs/charts.md has the command that draws it.
TEST(WriteChart, ThePicturesOfTheDocumentationAreOfTodaysMethodsAndLegible) {
  const std::filesystem::path docs = std::filesystem::path(TIGHTROPE_SOURCE_DIR) / "docs";
  const std::string speed = text_of(docs / "speed-accuracy.svg");
  for (const ccd::MethodInfo& method : ccd::methods()) {
    const std::string name(method.name);
    EXPECT_EQ(count(speed, "<title>" + name + ", double</title>"), 2U) << name;
    EXPECT_EQ(count(speed, "<title>" + name + ", double: wrong</title>"), method.conservative ? 0U : 2U) << name;
  }
  for (const std::string& svg : {speed, text_of(docs / "bounds.svg")}) {
    EXPECT_EQ(xml_error(svg), "");
    EXPECT_GT(texts_in(svg).size(), 20U);
    EXPECT_EQ(overlapping(texts_in(svg)), "");
  }
}

TEST(WriteChart, RedCrossesAreThereIfAndOnlyIfThereAreMisses) {
  const ScratchDirectory scratch;
  auto rows = ccd::random_rows(1, {ccd::Precision::in_double});
  const std::string cross = "#gpPt1'";
  EXPECT_EQ(count(written(scratch, ccd::evaluation_chart(rows, ""), "a.svg"), "use xlink:href='" + cross), 3U);
  for (ccd::EvaluationRow& row : rows) row.mistakes->false_negatives = 0;
  const std::string svg = written(scratch, ccd::evaluation_chart(rows, ""), "a.svg");
  EXPECT_EQ(count(svg, "use xlink:href='" + cross), 0U);
  EXPECT_EQ(svg.find("missed"), std::string::npos);
}

TEST(WriteChart, BytesAreTheSameForTheSameFigures) {
  const ScratchDirectory scratch;
  const Chart chart = ccd::evaluation_chart(ccd::random_rows(7, both), "x");
  for (const std::string extension : {"svg", "png", "html"}) {
    EXPECT_EQ(written(scratch, chart, "a." + extension), written(scratch, chart, "b." + extension)) << extension;
  }
}

TEST(WriteChart, PngHasTwoDotsAPixel) {
  const ScratchDirectory scratch;
  const Chart chart = ccd::evaluation_chart(ccd::random_rows(7, both), "x");
  const std::string png = written(scratch, chart, "a.PNG");
  ASSERT_GT(png.size(), 1000U);
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1A\n");
  const auto number = [&](std::size_t at) {
    unsigned value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = 256 * value + static_cast<unsigned char>(png[i]);
    return value;
  };
  EXPECT_EQ(number(16), 1600U);
  EXPECT_EQ(number(20), static_cast<unsigned>(2 * layout(chart).height));
}

TEST(WriteChart, HtmlIsOneWellFormedFileThatNamesNoOther) {
  const ScratchDirectory scratch;
  const Chart chart = ccd::evaluation_chart(ccd::random_rows(4, both), "a <b> & 'c'");
  const std::string page = written(scratch, chart, "a.html");
  EXPECT_EQ(xml_error(page), "");
  EXPECT_EQ(page.substr(0, 15), "<!DOCTYPE html>");
  const std::size_t markers = 2 * 2 * ccd::methods().size();
  EXPECT_EQ(count(page, "<circle class=\"datum\""), markers);
  EXPECT_EQ(count(page, "<tr>"), 1 + markers);
  EXPECT_EQ(count(page, "tabindex=\"0\""), markers);
  EXPECT_NE(page.find("prefers-color-scheme"), std::string::npos);
  for (const char* foreign : {" src=", "<link", "url(", "@import", "fetch(", " href="}) {
    EXPECT_EQ(page.find(foreign), std::string::npos) << foreign;
  }
  const std::regex address("https?://[^\"' ]*");
  for (std::sregex_iterator at(page.begin(), page.end(), address), end; at != end; ++at) {
    EXPECT_TRUE(at->str().starts_with("http://www.w3.org/")) << at->str();
  }
}

/// Names of files and predicates come into charts: nothing in them is an order to gnuplot, a shell or a browser.
TEST(WriteChart, NamesAreNoOrders) {
  const ScratchDirectory scratch;
  const std::string mark = (scratch.path() / "made").string();
  const std::string evil = "'; system \"touch " + mark + "\" # `touch " + mark + "` $(touch " + mark +
                           ") </text><script>x</script> @y %d \xFF\n plot";
  Chart chart = ccd::evaluation_chart(ccd::random_rows(1, both), evil);
  chart.title = evil;
  chart.panels[0].name = evil;
  chart.panels[0].title = evil;
  chart.panels[0].series[3].name = evil;
  chart.panels[0].series[3].data[0].label = evil;
  chart.panels[0].series[3].data[0].facts.push_back({evil, evil});
  const std::string svg = written(scratch, chart, "a.svg");
  const std::string page = written(scratch, chart, "a.html");
  EXPECT_EQ(xml_error(svg), "");
  EXPECT_EQ(xml_error(page), "");
  EXPECT_EQ(svg.find("<script"), std::string::npos);
  EXPECT_EQ(count(page, "<script"), 1U);
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"a.html", "a.svg"}));
}

TEST(WriteChart, WhatCannotBeWrittenIsToldAndLeavesNothing) {
  const ScratchDirectory scratch;
  const Chart chart = ccd::evaluation_chart(ccd::random_rows(1, both), "");
  const auto path = [&](const std::string& name) { return (scratch.path() / name).string(); };
  EXPECT_EQ(check_chart_file("chart.pdf"), "chart.pdf: a chart is a .svg, .png or .html file");
  EXPECT_EQ(check_chart_file("chart"), "chart: a chart is a .svg, .png or .html file");
  EXPECT_EQ(write_chart(chart, path("chart.gif")), path("chart.gif") + ": a chart is a .svg, .png or .html file");
  const std::string missing = path("missing/chart.svg");
  EXPECT_EQ(check_chart_file(missing), "cannot write " + missing + ": No such file or directory");
  EXPECT_EQ(write_chart(chart, missing), "cannot write " + missing + ": No such file or directory");
  std::filesystem::create_directory(scratch.path() / "folder.svg");
  EXPECT_EQ(check_chart_file(path("folder.svg")), "cannot write " + path("folder.svg") + ": is a directory");
  EXPECT_NE(write_chart(chart, path("folder.svg")), "");
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"folder.svg"}));
}

TEST(WriteChart, WithoutGnuplotOrWithABrokenOneAFileThatWasThereStays) {
  const ScratchDirectory scratch;
  const ScratchDirectory programs;
  const std::string file = scratch.write("chart.svg", "before");
  const Chart chart = ccd::evaluation_chart(ccd::random_rows(1, both), "");
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", programs.path().c_str(), 1);
  const std::string checked = check_chart_file(file);
  const std::string missing = write_chart(chart, file);
  const std::string broken =
      programs.write("gnuplot", "#!/bin/sh\necho; echo 'line 3: no such terminal' >&2; exit 1\n");
  std::filesystem::permissions(broken, std::filesystem::perms::owner_all);
  const std::string failed = write_chart(chart, file);
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(checked, "charts need gnuplot, which is not installed (Debian package gnuplot-nox)");
  EXPECT_EQ(missing, "gnuplot, which draws charts, is not installed (Debian package gnuplot-nox)");
  EXPECT_EQ(failed, "gnuplot failed: line 3: no such terminal");
  EXPECT_EQ(text_of(file), "before");
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"chart.svg"}));
}

}  // namespace
}  // namespace tightrope::charts
