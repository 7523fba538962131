/// Gappa scripts: what they say, what Gappa says about them, and that it does not prove a bound that is too small.

#include "codegen/certify.h"

#include <gtest/gtest.h>

#include <cmath>

#include "codegen/gappa.h"
#include "tests/unit/codegen/test_program.h"

namespace tightrope::codegen {
namespace {

using testing_support::ScratchFolder;
using Verdict = Certificate::Verdict;

constexpr const char* orient2d =
    "predicate orient2d(point2 a, b, c) { range |a, b, c| <= 1 sign det(a - c, b - c) as side }\n";
constexpr double u = 0x1p-53;

std::vector<Certificate> certificates(const ScratchFolder& folder, const std::string& text, CertifyRequest request) {
  const dsl::Program program = testing_support::program(text);
  dsl::Diagnostics diagnostics;
  request.directory = folder.path();
  std::vector<Certificate> result;
  EXPECT_EQ(certify(program, request, diagnostics, result), "");
  EXPECT_FALSE(diagnostics.has_errors());
  return result;
}

TEST(Certificate, ScriptDefinesEveryValueTwice) {
  const ScratchFolder folder;
  certificates(folder, "predicate p(scalar a, bounded scalar b) { range |a, b| <= 2 sign abs(a * b) / 8 - a as s }",
               {});
  EXPECT_EQ(testing_support::read_text(folder.path() / "p.evaluate.s.static.double.g"),
            "# p.evaluate.s, mode static, double: |computed - exact| <= 4.5036e+15 u, u = 2^-53\n"
            "# by tightrope 0.1.0\n"
            "@rnd = float<ieee_64, ne>;\n"
            "v0 = rnd(x0);  # a\n"
            "e0 = v0;\n"
            "v1 = rnd(x1);  # b.value\n"
            "e1 = y1;\n"
            "v2 = rnd(v0 * v1);\n"
            "e2 = e0 * e1;\n"
            "e3 = |e2|;\n"
            "v3 = e3 + s3 * (v2 - e2);\n"
            "v4 = v3 * 1b-3 + d4;\n"
            "e4 = e3 * 1b-3;\n"
            "v5 = rnd(v4 - v0);\n"
            "e5 = e4 - e0;\n"
            "{ |v0| <= 0x1p+1 /\\\n"
            "  |v1| <= 0x1p+1 /\\\n"
            "  |v1 - e1| <= 0x1p+1 /\\\n"
            "  |s3| <= 1 /\\\n"
            "  |d4| <= 1b-1075\n"
            "  ->\n"
            "  |v5 - e5| <= 0x1.0000000000004p-1 /\\ v5 - e5 in ? }\n"
            "v3 - e3 -> s3 * (v2 - e2);\n"
            "v4 - e4 -> (v3 - e3) * 1b-3 + d4;\n");
}

TEST(Certificate, AnOperationThatGappaDoesNotKnowHasNone) {
  const ScratchFolder folder;
  const auto all = certificates(folder, "predicate p(scalar a, b) { range |a, b| <= 2 sign max(a, b) as s }", {});
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].verdict, Verdict::no_script);
  EXPECT_FALSE(unproved(all));
}

TEST(Gappa, AnswersAreRead) {
  const auto answer = [](const std::string& result, int status = 0) {
    return read_gappa_answer("Warning: x\nResults:\n  v6 - e6 in " + result + "\n", status);
  };
  EXPECT_EQ(answer("[-3b-47 {-2.1e-14, -2^(-45.4)}, 1b-49 {1.8e-15, 2^(-49)}]").found, 0x3p-47);
  EXPECT_EQ(answer("[0, 0]").found, 0);
  EXPECT_EQ(answer("[-5, 7b2 {28, 2^(4.8)}]").found, 28);
  EXPECT_GT(answer("[0, 729583139634021013b-53 {81, 2^(6.3)}]").found, 81);
  EXPECT_EQ(answer("[nonsense]").found, std::nullopt);
  EXPECT_EQ(answer("[0, 1]").status, GappaAnswer::Status::proved);
  EXPECT_EQ(answer("[0, 1]\nError: some properties were not satisfied:\n  BND(|v|), best: [0, 1]", 1).status,
            GappaAnswer::Status::not_proved);
  EXPECT_EQ(read_gappa_answer("Error: syntax error", 1).status, GappaAnswer::Status::failed);
}

/// Skips the test where there is no Gappa.
#define NEEDS_GAPPA(request)             \
  CertifyRequest request;                \
  request.gappa = find_program("gappa"); \
  if (request.gappa.empty()) GTEST_SKIP() << "gappa is not installed"

TEST(Gappa, ProvesStaticAndSafeBounds) {
  const ScratchFolder folder;
  NEEDS_GAPPA(request);
  request.precisions = {Precision::binary64, Precision::binary32};
  const auto all = certificates(folder, orient2d, request);
  ASSERT_EQ(all.size(), 4U);
  for (const Certificate& c : all) EXPECT_EQ(c.verdict, Verdict::proved) << c.output;
  EXPECT_EQ(all[0].bound, 16 * u);
  EXPECT_EQ(all[0].gappa_bound, 16 * u);
  EXPECT_NEAR(all[2].bound, 32 * u, 1e-4 * u);
  EXPECT_EQ(all[2].gappa_bound, 16 * u);
  EXPECT_FALSE(unproved(all));
  EXPECT_NE(text(all).find("proved, and much less"), std::string::npos);
}

TEST(Gappa, DoesNotProveTamperedBounds) {
  const ScratchFolder folder;
  NEEDS_GAPPA(request);
  request.scale = 0.49;  // SafeBound's is twice of what Gappa can prove
  for (const Certificate& c : certificates(folder, orient2d, request)) EXPECT_EQ(c.verdict, Verdict::not_proved);
  request.scale = 1;
  request.modes = {BoundMode::fixed};
  for (const Weakening weakening :
       {Weakening::drop_rounding_of_sums, Weakening::drop_rounding_of_products, Weakening::drop_rounding_of_differences,
        Weakening::halve_unit_roundoff, Weakening::drop_first_factor_error, Weakening::drop_second_factor_error}) {
    request.weakening = weakening;
    const auto all = certificates(folder, orient2d, request);
    EXPECT_EQ(all[0].verdict, Verdict::not_proved) << name(weakening);
    EXPECT_TRUE(unproved(all));
  }
}

TEST(Gappa, StopsInTime) {
  const ScratchFolder folder;
  NEEDS_GAPPA(request);
  request.time_limit = 1e-4;
  request.modes = {BoundMode::fixed};
  EXPECT_EQ(certificates(folder, orient2d, request)[0].verdict, Verdict::timed_out);
}

}  // namespace
}  // namespace tightrope::codegen
