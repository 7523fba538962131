#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "ccd/query.h"
#include "scenes/scene.h"
#include "scenes/truth.h"
#include "tests/unit/ccd/command_runner.h"
#include "tests/unit/ccd/hdf5_file.h"
#include "tightrope/batch.h"

namespace tightrope::ccd {
namespace {

using nlohmann::json;

json evaluate(const ScratchDirectory& scratch, std::vector<std::string> arguments, std::string* notes = nullptr) {
  arguments.insert(arguments.begin(), {"evaluate", "--format", "json"});
  const Outcome outcome = run_command(scratch, arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  if (notes != nullptr) {
    *notes = outcome.err;
  } else {
    EXPECT_EQ(outcome.err, "");
  }
  return json::parse(outcome.out);
}

/// A vertex at height `start` that moves to height `end` over the middle of a triangle in the plane z = 0, which rests.
std::string falling_vertex(const std::string& start, const std::string& end, const std::string& truth) {
  const std::string face = ",-1,-1,0,2,-1,0,-1,2,0";
  return "0,0," + start + face + ",0,0," + end + face + (truth.empty() ? "" : "," + truth) + "\n";
}

TEST(Evaluate, JsonHasTheFieldsOfTheContractForEveryMethodAndKind) {
  const ScratchDirectory scratch;
  const std::string file = (scratch.path() / "q.h5").string();
  ASSERT_EQ(run_command(scratch, {"generate", "degenerate", "--queries", "400", "-o", file}).status, 0);
  const json rows = evaluate(scratch, {file});
  ASSERT_EQ(rows.size(), 2 * methods().size());
  std::size_t at = 0;
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    std::vector<double> points(400 * 24);
    std::vector<unsigned char> truths(400);
    std::vector<unsigned char> answers(400);
    generate(Scene::degenerate, kind, 400, 1)->fill(points);
    exact_truths(kind, points, truths);
    for (const MethodInfo& method : methods()) {
      collides(kind, points.data(), 400, answers.data(), method.method);
      int collisions = 0;
      int false_positives = 0;
      int false_negatives = 0;
      for (std::size_t i = 0; i < 400; ++i) {
        collisions += truths[i];
        false_positives += answers[i] > truths[i] ? 1 : 0;
        false_negatives += answers[i] < truths[i] ? 1 : 0;
      }
      const json& row = rows[at++];
      EXPECT_EQ(row.size(), 13U);
      EXPECT_EQ(row["method"], method.name);
      EXPECT_EQ(row["kind"], name(kind));
      EXPECT_EQ(row["real"], "double");
      EXPECT_EQ(row["device"], "cpu");
      EXPECT_EQ(row["threads"], 1);
      EXPECT_EQ(row["instructions"], name(instruction_sets().back()));
      EXPECT_EQ(row["queries"], 400);
      EXPECT_EQ(row["collisions"], collisions);
      EXPECT_EQ(row["false_positives"], false_positives);
      EXPECT_EQ(row["false_negatives"], false_negatives);
      SignCounts counts;
      for (std::size_t i = 0; i < 400; ++i) collides(kind, points.data() + 24 * i, method.method, counts);
      EXPECT_EQ(row["uncertain"], counts.uncertain);
      EXPECT_GT(counts.uncertain, 0U) << method.name;
      EXPECT_GT(row["ns_per_query"], 0);
      EXPECT_LT(row["ns_per_query"], 1e6);
      EXPECT_GT(row["time_ratio_to_tight"], 0);
    }
  }
}

/// The vertex ends 1e-9 above the face, whose height is no float: in float it may end on the face.
TEST(Evaluate, InFloatTheTruthIsThatOfTheRoundedQueries) {
  const ScratchDirectory scratch;
  const std::string face = ",-1,-1,1,2,-1,1,-1,2,1";
  const std::string short_of_face = "0,0,2" + face + ",0,0,1.000000001" + face + ",0\n";
  const std::string exact_in_float = "0,0,2" + face + ",0,0,1.5" + face + ",0\n";
  const std::string too_large = "0,0,1e300" + face + ",0,0,-1e300" + face + ",1\n";
  const std::string file = scratch.write("vertex-face.csv", short_of_face + exact_in_float + too_large);
  std::string notes;
  const json rows = evaluate(scratch, {"--method", "tight,bsc-safe", "--real", "all", file}, &notes);
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0]["real"], "double");
  EXPECT_EQ(rows[0]["queries"], 3);
  EXPECT_EQ(rows[0]["collisions"], 1);
  for (const std::size_t row : {2U, 3U}) {
    EXPECT_EQ(rows[row]["method"], rows[row - 2]["method"]);
    EXPECT_EQ(rows[row]["real"], "float");
    EXPECT_EQ(rows[row]["queries"], 2);
    EXPECT_EQ(rows[row]["collisions"], 1);
    EXPECT_EQ(rows[row]["false_negatives"], 0);
    EXPECT_EQ(rows[row]["false_positives"], 0);
  }
  EXPECT_EQ(rows[2]["time_ratio_to_tight"], 1.0);
  EXPECT_EQ(notes,
            "tightrope-ccd: warning: queries beyond the range of float, left out there: 1\n"
            "tightrope-ccd: warning: queries that rounding to float changes; their truth in float was decided exactly: "
            "1\n");
}

