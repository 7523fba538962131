#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "query_io/query_files.h"
#include "scenes/scene.h"
#include "scenes/truth.h"
#include "tests/unit/ccd/command_runner.h"
#include "tightrope/batch.h"

namespace tightrope::ccd {
namespace {

using nlohmann::json;

TEST(Command, HelpAndVersionAreAnswersNotErrors) {
  const ScratchDirectory scratch;
  for (const std::string command :
       {"methods", "evaluate", "classify", "toi", "stages", "generate", "exact", "stability", "fit"}) {
    const Outcome help = run_command(scratch, {command, "--help"});
    EXPECT_EQ(help.status, 0) << command;
    EXPECT_EQ(help.err, "") << command;
    EXPECT_NE(help.out.find("Usage: tightrope-ccd " + command), std::string::npos) << help.out;
    EXPECT_NE(run_command(scratch, {"--help"}).out.find("  " + command + " "), std::string::npos) << command;
  }
  const Outcome version = run_command(scratch, {"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_EQ(version.out.substr(0, 14), "tightrope-ccd ");
}

TEST(Command, GenerateHelpListsEveryScene) {
  const ScratchDirectory scratch;
  const std::string help = run_command(scratch, {"generate", "--help"}).out;
  for (const SceneInfo& scene : scenes()) {
    EXPECT_NE(help.find(std::string(scene.name) + " "), std::string::npos) << scene.name;
  }
}

TEST(Command, BadUsageIsOneLineThatTellsWhatIsAccepted) {
  struct BadUsage {
    std::vector<std::string> arguments;
    std::string message;
  };
  const std::string commands = "commands: methods, evaluate, classify, toi, stages, generate, exact, stability, fit";
  std::string methods;
  for (const MethodInfo& info : ccd::methods()) {
    methods += methods.empty() ? std::string(info.name) : ", " + std::string(info.name);
  }
  std::string instructions;
  for (const InstructionSet set : instruction_sets()) {
    instructions += (instructions.empty() ? "" : ", ") + std::string(name(set));
  }
  const BadUsage cases[] = {
      {{}, "A subcommand is required; " + commands},
      {{"simulate"}, "unknown command 'simulate'; " + commands},
      {{"evaluate"}, "PATH is required"},
      {{"evaluate", "--colour", "x"},
       "The following argument was not expected: --colour; accepted by evaluate: --help, "
       "--method, --truth, --real, --kind, --threads, --instructions, --device, --format, --chart, PATH"},
      {{"evaluate", "--method", "tigth", "x"}, "unknown method 'tigth'; accepted: all, " + methods},
      {{"evaluate", "--method", "tight,", "x"}, "unknown method ''; accepted: all, " + methods},
      {{"evaluate", "--format", "xml", "x"}, "--format: xml not in {table,json,csv}"},
      {{"evaluate", "--real", "half", "x"}, "--real: half not in {double,float,all}"},
      {{"evaluate", "--truth", "mine", "x"}, "--truth: mine not in {file,exact}"},
      {{"evaluate", "--kind", "face-face", "x"}, "--kind: face-face not in {vertex-face,edge-edge}"},
      {{"evaluate", "--threads", "-1", "x"}, "--threads: Value -1 not in range 0 to 4096"},
      {{"evaluate", "--device", "tpu", "x"}, "--device: tpu not in {cpu,gpu}"},
      {{"toi", "--instructions", "mmx", "x"}, "instructions 'mmx': unknown; accepted: " + instructions},
      {{"classify", "--method", "all", "x"}, "unknown method 'all'; accepted: " + methods},
      {{"classify", "x"}, "--method is required"},
      {{"toi", "--method", "tight", "x"}, "method 'tight' tells no times; those that do: tightrope, safe, safe-tight"},
      {{"toi", "--method", "all", "x"}, "unknown method 'all'; accepted: tightrope, safe, safe-tight"},
      {{"toi", "--tolerance", "-1", "x"}, "--tolerance must be 0 or more, and finite"},
      {{"toi", "--tolerance", "nan", "x"}, "--tolerance must be 0 or more, and finite"},
      {{"toi", "--tolerance", "1e-3", "--method", "safe", "x"}, "--tolerance and --separation are method tightrope's"},
      {{"toi", "--separation", "-1", "x"}, "--separation must be 0 or more, and finite"},
      {{"toi", "--separation", "inf", "x"}, "--separation must be 0 or more, and finite"},
      {{"toi", "--separation", "1", "--check", "x"}, "--check knows contact only, no --separation"},
      {{"toi", "--t-max", "1.5", "x"}, "--t-max must be from 0 to 1"},
      {{"toi"}, "PATH is required"},
      {{"stages", "--need", "everything", "x"}, "--need: everything not in {boolean,toi}"},
      {{"exact", "--width", "0", "x"}, "--width must be positive"},
      {{"methods", "--format", "csv"}, "--format: csv not in {table,json}"},
      {{"generate", "random", "-o", "x", "--queries", "0"}, "--queries must be from 1 to 1000000000"},
      {{"generate", "random"}, "--output is required"},
      {{"generate", "random", "-o", "x", "--queries", "many"}, "Could not convert: --queries = many"},
  };
  const ScratchDirectory scratch;
  for (const BadUsage& usage : cases) {
    const Outcome outcome = run_command(scratch, usage.arguments);
    EXPECT_EQ(outcome.status, 2) << usage.message;
    EXPECT_EQ(outcome.out, "") << usage.message;
    EXPECT_EQ(outcome.err, "tightrope-ccd: error: " + usage.message + "\n");
  }
  const Outcome scene = run_command(scratch, {"generate", "stones", "-o", "x"});
  EXPECT_EQ(scene.status, 2);
  EXPECT_EQ(scene.err.find("tightrope-ccd: error: unknown scene 'stones'; accepted: random, grazing, cloth-fold, "),
            0U);
}

TEST(Command, ExactTellsTheTimeOfFirstContact) {
  const ScratchDirectory scratch;
  const std::string face = ",0,0,0,4,0,0,0,4,0";
  const std::string file = scratch.write("vertex-face.csv", "1,1,1" + face + ",1,1,-2" + face + "\n" +     // 1 - 3t
                                                                "1,1,2" + face + ",1,1,1" + face + "\n" +  // above
                                                                "1,0,-1" + face + ",1,1,-1,0,0,0,4,0,0,0,4,-8\n");
  const Outcome outcome = run_command(scratch, {"exact", "--width", "0.25", file});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out.substr(0, 9), "1/3\nnone\n");
  double lower = 0, lower_den = 0, upper = 0, upper_den = 0;  // 2 t^2 = 1
  ASSERT_EQ(std::sscanf(outcome.out.c_str() + 9, "%lf/%lf %lf/%lf", &lower, &lower_den, &upper, &upper_den), 4);
  EXPECT_LT(lower / lower_den, std::sqrt(0.5));
  EXPECT_GT(upper / upper_den, std::sqrt(0.5));
  EXPECT_LE(upper / upper_den - lower / lower_den, 0.25);
}

TEST(Command, GenerateListsScenesForScripts) {
  const ScratchDirectory scratch;
  std::string all, survey;
  for (const SceneInfo& scene : scenes()) {
    all += std::string(scene.name) + "\n";
    if (scene.survey && scene.scene != Scene::degenerate_families) survey += std::string(scene.name) + "\n";
  }
  EXPECT_EQ(run_command(scratch, {"generate", "--list", "all"}).out, all);
  const Outcome outcome = run_command(scratch, {"generate", "--list", "degenerate-families"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out, survey);
}

TEST(Command, MethodsListsAllOfThem) {
  const ScratchDirectory scratch;
  const Outcome table = run_command(scratch, {"methods"});
  const json array = json::parse(run_command(scratch, {"methods", "--format", "json"}).out);
  ASSERT_EQ(array.size(), methods().size());
  for (std::size_t i = 0; i < methods().size(); ++i) {
    EXPECT_NE(table.out.find(methods()[i].name), std::string::npos);
    EXPECT_EQ(array[i]["name"], methods()[i].name);
    EXPECT_EQ(array[i]["bound"], methods()[i].bound);
    EXPECT_EQ(array[i]["conservative"], methods()[i].conservative);
    EXPECT_EQ(array[i]["exact"], methods()[i].exact);
  }
}

/// Points and truths of all queries of one kind, in file order.
QueryBlock read_all(const std::string& path, Kind kind) {
  auto files = find_query_files(std::span(&path, 1), kind);
  EXPECT_TRUE(std::holds_alternative<std::vector<QueryFile>>(files));
  QueryStream stream(std::get<std::vector<QueryFile>>(files));
  QueryBlock all;
  QueryBlock block;
  while (true) {
    const auto error = stream.next(1000, block);
    EXPECT_FALSE(error) << error->message;
    if (error || block.size() == 0) return all;
    all.points.insert(all.points.end(), block.points.begin(), block.points.end());
    all.truths.insert(all.truths.end(), block.truths.begin(), block.truths.end());
  }
}

TEST(Command, GenerateWritesTheScenesQueriesWithExactTruth) {
  const ScratchDirectory scratch;
  const std::string file = (scratch.path() / "q.h5").string();
  const std::string directory = (scratch.path() / "some" / "where").string();
  for (const std::string& output : {file, directory}) {
    const Outcome outcome =
        run_command(scratch, {"generate", "grazing", "--queries", "300", "--seed", "9", "-o", output});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      const QueryBlock written = read_all(output, kind);
      std::vector<double> points(300 * coordinates_per_query);
      std::vector<unsigned char> truths(300);
      generate(Scene::grazing, kind, 300, 9)->fill(points);
      exact_truths(kind, points, truths);
      EXPECT_EQ(written.points, points);
      EXPECT_EQ(written.truths, truths);
      const auto collisions = std::count(truths.begin(), truths.end(), 1);
      EXPECT_NE(outcome.out.find("300 " + std::string(name(kind)) + " queries, " + std::to_string(collisions) +
                                 " of them collisions"),
                std::string::npos)
          << outcome.out;
    }
  }
  const std::vector<std::string> expected = {"q.h5",
                                             "some",
                                             "some/where",
                                             "some/where/edge-edge",
                                             "some/where/edge-edge/grazing-9.csv",
                                             "some/where/vertex-face",
                                             "some/where/vertex-face/grazing-9.csv"};
  EXPECT_EQ(scratch.names(), expected);
}

/// Blocks are made while the ones before are decided: still one stream.
TEST(Command, GenerateInManyBlocksIsTheSceneToo) {
  const ScratchDirectory scratch;
  const std::string file = (scratch.path() / "q.h5").string();
  constexpr std::size_t count = 40000;
  const Outcome outcome =
      run_command(scratch, {"generate", "random", "--queries", "40000", "--kind", "vertex-face", "-o", file});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const QueryBlock written = read_all(file, Kind::vertex_face);
  std::vector<double> points(count * coordinates_per_query);
  generate(Scene::random, Kind::vertex_face, count, 1)->fill(points);
  EXPECT_TRUE(written.points == points);
  std::vector<unsigned char> truths(count);
  exact_truths(Kind::vertex_face, points, truths);
  EXPECT_TRUE(written.truths == truths);
}

TEST(Command, GenerateOfOneKindWritesNoOther) {
  const ScratchDirectory scratch;
  const std::string output = (scratch.path() / "q").string();
  EXPECT_EQ(run_command(scratch, {"generate", "random", "--queries", "5", "--kind", "edge-edge", "-o", output}).status,
            0);
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"q", "q/edge-edge", "q/edge-edge/random-1.csv"}));
}

