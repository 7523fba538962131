/// tightrope-ccd stability, as a user runs it. What its figures are worth: tests/stability.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/unit/ccd/command_runner.h"

namespace tightrope::ccd {
namespace {

namespace fs = std::filesystem;

/// Small enough to take a moment.
std::vector<std::string> arguments(const std::string& folder, std::vector<std::string> more = {}) {
  std::vector<std::string> all = {
      "stability", "--axes", "small", "--families", "zero-area,sliding", "--method", "bsc-float,tight,bsc-exact",
      "--queries", "3",      "-o",    folder};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// What lies in a folder, hidden files too.
std::vector<std::string> names(const fs::path& folder) {
  std::vector<std::string> result;
  for (const auto& entry : fs::directory_iterator(folder)) result.push_back(entry.path().filename().string());
  std::sort(result.begin(), result.end());
  return result;
}

std::size_t times(const std::string& text, const std::string& wanted) {
  std::size_t count = 0;
  for (std::size_t at = text.find(wanted); at != std::string::npos; at = text.find(wanted, at + 1)) ++count;
  return count;
}

TEST(StabilityCommand, WritesTheFiguresThePagesAndOnePageWithAllOfThem) {
  const ScratchDirectory scratch;
  const fs::path folder = scratch.path() / "atlas";
  const Outcome outcome = run_command(scratch, arguments(folder.string()));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("\ntight "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("atlas: " + folder.string() + "/index.html\n"), std::string::npos) << outcome.out;
  const std::vector<std::string> expected = {"atlas.json",
                                             "bsc-exact-edge-edge-double.svg",
                                             "bsc-exact-vertex-face-double.svg",
                                             "bsc-float-edge-edge-double.svg",
                                             "bsc-float-vertex-face-double.svg",
                                             "index.html",
                                             "overview-edge-edge-double.svg",
                                             "overview-vertex-face-double.svg",
                                             "tight-edge-edge-double.svg",
                                             "tight-vertex-face-double.svg"};
  EXPECT_EQ(names(folder), expected);
  EXPECT_EQ(names(scratch.path()), std::vector<std::string>{"atlas"}) << "nothing else is left behind";

  const auto json = nlohmann::json::parse(text_of(folder / "atlas.json"));
  EXPECT_EQ(json.at("queries_per_cell"), 3);
  EXPECT_EQ(json.at("maps").size(), 4U);  // two families, two kinds
  EXPECT_EQ(json.at("maps")[0].at("contacts").size(), 5U * 3U * 2U);
  EXPECT_TRUE(json.at("maps")[0].at("methods").at("bsc-exact").contains("exact"));
  EXPECT_FALSE(json.at("maps")[0].at("methods").at("tight").contains("exact"));

  const std::string page = text_of(folder / "index.html");
  EXPECT_EQ(times(page, "<svg "), 8U);
  EXPECT_EQ(times(page, "class=\"frame\""), 2U * 2 * 3 + 2 * 2 * (3 + 3 + 4)) << "two families: overviews, methods";
  EXPECT_EQ(times(page, "://"), times(page, "xmlns=\"http://www.w3.org/") + 1) << "no network: one name in the script";
  for (const char* part : {"overview-vertex-face-double", "tight-edge-edge-double"}) {
    EXPECT_NE(page.find(text_of(folder / (std::string(part) + ".svg"))), std::string::npos) << part;
  }
}

TEST(StabilityCommand, IsTheSameBytesEveryTimeAndReplacesAnAtlas) {
  const ScratchDirectory scratch;
  const fs::path folder = scratch.path() / "atlas";
  ASSERT_EQ(run_command(scratch, arguments(folder.string())).status, 0);
  const std::string page = text_of(folder / "index.html");
  ASSERT_EQ(run_command(scratch, arguments(folder.string() + "/", {"--seed", "2"})).status, 0);
  EXPECT_NE(text_of(folder / "index.html"), page);
  ASSERT_EQ(run_command(scratch, arguments(folder.string())).status, 0);
  EXPECT_EQ(text_of(folder / "index.html"), page);
  EXPECT_EQ(names(scratch.path()), std::vector<std::string>{"atlas"});
}

TEST(StabilityCommand, ShowsMissesInRedWhereThereAreSome) {
  const ScratchDirectory scratch;
  const fs::path folder = scratch.path() / "atlas";
  ASSERT_EQ(run_command(scratch, {"stability", "--axes", "small", "--families", "through-vertex", "--method",
                                  "bsc-float,tight", "--real", "all", "-o", folder.string()})
                .status,
            0);
  EXPECT_NE(text_of(folder / "bsc-float-vertex-face-double.svg").find("class=\"alarm\""), std::string::npos);
  EXPECT_EQ(text_of(folder / "tight-vertex-face-double.svg").find("class=\"alarm\""), std::string::npos);
  EXPECT_EQ(times(text_of(folder / "overview-edge-edge-float.svg"), "class=\"alarm\""), 1U);
}

TEST(StabilityCommand, ErrorsAreOneLineAndLeaveNothing) {
  const ScratchDirectory scratch;
  const fs::path folder = scratch.path() / "atlas";
  const fs::path other = scratch.path() / "other";
  fs::create_directory(other);
  std::ofstream(other / "letter.txt") << "dear";
  std::ofstream(scratch.path() / "file") << "no folder";
  struct Case {
    std::vector<std::string> arguments;
    std::string message;
  };
  const std::vector<Case> cases = {
      {{"stability"}, "--output is required"},
      {arguments(folder.string(), {"--real", "half"}), "half"},
      {arguments(folder.string(), {"--kind", "vertex-vertex"}), "vertex-vertex"},
      {{"stability", "--method", "guess", "-o", folder.string()}, "unknown method 'guess'"},
      {{"stability", "--families", "sliding,happy", "-o", folder.string()},
       "unknown family 'happy'; accepted: all, deg"},
      {{"stability", "--queries", "0", "-o", folder.string()}, "--queries must be from 1"},
      {arguments(other.string()), "has other files in it"},
      {arguments((scratch.path() / "file").string()), "is no folder"},
      {arguments((scratch.path() / "no" / "where").string()), "No such file"},
  };
  for (const Case& bad : cases) {
    const Outcome outcome = run_command(scratch, bad.arguments);
    EXPECT_EQ(outcome.status, 2) << bad.message;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(bad.message), std::string::npos) << outcome.err;
    EXPECT_EQ(names(scratch.path()), (std::vector<std::string>{"file", "other"})) << bad.message;
  }
  EXPECT_EQ(names(other), std::vector<std::string>{"letter.txt"});
}

}  // namespace
}  // namespace tightrope::ccd
