/// The commands toi and stages, and the check of times.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "command/time_check.h"
#include "query_io/query_files.h"
#include "scenes/scene.h"
#include "tests/unit/ccd/command_runner.h"
#include "tightrope/contact.h"
#include "tightrope/impact.h"

namespace tightrope::ccd {
namespace {

using nlohmann::json;
using Query = std::array<double, coordinates_per_query>;

/// Writes a scene to a file; its queries in file order.
std::vector<std::pair<Kind, Query>> write_scene(const ScratchDirectory& scratch, Scene scene, const std::string& file) {
  constexpr std::size_t count = 200;
  EXPECT_EQ(run_command(scratch, {"generate", std::string(name(scene)), "--queries", "200", "-o", file}).status, 0);
  std::vector<std::pair<Kind, Query>> queries;
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    std::vector<double> points(count * coordinates_per_query);
    generate(scene, kind, count, 1)->fill(points);
    for (std::size_t i = 0; i < points.size(); i += coordinates_per_query) {
      queries.emplace_back(kind, Query{});
      std::copy_n(&points[i], coordinates_per_query, queries.back().second.begin());
    }
  }
  return queries;
}

std::vector<double> numbers(const std::string& lines) {
  std::vector<double> result;
  std::istringstream stream(lines);
  for (std::string line; std::getline(stream, line);) result.push_back(std::strtod(line.c_str(), nullptr));
  return result;
}

TEST(Toi, TellsTheTimesOfKnownQueries) {
  const ScratchDirectory scratch;
  const std::string face = ",0,0,0,4,0,0,0,4,0";
  const std::string file = scratch.write("vertex-face.csv", "1,1,1" + face + ",1,1,-2" + face + "\n" +     // 1 - 3t
                                                                "1,1,2" + face + ",1,1,1" + face + "\n" +  // above
                                                                "1,1,0" + face + ",1,1,1" + face + "\n" +  // leaves
                                                                "1,1,1" + face + ",1,1,0" + face + "\n");  // at the end
  const Outcome exact = run_command(scratch, {"toi", "--tolerance", "0", file});
  EXPECT_EQ(exact.status, 0) << exact.err;
  EXPECT_EQ(exact.err, "");
  EXPECT_EQ(exact.out, "0.3333333333333333\ninf\n0\n1\n");
  EXPECT_EQ(run_command(scratch, {"toi", "--tolerance", "0", "--t-max", "0.5", file}).out,
            "0.3333333333333333\ninf\n0\ninf\n");
}

TEST(Toi, SeparationCountsAsContact) {
  const ScratchDirectory scratch;
  const std::string face = ",0,0,0,4,0,0,0,4,0";
  const std::string file = scratch.write("vertex-face.csv", "1,1,3" + face + ",1,1,1" + face + "\n");  // 3 - 2t
  EXPECT_EQ(run_command(scratch, {"toi", file}).out, "inf\n");
  EXPECT_EQ(run_command(scratch, {"toi", "--separation", "0.75", file}).out, "inf\n");
  const std::vector<double> times = numbers(run_command(scratch, {"toi", "--separation", "2", file}).out);
  ASSERT_EQ(times.size(), 1U);
  EXPECT_LE(times[0], 0.5);
  EXPECT_GE(times[0], 0.5 - 1e-5);
}

TEST(Toi, LinesAreTheTimesOfTheLibraryToTheLastBit) {
  const ScratchDirectory scratch;
  const std::string file = (scratch.path() / "q.h5").string();
  for (const Scene scene : {Scene::lattice, Scene::grazing, Scene::tiny}) {
    const auto queries = write_scene(scratch, scene, file);
    const std::vector<double> times = numbers(run_command(scratch, {"toi", file}).out);
    const std::vector<double> exact = numbers(run_command(scratch, {"toi", "--tolerance", "0", file}).out);
    const std::vector<double> safe = numbers(run_command(scratch, {"toi", "--method", "safe", file}).out);
    ASSERT_EQ(times.size(), queries.size());
    ASSERT_EQ(exact.size(), queries.size());
    ASSERT_EQ(safe.size(), queries.size());
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const auto& [kind, query] = queries[i];
      const auto time = [](const auto& impact) { return impact ? impact->time : HUGE_VAL; };
      EXPECT_EQ(times[i], time(first_impact(pair_of(kind), query.data())));
      EXPECT_EQ(exact[i], time(first_impact(pair_of(kind), query.data(), {.tolerance = 0})));
      const auto contact = first_contact(kind, query.data(), Method::safe);
      EXPECT_EQ(safe[i], contact ? contact->earliest : HUGE_VAL);
    }
  }
}

