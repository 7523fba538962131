#include "codegen/report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "codegen/measure.h"
#include "tests/unit/codegen/test_program.h"

namespace tightrope::codegen {
namespace {

constexpr const char* source =
    "predicate coplanarity(moving point p, a, b, c) {\n"
    "  sign dot(cross(b - a, c - a), p - a) as Y\n"
    "}\n"
    "predicate composed(bounded scalar k[3], scalar s) { value k[0] * k[1] + s * k[2] as y }\n";

nlohmann::json json_report(const std::vector<BoundMode>& modes, const std::vector<Precision>& precisions, bool measured,
                           Weakening weakening = Weakening::none) {
  const dsl::Program program = testing_support::program(source);
  dsl::Diagnostics diagnostics;
  const auto bounded = bounded_programs(program, modes, precisions, diagnostics, weakening);
  EXPECT_FALSE(diagnostics.has_errors());
  return nlohmann::json::parse(report(program, bounded, {.json = true, .measure = measured}));
}

TEST(Report, HasDegreesCountsAndSafeBounds) {
  const auto json = json_report({BoundMode::none, BoundMode::safe}, {Precision::binary64}, false);
  ASSERT_EQ(json.size(), 4U);
  const auto& plain = json[0]["stages"][0]["outputs"][0];
  EXPECT_EQ(json[0]["bound"], "float");
  EXPECT_EQ(plain["degree"], 3);
  EXPECT_EQ(plain["extents"], nlohmann::json({4}));
  EXPECT_EQ(plain["kind"], "sign");
  EXPECT_EQ(plain["bound_operations"]["total"], 0);
  EXPECT_FALSE(plain.contains("k"));
  const auto& safe = json[1]["stages"][0]["outputs"][0];
  EXPECT_EQ(json[1]["bound"], "safe");
  EXPECT_GT(safe["k"], 4);
  EXPECT_TRUE(safe["B"].get<std::string>().find("d_x d_y d_z") != std::string::npos) << safe["B"];
  EXPECT_EQ(json[2]["stages"][0]["outputs"][0]["kind"], "value");
}

TEST(Report, MeasuredBoundsCoverErrorsAndTightIsHalfOfThePublishedRules) {
  const auto json = json_report({BoundMode::safe, BoundMode::tight}, {Precision::binary64, Precision::binary32}, true);
  int measures = 0;
  for (const auto& entry : json) {
    for (const auto& measured : entry["stages"][0]["outputs"][0]["measured"]) {
      ++measures;
      EXPECT_TRUE(measured["sound"]) << entry["predicate"] << entry["bound"] << entry["real"];
      EXPECT_GE(measured["least_margin"], 0);
      EXPECT_GE(measured["bound_to_error"]["least"], 1);
      EXPECT_GT(measured["bound_to_error"]["greatest"], measured["bound_to_error"]["median"]);
      EXPECT_GT(measured["definite"], 0.99);
      if (entry["bound"] == "tight") {
        EXPECT_LE(measured["bound_to_published"]["greatest"], 0.501);
      }
    }
  }
  EXPECT_EQ(measures, 2 * 2 * 2 * 2);
}

TEST(Report, MeasurementNoticesABoundThatIsTooSmall) {
  const auto json = json_report({BoundMode::tight}, {Precision::binary64}, true, Weakening::drop_rounding_of_products);
  bool sound = true;
  for (const auto& measured : json[0]["stages"][0]["outputs"][0]["measured"]) sound = sound && measured["sound"];
  EXPECT_TRUE(json[1]["stages"][0]["outputs"][0].contains("measured"));
  bool composed_sound = true;
  for (const auto& measured : json[1]["stages"][0]["outputs"][0]["measured"]) {
    composed_sound = composed_sound && measured["sound"];
  }
  EXPECT_FALSE(sound && composed_sound);
}

TEST(Report, TextSaysTheSame) {
  const dsl::Program program = testing_support::program(source);
  dsl::Diagnostics diagnostics;
  const auto bounded = bounded_programs(program, {BoundMode::safe}, {Precision::binary64}, diagnostics);
  const std::string text = report(program, bounded, {.json = false, .measure = true});
  for (const char* part : {"coplanarity, bound safe, double\n", "sign Y[4]: degree 3 in t",
                           "k = ", "bound / error: median", "sound", "bound / published TightBound"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in\n" << text;
  }
}

TEST(Report, TableHasOneColumnForEveryMode) {
  const dsl::Program program = testing_support::program(
      "predicate p(point2 a, b, c) { range |a, b, c| <= 4 sign det(a - c, b - c) as side, a as corner }\n");
  dsl::Diagnostics diagnostics;
  const auto bounded = bounded_programs(program, {BoundMode::none, BoundMode::tight, BoundMode::fixed},
                                        {Precision::binary64}, diagnostics);
  const std::string text = report(program, bounded, {.table = true, .measure = true});
  EXPECT_EQ(text.find("| p, double | tight | static | static, rules alone |\n|---|---|---|---|\n| `side` | "), 0U)
      << text;
  EXPECT_NE(text.find("| `corner` | exact | exact | exact |\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace tightrope::codegen