TEST(Command, GenerateThatFailsLeavesNoFile) {
  const ScratchDirectory scratch;
  const Outcome outcome = run_command(scratch, {"generate", "random", "-o", (scratch.path() / "no" / "q.h5").string()});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.err,
            "tightrope-ccd: error: " + (scratch.path() / "no" / "q.h5").string() + ": No such file or directory\n");
  EXPECT_EQ(scratch.names(), std::vector<std::string>{});
}

TEST(Command, InterruptedGenerateLeavesNoFile) {
  const ScratchDirectory scratch;
  const std::string file = (scratch.path() / "q.h5").string();
  const int raw =
      std::system(("timeout -s INT 1 '" TIGHTROPE_CCD_COMMAND "' generate grazing --queries 100000000 -o '" + file +
                   "' >/dev/null 2>&1")
                      .c_str());
  ASSERT_TRUE(WIFEXITED(raw));
  EXPECT_EQ(WEXITSTATUS(raw), 124) << "it ended before the interrupt";
  EXPECT_EQ(scratch.names(), std::vector<std::string>{});
}

TEST(Command, ClassifyAnswersInFileOrder) {
  const ScratchDirectory scratch;
  const std::string file = (scratch.path() / "q.h5").string();
  ASSERT_EQ(run_command(scratch, {"generate", "lattice", "--queries", "5000", "-o", file}).status, 0);
  for (const MethodInfo& method : methods()) {
    std::string expected;
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      const QueryBlock block = read_all(file, kind);
      for (std::size_t i = 0; i < block.size(); ++i) {
        expected += collides(kind, block.points.data() + 24 * i, method.method) ? "1\n" : "0\n";
      }
    }
    const Outcome outcome = run_command(scratch, {"classify", "--method", std::string(method.name), file});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(outcome.out, expected) << method.name;
  }
}

TEST(Command, ClassifyPrintsNothingWhenAnyRowIsMalformed) {
  const ScratchDirectory scratch;
  std::string text;
  for (int row = 0; row < 9000; ++row) {
    for (int i = 0; i < 24; ++i) text += i == 0 ? "1" : ",2";
    text += "\n";
  }
  const std::string file = scratch.write("edge-edge.csv", text + "1,2\n");
  const Outcome outcome = run_command(scratch, {"classify", "--method", "tight", file});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "tightrope-ccd: error: " + file + ":9001: 2 fields instead of 24\n");
}

TEST(Command, AFullDiskIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const int raw = std::system("'" TIGHTROPE_CCD_COMMAND "' methods >/dev/full 2>/dev/null");
  ASSERT_TRUE(WIFEXITED(raw));
  EXPECT_EQ(WEXITSTATUS(raw), 2);
}

}  // namespace
}  // namespace tightrope::ccd