TEST(Toi, CheckComparesWithTheExactTimes) {
  const ScratchDirectory scratch;
  const std::string file = (scratch.path() / "q.h5").string();
  for (const Scene scene : {Scene::lattice, Scene::grazing, Scene::degenerate_families}) {
    write_scene(scratch, scene, file);
    for (const std::string tolerance : {"1e-6", "0", "1e-12"}) {
      const Outcome outcome = run_command(scratch, {"toi", "--check", "--tolerance", tolerance, file});
      EXPECT_EQ(outcome.status, 0) << outcome.err;
      EXPECT_EQ(outcome.err.find("tightrope: 400 queries, "), 0U) << outcome.err;
      EXPECT_NE(outcome.err.find(" 0 missed, 0 false; 0 times late, 0 early by more than "), std::string::npos)
          << outcome.err;
    }
    const Outcome early = run_command(scratch, {"toi", "--check", "--t-max", "0.25", file});
    EXPECT_EQ(early.status, 0) << early.err;
    const Outcome safe = run_command(scratch, {"toi", "--check", "--method", "safe-tight", file});
    EXPECT_EQ(safe.status, 0) << safe.err;
    EXPECT_NE(safe.err.find(" 0 missed, "), std::string::npos) << safe.err;
    EXPECT_NE(safe.err.find("; 0 times late, "), std::string::npos) << safe.err;
  }
}

TEST(Toi, PrintsNothingWhenAnyRowIsMalformed) {
  const ScratchDirectory scratch;
  const std::string file = scratch.write("edge-edge.csv", "1,2\n");
  const Outcome outcome = run_command(scratch, {"toi", file});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "tightrope-ccd: error: " + file +
                             ":1: 2 fields; a row has 7 (xn,xd,yn,yd,zn,zd,truth; 8 rows a query), or 24 "
                             "coordinates and perhaps the truth\n");
}

/// A vertex that falls by 3 from height `start`, through a face: at time start / 3.
Query falling(double start) {
  return {1, 1, start, 0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, start - 3, 0, 0, 0, 4, 0, 0, 0, 4, 0};
}

TEST(TimeCheck, FindsEveryKindOfWrongTime) {
  const Query third = falling(1), miss = falling(4), start = falling(0);
  const double time = 1.0 / 3, later = std::nextafter(time, 1.0), earlier = std::nextafter(time, 0.0);
  const double smallest = std::numeric_limits<double>::denorm_min();
  struct Case {
    const Query& query;
    std::optional<double> answer;
    double tolerance;
    std::array<int, 4> mistakes;  // missed, false, late, early
  };
  const Case cases[] = {
      {third, time, 0, {0, 0, 0, 0}},
      {third, later, 0, {0, 0, 1, 0}},
      {third, later, 1, {0, 0, 1, 0}},
      {third, earlier, 0, {0, 0, 0, 1}},
      {third, earlier, 1e-16, {0, 0, 0, 0}},
      {third, time - 1.1e-6, 1e-6, {0, 0, 0, 1}},
      {third, time - 9e-7, 1e-6, {0, 0, 0, 0}},
      {third, std::nullopt, 1, {1, 0, 0, 0}},
      {third, 0.0, 1, {0, 0, 0, 1}},
      {third, smallest, 1, {0, 0, 0, 0}},
      {miss, std::nullopt, 0, {0, 0, 0, 0}},
      {miss, 0.5, 0, {0, 1, 0, 0}},
      {start, 0.0, 0, {0, 0, 0, 0}},
      {start, smallest, 1, {0, 0, 1, 0}},
  };
  int number = 0;
  for (const Case& c : cases) {
    TimeCheck check(c.tolerance, 1);
    check.add(Kind::vertex_face, c.query, c.answer);
    const auto& counts = check.counts();
    EXPECT_EQ(counts.missed, c.mistakes[0]) << number;
    EXPECT_EQ(counts.false_ones, c.mistakes[1]) << number;
    EXPECT_EQ(counts.late, c.mistakes[2]) << number;
    EXPECT_EQ(counts.early, c.mistakes[3]) << number;
    ++number;
  }
  TimeCheck ends_before(1e-6, earlier), ends_after(1e-6, later);
  ends_before.add(Kind::vertex_face, third, time);
  ends_after.add(Kind::vertex_face, third, time);
  EXPECT_EQ(ends_before.counts().false_ones, 1);
  EXPECT_EQ(ends_after.counts().false_ones, 0);
}

