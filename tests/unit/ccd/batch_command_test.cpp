/// What the commands have of batches: threads, instruction sets, output larger than memory should hold.

#include <gtest/gtest.h>

#include <cstdlib>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>

#include "query_io/query_writer.h"
#include "tests/unit/ccd/command_runner.h"
#include "tightrope/batch.h"
#include "tightrope/impact.h"

namespace tightrope::ccd {
namespace {

using nlohmann::json;

std::vector<std::vector<std::string>> executions() {
  std::vector<std::vector<std::string>> all = {{"--threads", "0"}, {"--threads", "3", "--instructions", "scalar"}};
  for (const InstructionSet set : instruction_sets()) {
    all.push_back({"--instructions", std::string(name(set))});
  }
  return all;
}

std::string run_with(const ScratchDirectory& scratch, std::vector<std::string> arguments,
                     const std::vector<std::string>& execution) {
  arguments.insert(arguments.end(), execution.begin(), execution.end());
  const Outcome outcome = run_command(scratch, arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return outcome.out;
}

TEST(BatchCommand, AnswersDependNeitherOnThreadsNorOnInstructions) {
  const ScratchDirectory scratch;
  const std::string file = (scratch.path() / "q.h5").string();
  for (const std::string scene : {"cloth-fold", "degenerate-families"}) {
    ASSERT_EQ(run_command(scratch, {"generate", scene, "--queries", "4200", "-o", file}).status, 0);
    for (const std::string method : {"tight", "tightrope"}) {
      const std::string alone = run_with(scratch, {"classify", "--method", method, file}, {});
      EXPECT_EQ(alone.size(), 2U * 2U * 4200U);
      for (const auto& execution : executions()) {
        EXPECT_EQ(run_with(scratch, {"classify", "--method", method, file}, execution), alone);
      }
    }
    for (const std::string method : {"tightrope"}) {
      const std::string alone = run_with(scratch, {"toi", "--method", method, file}, {});
      for (const auto& execution : executions()) {
        EXPECT_EQ(run_with(scratch, {"toi", "--method", method, file}, execution), alone);
      }
    }
  }
}

TEST(BatchCommand, EvaluateCountsTheSameAndSaysHowItRan) {
  const ScratchDirectory scratch;
  const std::string file = (scratch.path() / "q.h5").string();
  ASSERT_EQ(run_command(scratch, {"generate", "near-coplanar", "--queries", "1000", "-o", file}).status, 0);
  const std::vector<std::string> arguments = {"evaluate", "--method", "safe", "--real",
                                              "all",      "--format", "json", file};
  const json alone = json::parse(run_with(scratch, arguments, {"--instructions", "scalar"}));
  EXPECT_EQ(alone[0]["instructions"], "scalar");
  for (const auto& execution : executions()) {
    json rows = json::parse(run_with(scratch, arguments, execution));
    ASSERT_EQ(rows.size(), alone.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (const char* field : {"method", "kind", "real", "device", "queries", "collisions", "false_positives",
                                "false_negatives", "uncertain"}) {
        EXPECT_EQ(rows[i][field], alone[i][field]) << field;
      }
      const bool all_threads = execution[0] == "--threads" && execution[1] == "0";
      const int threads = execution[0] == "--threads" ? std::stoi(execution[1]) : 1;
      EXPECT_GE(rows[i]["threads"], 1);
      if (!all_threads) {
        EXPECT_EQ(rows[i]["threads"], threads);
      }
      EXPECT_EQ(rows[i]["instructions"], execution.size() == 4              ? execution[3]
                                         : execution[0] == "--instructions" ? execution[1]
                                                                            : name(instruction_sets().back()));
    }
  }
}

/// 70,000 times of about 20 characters: the output goes through a temporary file.
TEST(BatchCommand, LongOutputIsWhatTheLibraryAnswersAndNeedsATemporaryFile) {
  const ScratchDirectory scratch;
  const std::string file = (scratch.path() / "q.h5").string();
  QueryBlock block;
  constexpr std::size_t count = 70000;
  std::mt19937_64 random(3);
  for (std::size_t i = 0; i < count; ++i) {  // a vertex that falls through a triangle
    const double start = std::uniform_real_distribution<>(0, 1)(random);
    const double face[] = {-1, -1, 0, 2, -1, 0, -1, 2, 0};
    for (const double height : {start, start - 1}) {
      block.points.insert(block.points.end(), {0, 0, height});
      block.points.insert(block.points.end(), std::begin(face), std::end(face));
    }
  }
  block.truths.assign(count, 1);
  auto created = create_hdf5(file);
  QueryWriter& writer = *std::get<std::unique_ptr<QueryWriter>>(created);
  ASSERT_FALSE(writer.append(block));
  ASSERT_FALSE(writer.commit());
  std::vector<double> times(count);
  ASSERT_EQ(impact_times(Queries<double>{.kind = block.kind, .count = count, .points = block.points.data()},
                         times.data(), {}, {.threads = 0, .instructions = std::nullopt}),
            BatchStatus::done);
  const std::string lines = run_with(scratch, {"toi", "--threads", "0", file}, {});
  EXPECT_GT(lines.size(), std::size_t{1} << 20) << "too short to leave memory";
  const char* at = lines.c_str();
  for (const double time : times) {
    char* end = nullptr;
    ASSERT_EQ(std::strtod(at, &end), time);
    ASSERT_EQ(*end, '\n');
    at = end + 1;
  }
  EXPECT_EQ(*at, '\0');
  const std::string nowhere = (scratch.path() / "none").string();
  ASSERT_EQ(::setenv("TMPDIR", nowhere.c_str(), 1), 0);
  const Outcome outcome = run_command(scratch, {"toi", "--threads", "0", file});
  ::unsetenv("TMPDIR");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "tightrope-ccd: error: temporary file in " + nowhere + ": No such file or directory\n");
}

}  // namespace
}  // namespace tightrope::ccd
