#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/unit/ccd/command_runner.h"
#include "tests/unit/charts/xml.h"
#include "tightrope/ccd.h"

namespace tightrope::ccd {
namespace {

std::string generated(const ScratchDirectory& scratch, const std::string& scene, const std::string& queries) {
  const std::string file = (scratch.path() / (scene + ".h5")).string();
  EXPECT_EQ(run_command(scratch, {"generate", scene, "--queries", queries, "-o", file}).status, 0);
  return file;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(EvaluateChart, ShowsWhatTheTableSays) {
  const ScratchDirectory scratch;
  const std::string queries = generated(scratch, "grazing", "600");
  const std::string chart = (scratch.path() / "chart.html").string();
  const Outcome outcome =
      run_command(scratch, {"evaluate", "--real", "all", "--format", "json", "--chart", chart, queries});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string page = text_of(chart);
  EXPECT_EQ(charts::xml_error(page), "");
  EXPECT_TRUE(has(page, "Speed against accuracy: 1,200 collision queries"));
  EXPECT_TRUE(has(page, ">grazing.h5<"));
  bool missed = false;
  for (const auto& row : nlohmann::json::parse(outcome.out)) {
    const std::string series = row["method"].get<std::string>() + ", " + row["real"].get<std::string>();
    const std::string begin = "<tr><td>" + row["kind"].get<std::string>() + "</td><td>" + series + "</td>";
    const std::size_t at = page.find(begin);
    ASSERT_NE(at, std::string::npos) << begin;
    const std::string line = page.substr(at, page.find("</tr>", at) - at);
    for (const char* field : {"false_positives", "false_negatives"}) {
      std::string number = std::to_string(row[field].get<int>());
      if (number.size() > 3) number.insert(number.size() - 3, ",");
      EXPECT_TRUE(has(line, "<td>" + number + "</td>")) << line;
    }
    missed = missed || row["false_negatives"] > 0;
  }
  EXPECT_EQ(has(page, " missed<"), missed);
}

/// CSV without truth: nothing is asked for, so what the file does not tell is decided exactly.
TEST(EvaluateChart, DecidesWhatTheFilesDoNotTell) {
  const ScratchDirectory scratch;
  const std::string face = ",-1,-1,0,2,-1,0,-1,2,0";
  const std::string queries = scratch.write(
      "vertex-face/q.csv", "0,0,1" + face + ",0,0,-1" + face + "\n0,0,1" + face + ",0,0,0.5" + face + "\n");
  const std::string chart = (scratch.path() / "chart.svg").string();
  const Outcome outcome = run_command(scratch, {"evaluate", "--method", "tight", "--chart", chart, queries});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_TRUE(has(text_of(chart), "vertex-face: 2 queries, 1 in contact"));
  EXPECT_FALSE(has(text_of(chart), "edge-edge"));
  EXPECT_EQ(run_command(scratch, {"evaluate", "--truth", "file", "--chart", chart, queries}).status, 2);
}

TEST(EvaluateChart, IsWrittenOnlyIfAllGoesWell) {
  const ScratchDirectory scratch;
  const std::string queries = scratch.write("vertex-face/q.csv", "1,2,3\n");
  const std::string chart = scratch.write("chart.svg", "before");
  const Outcome malformed = run_command(scratch, {"evaluate", "--chart", chart, queries});
  EXPECT_EQ(malformed.status, 2);
  EXPECT_EQ(text_of(chart), "before");
  const Outcome extension = run_command(scratch, {"evaluate", "--chart", "chart.pdf", queries});
  EXPECT_EQ(extension.status, 2);
  EXPECT_EQ(extension.err, "tightrope-ccd: error: chart.pdf: a chart is a .svg, .png or .html file\n");
  const Outcome unwritable = run_command(scratch, {"evaluate", "--chart", "/nowhere/chart.svg", queries});
  EXPECT_EQ(unwritable.status, 2);
  EXPECT_EQ(unwritable.err, "tightrope-ccd: error: cannot write /nowhere/chart.svg: No such file or directory\n");
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"chart.svg", "vertex-face", "vertex-face/q.csv"}));
}

Outcome report(const ScratchDirectory& scratch, const std::string& arguments) {
  const std::string out = (scratch.path() / ".out").string();
  const std::string err = (scratch.path() / ".err").string();
  const int raw = std::system(
      ("'" TIGHTROPE_COMMAND "' report " + arguments + " </dev/null >'" + out + "' 2>'" + err + "'").c_str());
  Outcome outcome{WIFEXITED(raw) ? WEXITSTATUS(raw) : -1, text_of(out), text_of(err)};
  std::filesystem::remove(out);
  std::filesystem::remove(err);
  return outcome;
}

constexpr const char* orient2d =
    "predicate orient2d(point2 a, b, c) {\n  range |a, b, c| <= 8\n  sign det(b - a, c - a) as side\n}\n";

TEST(ReportChart, HasTheBoundsOfTheModesAndTheErrorsBelow) {
  const ScratchDirectory scratch;
  const std::string program = scratch.write("orient2d.pred", orient2d);
  const std::string chart = (scratch.path() / "chart.html").string();
  const Outcome outcome = report(scratch, "'" + program + "' --chart '" + chart + "'");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, report(scratch, "'" + program + "'").out);
  const std::string page = text_of(chart);
  EXPECT_EQ(charts::xml_error(page), "");
  for (const char* series : {"safe", "tight", "static", "Gappa", "true error"}) {
    EXPECT_TRUE(has(page, std::string("<td>orient2d.side</td><td>") + series + "</td>")) << series;
  }
  EXPECT_TRUE(has(page, "orient2d.pred"));
  EXPECT_TRUE(has(page, "2^-8 of the range"));
}

TEST(ReportChart, TakesTheModesThatAreAskedForAndTellsWhatIsWrong) {
  const ScratchDirectory scratch;
  const std::string program = scratch.write("orient2d.pred", orient2d);
  const std::string chart = (scratch.path() / "chart.svg").string();
  const std::string begin = "'" + program + "' --chart '" + chart + "' ";
  ASSERT_EQ(report(scratch, begin + "--bound interval --real float").status, 0);
  EXPECT_TRUE(has(text_of(chart), "<title>interval</title>"));
  EXPECT_FALSE(has(text_of(chart), "<title>safe</title>"));
  EXPECT_TRUE(has(text_of(chart), "Computed in float."));
  const Outcome none = report(scratch, begin + "--bound float");
  EXPECT_EQ(none.status, 2);
  EXPECT_EQ(none.out, "");
  EXPECT_TRUE(has(none.err, "no bounds to draw")) << none.err;
  const Outcome extension = report(scratch, "'" + program + "' --chart chart.pdf");
  EXPECT_EQ(extension.status, 2);
  EXPECT_EQ(extension.err, "tightrope: error: chart.pdf: a chart is a .svg, .png or .html file\n");
  scratch.write("wrong.pred", "predicate f() { sign y }\n");
  const std::string other = (scratch.path() / "other.svg").string();
  EXPECT_EQ(report(scratch, "'" + (scratch.path() / "wrong.pred").string() + "' --chart '" + other + "'").status, 1);
  EXPECT_FALSE(std::filesystem::exists(other));
}

}  // namespace
}  // namespace tightrope::ccd