/// At the irrational time sqrt(1/2): the face falls with t^2 (it turns), relative to the vertex.
TEST(TimeCheck, EnclosesIrrationalTimesAsFinelyAsItMust) {
  const Query query{1, 0, -1, 0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, -1, 0, 0, 0, 4, 0, 0, 0, 4, -8};
  const auto impact = first_impact(Pair::vertex_face, query.data(), {.tolerance = 0});
  ASSERT_TRUE(impact);
  for (const int steps : {-1, 0, 1}) {
    TimeCheck check(0, 1);
    check.add(Kind::vertex_face, query,
              steps == 0 ? impact->time : std::nextafter(impact->time, steps < 0 ? 0.0 : 1.0));
    EXPECT_EQ(check.counts().early, steps < 0 ? 1 : 0);
    EXPECT_EQ(check.counts().late, steps > 0 ? 1 : 0);
  }
}

TEST(Stages, CountsAndSharesOfEveryFormat) {
  const ScratchDirectory scratch;
  const std::string file = (scratch.path() / "q.h5").string();
  write_scene(scratch, Scene::grazing, file);
  for (const std::string need : {"boolean", "toi"}) {
    for (const std::string real : {"double", "float"}) {
      const Outcome outcome =
          run_command(scratch, {"stages", "--need", need, "--real", real, "--format", "json", file});
      ASSERT_EQ(outcome.status, 0) << outcome.err;
      const json rows = json::parse(outcome.out);
      ASSERT_EQ(rows.size(), 10U);
      for (std::size_t kind = 0; kind < 2; ++kind) {
        int queries = 0;
        double fraction = 0, share = 0;
        for (std::size_t i = 5 * kind; i < 5 * kind + 5; ++i) {
          EXPECT_EQ(rows[i]["kind"], kind == 0 ? "vertex-face" : "edge-edge");
          queries += rows[i]["queries"].get<int>();
          fraction += rows[i]["fraction"].get<double>();
          share += rows[i]["time_share"].get<double>();
          EXPECT_EQ(rows[i]["queries"] == 0, rows[i]["ns_per_query"] == 0);
        }
        EXPECT_EQ(queries, 200);
        EXPECT_NEAR(fraction, 1, 1e-5);
        EXPECT_NEAR(share, 1, 1e-3);
      }
      EXPECT_EQ(rows[0]["stage"], "first-look");
      EXPECT_EQ(rows[4]["stage"], "exact");
    }
  }
  const Outcome csv = run_command(scratch, {"stages", "--format", "csv", "--kind", "edge-edge", file});
  EXPECT_EQ(csv.out.find("kind,stage,queries,fraction,ns_per_query,time_share\nedge-edge,first-look,"), 0U) << csv.out;
  const Outcome table = run_command(scratch, {"stages", file});
  EXPECT_NE(table.out.find("edge-edge   all"), std::string::npos) << table.out;
}

}  // namespace
}  // namespace tightrope::ccd
