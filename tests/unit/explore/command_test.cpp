#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/unit/explore/predicates.h"

namespace tightrope::codegen::explore {
namespace {

namespace fs = std::filesystem;
using testing_support::orientation;
using testing_support::ScratchFolder;
using tightrope::testing_support::read_text;

struct Outcome {
  int status = -1;
  std::string output;
  std::string errors;
};

/// Runs `tightrope explore ARGUMENTS` in a folder, with `environment` before it.
Outcome explore(const ScratchFolder& folder, const std::string& arguments, const std::string& environment = "") {
  const std::string in_folder = "cd '" + folder.path().string() + "' && ";
  const std::string command =
      in_folder + environment + " '" TIGHTROPE_COMMAND "' explore " + arguments + " >.out 2>.err";
  const int status = std::system(command.c_str());
  Outcome run{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder.path() / ".out"),
              read_text(folder.path() / ".err")};
  return run;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(ExploreCommand, WithoutTimesTheTableIsTheSameEverywhere) {
  const ScratchFolder folder;
  folder.write("orientation.pred", orientation);
  const Outcome run = explore(folder, "orientation.pred --no-time");
  EXPECT_EQ(run.status, 0) << run.errors;
  const fs::path golden = TIGHTROPE_SOURCE_DIR "/tests/unit/explore/orientation.txt";
  if (std::getenv("TIGHTROPE_UPDATE_GOLDEN") != nullptr) std::ofstream(golden) << run.output;
  EXPECT_EQ(run.output, read_text(golden));
  EXPECT_EQ(explore(folder, "orientation.pred --no-time", "CXX=nonsense").output, run.output);
}

TEST(ExploreCommand, NamesWhatItDoesNotKnow) {
  const ScratchFolder folder;
  folder.write("orientation.pred", orientation);
  folder.write("two.pred", std::string(orientation) + "predicate other(scalar x, y) { sign x + y as z }\n");
  const auto refused = [&](const std::string& arguments, const std::string& message, int status = 2) {
    const Outcome run = explore(folder, arguments);
    EXPECT_EQ(run.status, status) << arguments;
    EXPECT_EQ(run.output, "") << arguments;
    EXPECT_TRUE(has(run.errors, message)) << arguments << ": " << run.errors;
  };
  refused("nothing.pred", "cannot read nothing.pred");
  refused("two.pred --no-time", "--predicate: choose one of two.pred: orientation, other");
  refused("two.pred --no-time --predicate missing", "two.pred has no 'missing' (it has orientation, other)");
  refused("orientation.pred --no-time --stage last", "`orientation` has no 'last' (it has evaluate)");
  refused("orientation.pred --real half", "unknown value 'half'");
  refused("orientation.pred --format xml", "unknown value 'xml'");
  refused("orientation.pred --emit tight-magic -o out", "`orientation` has no scheme 'tight-magic' (it has tight, ");
  refused("orientation.pred --tests", "--tests belongs to --emit");
  refused("orientation.pred --no-time -o orientation.pred/chart.svg", "chart.svg");
  refused("orientation.pred --no-time --inputs missing.csv", "cannot read missing.csv");
  folder.write("wrong.pred", "predicate f(scalar a, vec3 v) { sign a + v as y }\n");
  refused("wrong.pred --no-time", "wrong.pred:1:", 1);
}

TEST(ExploreCommand, SaysThatThereIsNoCompiler) {
  const ScratchFolder folder;
  folder.write("orientation.pred", orientation);
  const Outcome named = explore(folder, "orientation.pred", "CXX=no-such-compiler");
  EXPECT_EQ(named.status, 2);
  EXPECT_TRUE(has(named.errors, "$CXX is 'no-such-compiler', which is no program")) << named.errors;
  const Outcome none = explore(folder, "orientation.pred", "CXX= PATH=");
  EXPECT_EQ(none.status, 2);
  EXPECT_TRUE(has(none.errors, "no C++ compiler")) << none.errors;
  const Outcome broken = explore(folder, "orientation.pred -o out.svg", "CXX=false");
  EXPECT_EQ(broken.status, 2);
  EXPECT_TRUE(has(broken.errors, "cannot compile the schemes")) << broken.errors;
  EXPECT_FALSE(fs::exists(folder.path() / "out.svg"));
}

TEST(ExploreCommand, DrawsAChart) {
  const ScratchFolder folder;
  folder.write("orientation.pred", orientation);
  const Outcome run = explore(folder, "orientation.pred --no-time -o chart.svg");
  ASSERT_EQ(run.status, 0) << run.errors;
  const std::string chart = read_text(folder.path() / "chart.svg");
  for (const char* part : {"tight-fma", "safe", "interval", "operations"}) EXPECT_TRUE(has(chart, part)) << part;
  const Outcome refused = explore(folder, "orientation.pred --no-time -o chart.gif");
  EXPECT_EQ(refused.status, 2);
  EXPECT_EQ(refused.output, "");
}

TEST(ExploreCommand, ReadsInputs) {
  const ScratchFolder folder;
  folder.write("orientation.pred", orientation);
  folder.write("good.csv", "# a, b, c\n0,0,1,0,0x1p-2,1\r\n\n0, 0, 1, 0, 0.5, -1e-3\n");
  const Outcome good = explore(folder, "orientation.pred --no-time --inputs good.csv --format json");
  ASSERT_EQ(good.status, 0) << good.errors;
  const auto json = nlohmann::json::parse(good.output);
  EXPECT_EQ(json["inputs"], "given");
  EXPECT_EQ(json["samples"], 2);
  const auto refused = [&](const std::string& text, const std::string& message) {
    folder.write("bad.csv", text);
    const Outcome run = explore(folder, "orientation.pred --no-time --inputs bad.csv");
    EXPECT_EQ(run.status, 2) << text;
    EXPECT_TRUE(has(run.errors, message)) << run.errors;
  };
  refused("0,0,1,0,1,1\n0,0,1,0,1\n", "bad.csv:2: 5 numbers, but `orientation` takes 6");
  refused("0,0,1,0,1,x\n", "bad.csv:1: 'x' is no finite number");
  refused("0,0,1,0,1,inf\n", "bad.csv:1: 'inf' is no finite number");
  refused("# nothing\n", "bad.csv has no inputs");
}

TEST(ExploreCommand, EmitsTheHeaderOfAScheme) {
  const ScratchFolder folder;
  folder.write("f.pred", testing_support::everything);
  EXPECT_EQ(explore(folder, "f.pred --emit tight-delta-fma-recompute -o out --tests").status, 0);
  const std::string header = read_text(folder.path() / "out" / "f.tight.double.h");
  EXPECT_TRUE(has(header, "// Evaluation scheme tight-delta-fma-recompute (docs/explore.md).\n")) << header;
  EXPECT_TRUE(has(header, "struct State {};")) << "nothing is kept";
  EXPECT_TRUE(fs::exists(folder.path() / "out" / "f.test.cpp"));
  EXPECT_EQ(explore(folder, "f.pred --emit float-fma --real float -o out").status, 0);
  EXPECT_TRUE(has(read_text(folder.path() / "out" / "f.float.float.h"), "-mfma"));
  EXPECT_EQ(explore(folder, "f.pred --emit safe-float-first -o out").status, 0);
  EXPECT_TRUE(has(read_text(folder.path() / "out" / "f.safe.double.h"), "everything_filter"));
  const Outcome refused = explore(folder, "f.pred --emit safe-float-first --real float --tests -o other");
  EXPECT_EQ(refused.status, 2);
  EXPECT_FALSE(fs::exists(folder.path() / "other"));
}

}  // namespace
}  // namespace tightrope::codegen::explore