/// Numbers of a float32 file are floats: nothing is rounded, no truth decided anew.
TEST(Evaluate, InFloatAFloat32FileIsReadAsItIs) {
  const ScratchDirectory scratch;
  const auto x = [](double value) { return static_cast<double>(static_cast<float>(value)); };
  const std::vector<double> points = {0.1, 0.1, 0.7, -1, -1, 0.1, 2, -1, 0.1, -1, 2, 0.1,
                                      0.1, 0.1, 0.3, -1, -1, 0.1, 2, -1, 0.1, -1, 2, 0.1};
  std::vector<double> rounded;
  for (const double value : points) rounded.push_back(x(value));
  Hdf5File file(scratch.path() / "q.h5");
  file.queries("vertex-face/queries", rounded, H5T_IEEE_F32LE).truth("vertex-face/truth", {1});  // it is no contact
  const json row = evaluate(scratch, {"--method", "tight", "--real", "float", file.close().string()})[0];
  EXPECT_EQ(row["queries"], 1);
  EXPECT_EQ(row["collisions"], 1);
  EXPECT_EQ(row["false_negatives"], 1);
}

TEST(Evaluate, TheRatioIsToTightAlsoWhenTightIsNotAskedFor) {
  const ScratchDirectory scratch;
  const std::string file = (scratch.path() / "q.h5").string();
  ASSERT_EQ(run_command(scratch, {"generate", "random", "--queries", "500", "-o", file}).status, 0);
  const json both = evaluate(scratch, {"--method", "tight,bsc-float,tight", file});
  ASSERT_EQ(both.size(), 4U);
  EXPECT_EQ(both[0]["method"], "tight");
  EXPECT_EQ(both[0]["time_ratio_to_tight"], 1.0);
  EXPECT_EQ(both[1]["method"], "bsc-float");
  const double times = both[1]["ns_per_query"].get<double>() / both[0]["ns_per_query"].get<double>();
  EXPECT_NEAR(both[1]["time_ratio_to_tight"].get<double>(), times, 0.01);
  const json one = evaluate(scratch, {"--method", "bsc-float", file});
  ASSERT_EQ(one.size(), 2U);
  EXPECT_GT(one[0]["time_ratio_to_tight"].get<double>(), 0.01);
}

TEST(Evaluate, CountsFalseNegativesAndPositivesAgainstTheFilesTruthAndStillExitsWithSuccess) {
  const ScratchDirectory scratch;
  const std::string through = falling_vertex("1", "-1", "1");
  const std::string above = falling_vertex("2", "1", "0");
  const std::string claimed_contact = falling_vertex("2", "1", "1");
  const std::string claimed_miss = falling_vertex("1", "-1", "0");
  const std::string file =
      scratch.write("vertex-face.csv", through + above + claimed_contact + claimed_contact + claimed_miss + above);
  const json row = evaluate(scratch, {"--method", "tight", file})[0];
  EXPECT_EQ(row["queries"], 6);
  EXPECT_EQ(row["collisions"], 3);
  EXPECT_EQ(row["false_negatives"], 2);
  EXPECT_EQ(row["false_positives"], 1);
}

TEST(Evaluate, ExactTruthReplacesTheFilesAndSaysWhereItDiffers) {
  const ScratchDirectory scratch;
  const std::string file =
      scratch.write("vertex-face.csv",
                    falling_vertex("1", "-1", "0") + falling_vertex("2", "1", "0") + falling_vertex("1", "0", "1"));
  std::string notes;
  const json row = evaluate(scratch, {"--method", "tight", "--truth", "exact", file}, &notes)[0];
  EXPECT_EQ(row["collisions"], 2);
  EXPECT_EQ(row["false_negatives"], 0);
  EXPECT_EQ(notes, "tightrope-ccd: warning: the files tell a truth that is not the exact one for 1 of the queries\n");
}

