#include "codegen/explore/exploration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/unit/explore/predicates.h"

namespace tightrope::codegen::explore {
namespace {

using namespace testing_support;

Exploration explored(const std::string& text, bool time) {
  const Lowerings source = lowerings(text);
  ExplorationRequest request;
  request.time = time;
  request.timing.last_stage = source.written().stages.size() - 1;
  request.timing.rounds = 3;
  std::string error;
  if (time) request.timing.compiler = find_compiler(error);
  const auto rows = random_rows(source.written(), Precision::binary64, 200);
  Exploration result = explore(source, rows, request, error);
  EXPECT_EQ(error, "");
  return result;
}

const Entry& find(const Exploration& exploration, const std::string& name) {
  const auto& all = exploration.entries;
  const auto found = std::find_if(all.begin(), all.end(), [&](const Entry& e) { return e.candidate.name() == name; });
  EXPECT_NE(found, all.end()) << name;
  return found == all.end() ? all.front() : *found;
}

TEST(Exploration, EveryBoundedSchemeIsSoundAndOpenSignsFollowTheBounds) {
  const Exploration exploration = explored(everything, false);
  EXPECT_GT(exploration.near_zero, 50U);
  for (const Entry& entry : exploration.entries) {
    EXPECT_TRUE(entry.accuracy.sound) << entry.candidate.name();
    const bool bounded = entry.candidate.scheme.bound != BoundMode::none;
    EXPECT_TRUE(!bounded || entry.accuracy.wrong == 0) << entry.candidate.name();
  }
  const Accuracy& tight = find(exploration, "tight").accuracy;
  EXPECT_EQ(tight.size, 1);
  EXPECT_GT(find(exploration, "safe").accuracy.size, 2);
  EXPECT_GT(find(exploration, "safe").accuracy.undecided, tight.undecided);
  EXPECT_LT(find(exploration, "tight-balanced").accuracy.size, 1.01);
  EXPECT_GT(tight.median_ratio, 1);
}

TEST(Exploration, TheFrontHasNoMemberThatAnotherBeats) {
  const Exploration exploration = explored(everything, false);
  int members = 0;
  for (const Entry& a : exploration.entries) {
    EXPECT_FALSE(a.on_front && a.candidate.scheme.bound == BoundMode::none) << "without a bound nothing is known";
    if (a.candidate.scheme.bound == BoundMode::none || a.candidate.filter) continue;
    const bool beaten = std::any_of(exploration.entries.begin(), exploration.entries.end(), [&](const Entry& b) {
      if (b.candidate.scheme.bound == BoundMode::none || b.candidate.filter) return false;
      const bool better = exploration.cost(b) < exploration.cost(a) || b.accuracy.size < a.accuracy.size;
      return better && exploration.cost(b) <= exploration.cost(a) && b.accuracy.size <= a.accuracy.size;
    });
    EXPECT_FALSE(a.on_front && beaten) << a.candidate.name();
    members += a.on_front;
  }
  EXPECT_GT(members, 1);
}

TEST(Exploration, DismissedSchemesHaveABetterOne) {
  const Exploration exploration = explored(everything, false);
  int dismissed = 0;
  for (const Entry& entry : exploration.entries) {
    if (!entry.dismissed) continue;
    ++dismissed;
    EXPECT_TRUE(std::any_of(exploration.entries.begin(), exploration.entries.end(), [&](const Entry& other) {
      return other.candidate.scheme.bound == entry.candidate.scheme.bound && !other.candidate.filter &&
             other.candidate.operations(1) * dismissal_factor < entry.candidate.operations(1) &&
             other.accuracy.size <= entry.accuracy.size;
    })) << entry.candidate.name();
    EXPECT_FALSE(entry.on_front) << entry.candidate.name();
  }
  EXPECT_GT(dismissed, 0);
}

/// An unsound scheme is said to be unsound, and is on no front.
TEST(Exploration, ABoundThatIsTooSmallIsNoticed) {
  const Lowerings source = lowerings(cancelling);
  const auto all = candidates(source, Precision::binary64);
  Candidate weak = all.front();
  dsl::Diagnostics diagnostics;
  weak.bounded = add_bounds(weak.predicate, BoundMode::tight, Precision::binary64, diagnostics,
                            Weakening::drop_rounding_of_products);
  const Samples measured =
      samples(source.written(), random_rows(source.written(), Precision::binary64, 300), Precision::binary64, 0);
  const auto reference = compute_all(all.front(), measured.rows, 0);
  EXPECT_TRUE(measure_accuracy(all.front(), reference, measured, 0).sound);
  const Accuracy accuracy = measure_accuracy(weak, reference, measured, 0);
  EXPECT_FALSE(accuracy.sound);
  EXPECT_LT(accuracy.size, 1);
  Exploration exploration;
  exploration.stages = {"evaluate"};
  exploration.entries.push_back({.candidate = weak, .accuracy = accuracy, .time = {}});
  mark_front(exploration);
  EXPECT_FALSE(exploration.entries[0].on_front);
}

/// A scheme that has no value where the reference has one is no better than it.
TEST(Exploration, NoValueIsNoSmallBound) {
  const Lowerings source = lowerings(cancelling);
  const Candidate tight = candidates(source, Precision::binary64).front();
  const Samples measured =
      samples(source.written(), random_rows(source.written(), Precision::binary64, 50), Precision::binary64, 0);
  Candidate broken = tight;
  const dsl::NodeId nan = broken.bounded.graph.binary(dsl::Op::certain_nonzero, broken.bounded.graph.constant(0),
                                                      broken.bounded.graph.constant(0));
  for (OutputBound& output : broken.bounded.stages[0].outputs) {
    for (BoundedNode& element : output.elements) element.value = nan;
  }
  const auto reference = compute_all(tight, measured.rows, 0);
  EXPECT_EQ(measure_accuracy(tight, reference, measured, 0).size, 1);
  EXPECT_EQ(measure_accuracy(broken, reference, measured, 0).size, INFINITY);
}

/// Normalized inputs, and alternatives that are chosen at run time.
TEST(Exploration, KnowsEveryOperationOfTheLanguage) {
  const Exploration exploration = explored(
      "predicate f(moving point2 p, a, b, scalar s) {\n"
      "  normalize p, a, b\n"
      "  sign either(det(b - a, p - a), det(b - p, a - p) * -1) as area\n"
      "}\n",
      false);
  for (const Entry& entry : exploration.entries) {
    EXPECT_TRUE(entry.accuracy.sound) << entry.candidate.name();
    EXPECT_FALSE(entry.candidate.scheme.float_first);
  }
}

TEST(Timing, CompilesAndRunsEverySchemeOfAPredicate) {
  std::string error;
  if (find_compiler(error).empty()) GTEST_SKIP() << error;
  const Exploration exploration = explored(
      "predicate f(moving point2 a, b, c, bounded scalar k[2], scalar s) {\n"
      "  stage one { let d = det(b - a, c - a) sign d }\n"
      "  stage two { sign k[0] * s + k[1] as line, d at s as there }\n"
      "}\n",
      true);
  int timed = 0;
  for (const Entry& entry : exploration.entries) {
    if (entry.dismissed || entry.time.median == 0) continue;
    ++timed;
    EXPECT_LE(entry.time.lower_quartile, entry.time.median);
    EXPECT_LE(entry.time.median, entry.time.upper_quartile);
    EXPECT_LT(entry.time.median, 1e6);
  }
  EXPECT_GT(timed, 10);
  EXPECT_LT(find(exploration, "float").time.lower_quartile, find(exploration, "interval").time.upper_quartile);
  const auto parsed = nlohmann::json::parse(json(exploration));
  EXPECT_EQ(parsed["schemes"].size(), exploration.entries.size());
  EXPECT_TRUE(parsed["timed"]);
  EXPECT_TRUE(parsed["schemes"][0].contains("nanoseconds"));
}

}  // namespace
}  // namespace tightrope::codegen::explore
