#pragma once
/// Predicates that the tests of the explorer share.

#include <array>
#include <string>

#include "codegen/explore/candidate.h"
#include "tests/unit/codegen/test_program.h"

namespace tightrope::codegen::explore::testing_support {

using tightrope::testing_support::ScratchFolder;

/// Every choice matters for this one: a product of polynomials, P at t, long sums, a common factor, two stages that
/// share values.
inline constexpr const char* everything =
    "predicate everything(moving point p, a, b, c, scalar s, x[4]) {\n"
    "  stage first {\n"
    "    let n = cross(b - a, c - a)\n"
    "    let Y = dot(n, p - a)\n"
    "    sign Y, Y at s as there\n"
    "  }\n"
    "  stage second {\n"
    "    sign dot(n, n) as square, x[0] * s + x[1] * s + x[2] * x[3] + x[1] * x[2] + x[0] as sum\n"
    "  }\n"
    "}\n";

inline constexpr const char* orientation = "predicate orientation(point2 a, b, c) { sign det(b - a, c - a) as side }\n";

inline constexpr const char* ranged =
    "predicate ranged(scalar x[3], scalar y) {\n"
    "  range |x, y| <= 4\n"
    "  sign x[0] * y + x[1] * y + x[2] as s\n"
    "}\n";

/// Short sums of products that cancel near zero: rounding errors are then nearly all that is left, and a bound that
/// leaves them out does not hold.
inline constexpr const char* cancelling =
    "predicate cancelling(moving point2 p, q, scalar s, x[5]) {\n"
    "  let d = dot(p, q)\n"
    "  sign d, d at s as there, x[0] * s - x[1] * s + x[2] * s as common,\n"
    "    x[0] * x[1] + x[2] * x[3] + x[4] * s + x[2] * x[4] as sum\n"
    "}\n";

inline Lowerings lowerings(const std::string& text) {
  const ScratchFolder folder;
  dsl::SourceMap sources;
  dsl::Diagnostics diagnostics;
  Lowerings result;
  std::uint64_t hash = 0;
  const std::string error =
      load_lowerings(folder.write("test.pred", text).string(), "", sources, diagnostics, result, hash);
  EXPECT_EQ(error, "");
  EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.render(sources);
  return result;
}

}  // namespace tightrope::codegen::explore::testing_support