TEST(Evaluate, WithoutTruthTimesButNoCounts) {
  const ScratchDirectory scratch;
  scratch.write("a/vertex-face.csv", falling_vertex("1", "-1", "1"));
  scratch.write("b/vertex-face.csv", falling_vertex("1", "-1", ""));
  const std::string all = scratch.path().string();
  std::string notes;
  const json row = evaluate(scratch, {"--method", "tight", all}, &notes)[0];
  EXPECT_EQ(row["queries"], 2);
  for (const char* field : {"collisions", "false_positives", "false_negatives"})
    EXPECT_TRUE(row[field].is_null()) << field;
  EXPECT_GT(row["ns_per_query"], 0);
  EXPECT_EQ(
      notes,
      "tightrope-ccd: warning: the truth is not known, a file tells none; --truth exact decides the queries exactly\n");
  const Outcome demanded = run_command(scratch, {"evaluate", "--truth", "file", all});
  EXPECT_EQ(demanded.status, 2);
  EXPECT_EQ(demanded.err, "tightrope-ccd: error: " + (scratch.path() / "b/vertex-face.csv").string() +
                              ": tells no truth; --truth exact decides the queries exactly\n");
  EXPECT_EQ(evaluate(scratch, {"--method", "tight", "--truth", "exact", all})[0]["collisions"], 2);
}

TEST(Evaluate, FilesOfAllPathsAreSummedByKind) {
  const ScratchDirectory scratch;
  for (const std::string seed : {"1", "2"}) {
    const std::string output = (scratch.path() / ("s" + seed)).string();
    ASSERT_EQ(run_command(scratch, {"generate", "random", "--queries", "50", "--seed", seed, "-o", output}).status, 0);
  }
  const json rows =
      evaluate(scratch, {"--method", "tight", (scratch.path() / "s1").string(), (scratch.path() / "s2").string()});
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0]["queries"], 100);
  EXPECT_EQ(rows[1]["queries"], 100);
  const json edges = evaluate(scratch, {"--method", "tight", "--kind", "edge-edge", scratch.path().string()});
  ASSERT_EQ(edges.size(), 1U);
  EXPECT_EQ(edges[0]["kind"], "edge-edge");
  EXPECT_EQ(edges[0]["collisions"], rows[1]["collisions"]);
}

TEST(Evaluate, MoreQueriesThanABlockAreAllCounted) {
  const ScratchDirectory scratch;
  const std::string row = falling_vertex("1", "-1", "1") + falling_vertex("2", "1", "0");
  std::string text;
  constexpr int rows = 70000;
  for (int i = 0; i < rows; ++i) text += row;
  const json all = evaluate(scratch, {"--method", "tight", scratch.write("vertex-face.csv", text)})[0];
  EXPECT_EQ(all["queries"], 2 * rows);
  EXPECT_EQ(all["collisions"], rows);
  EXPECT_EQ(all["false_negatives"], 0);
  EXPECT_EQ(all["false_positives"], 0);
}

TEST(Evaluate, CsvHasTheSameFieldsAndTheTableAsManyRows) {
  const ScratchDirectory scratch;
  scratch.write("vertex-face.csv", falling_vertex("1", "-1", "1") + falling_vertex("1", "-1", "0"));
  const std::string all = scratch.path().string();
  const Outcome csv = run_command(scratch, {"evaluate", "--method", "tight", "--format", "csv", all});
  std::istringstream lines(csv.out);
  std::string header;
  std::string values;
  std::string rest;
  std::getline(lines, header);
  std::getline(lines, values);
  EXPECT_EQ(header,
            "method,kind,real,device,threads,queries,collisions,false_positives,false_negatives,uncertain,"
            "ns_per_query,time_ratio_to_tight,instructions");
  EXPECT_EQ(values.substr(0, 39), "tight,vertex-face,double,cpu,1,2,1,1,0,");
  EXPECT_FALSE(std::getline(lines, rest));
  const Outcome table = run_command(scratch, {"evaluate", all});
  EXPECT_EQ(table.status, 0);
  EXPECT_EQ(static_cast<std::size_t>(std::count(table.out.begin(), table.out.end(), '\n')), 1 + methods().size());
}

TEST(Evaluate, WrongFilesAreOneLineAndNoTable) {
  const ScratchDirectory scratch;
  const std::string good = scratch.write("vertex-face/a.csv", falling_vertex("1", "-1", "1"));
  const std::string bad = scratch.write("vertex-face/b.csv", falling_vertex("1", "nan", "1"));
  const Outcome outcome = run_command(scratch, {"evaluate", "--format", "json", scratch.path().string()});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "tightrope-ccd: error: " + bad + ":1: 'nan' is not finite as a double\n");
  const Outcome missing = run_command(scratch, {"evaluate", good, good + "x"});
  EXPECT_EQ(missing.status, 2);
  EXPECT_EQ(missing.err, "tightrope-ccd: error: " + good + "x: no such file or directory\n");
}

TEST(Evaluate, RoundedRationalsAreCountedInAWarning) {
  const ScratchDirectory scratch;
  std::string text;
  for (int row = 0; row < 8; ++row) text += "1,3,1,1," + std::to_string(row) + ",1,0\n";
  std::string notes;
  evaluate(scratch, {"--method", "tight", scratch.write("edge-edge.csv", text)}, &notes);
  EXPECT_EQ(notes, "tightrope-ccd: warning: 8 rational coordinates are no doubles and were rounded to nearest\n");
}

}  // namespace
}  // namespace tightrope::ccd
