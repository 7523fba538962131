#include "codegen/print_cpp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "codegen/hash.h"
#include "codegen/interface.h"
#include "tests/unit/codegen/test_program.h"

namespace tightrope::codegen {
namespace {

std::string header(const dsl::Program& program, BoundMode mode, Precision precision = Precision::binary64) {
  dsl::Diagnostics diagnostics;
  std::vector<BoundedPredicate> bounded;
  for (const dsl::Predicate& p : program.predicates) bounded.push_back(add_bounds(p, mode, precision, diagnostics));
  EXPECT_FALSE(diagnostics.has_errors());
  std::vector<GeneratedPredicate> generated;
  for (std::size_t i = 0; i < bounded.size(); ++i) generated.push_back({&program.predicates[i], &bounded[i]});
  return print_header(generated, {"test.pred", 0x1234, mode, precision});
}

std::string header(const std::string& text, BoundMode mode, Precision precision = Precision::binary64) {
  return header(testing_support::program(text), mode, precision);
}

::testing::AssertionResult contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "no \"" << part << "\" in\n" << text;
}

/// The bodies of tests are tables of {predicate, text that its header in mode `float` must hold}.
struct Spelling {
  const char* source;
  const char* expected;
};

TEST(PrintCpp, SpellsOperations) {
  const Spelling table[] = {
      {"scalar a, b) { sign a + b as y }", "const double v0 = sum(a, b);\n    result.y = {v0, 0x0p+0};"},
      {"scalar a, b) { sign a - b as y }", "const double v0 = difference(a, b);"},
      {"scalar a, b) { sign min(a, b) - max(a, b) as y }", "const double v2 = difference(v0, v1);"},
      {"scalar a, b) { sign a * b - abs(a) as y }", "const double v2 = difference(v0, v1);"},
      {"scalar a, b) { sign a * a - b * b as y }", "const double v2 = v0 - v1;"},
      {"scalar a, b) { sign a * b + a * a as y }", "const double v2 = v0 + v1;"},
      {"scalar a, b) { sign a * b as y }", "const double v0 = product(a, b);"},
      {"scalar a) { sign 8 * a as y }", "const double v0 = product(a, 0x1p+3);"},
      {"scalar a) { sign abs(a) as y }", "const double v0 = magnitude(a);"},
      {"scalar a, b) { sign min(a, b) as y }", "const double v0 = minimum(a, b);"},
      {"scalar a, b) { sign max(a, b) as y }", "const double v0 = maximum(a, b);"},
      {"scalar a) { sign a / 3 as y }", "const double v0 = a / 0x1.8p+1;"},
      {"vec3 a, b) { sign dot(a, b) as y }", "const double v0 = product(a[0], b[0]);"},
      {"moving scalar a) { sign a as y }", "result.y[1] = {a_t1, 0x0p+0};"},
      {"bounded scalar a[2]) { sign a[1] as y }", "result.y = {a[1].value, 0x0p+0};"},
      {"moving point a[2]) { sign a[1] as y }", "result.y[1][2] = {a_t1[5], 0x0p+0};"},
  };
  for (const Spelling& row : table) {
    EXPECT_TRUE(contains(header(std::string("predicate f(") + row.source, BoundMode::none), row.expected));
  }
}

TEST(PrintCpp, ScalingBeyondTheExponentRangeTakesTwoFactors) {
  const auto text = [](int exponent, Precision precision) {
    dsl::Predicate p;
    p.name = "f";
    p.parameters.push_back({"a", false, false, false, 1, {}, {}, 0});
    p.slots.push_back({0, 0, 0, 0});
    dsl::Output output;
    output.name = "y";
    BoundedPredicate bounded;
    output.nodes = {bounded.graph.mul_pow2(bounded.graph.input(0), exponent)};
    bounded.stages = {{{OutputBound{{{output.nodes[0], dsl::no_node}}, 0, "", ""}}}};
    p.stages = {{"evaluate", {output}}};
    const GeneratedPredicate generated = {&p, &bounded};
    return print_header({&generated, 1}, {"test.pred", 0, BoundMode::none, precision});
  };
  EXPECT_TRUE(contains(text(1023, Precision::binary64), "v0 = product(a, 0x1p+1023);"));
  EXPECT_TRUE(contains(text(1500, Precision::binary64), "v0 = product(product(a, 0x1p+1023), 0x1p+477);"));
  EXPECT_TRUE(contains(text(-1074, Precision::binary64), "v0 = product(a, 0x0.0000000000001p-1022);"));
  EXPECT_TRUE(contains(text(-1100, Precision::binary64), "v0 = product(product(a, 0x1p-1022), 0x1p-78);"));
  EXPECT_TRUE(contains(text(-150, Precision::binary32), "v0 = product(product(a, 0x1p-126f), 0x1p-24f);"));
}

TEST(PrintCpp, InterfaceIsThatOfTheDocumentation) {
  const std::string text = header(
      "// Vertex and face.\n"
      "predicate f(moving point p, point a, bounded scalar k) {\n"
      "  range |k| <= 4\n"
      "  stage first { let n = cross(p, a) sign n as n }\n"
      "  stage second { sign dot(n, a) * k as d }\n"
      "}\n",
      BoundMode::tight);
  EXPECT_TRUE(contains(text, "// Vertex and face.\ntemplate <class Bound, class Real>\nstruct f;\n"));
  EXPECT_TRUE(contains(text, "template <>\nstruct f<bound::tight, double> {\n  using real = double;\n"));
  EXPECT_TRUE(contains(text, "  struct first_result {\n    // sign n\n    Bounded<double> n[2][3];\n  };\n"));
  EXPECT_TRUE(contains(text, "  struct State {\n"));
  EXPECT_TRUE(contains(text, "static bool in_range("));
  EXPECT_TRUE(contains(text, "return magnitude(k.value) <= 0x1p+2 && k.bound <= 0x1p+2;"));
  EXPECT_TRUE(contains(text, "static first_result first(const double* p_t0, const double* p_t1, const double* a,"));
  EXPECT_TRUE(contains(text, "static first_result first_in_range("));
  EXPECT_TRUE(contains(text, "Bounded<double> k, State& state) noexcept {"));
  EXPECT_TRUE(contains(text, "const State& state) noexcept {"));
  EXPECT_TRUE(contains(text, "make_uncertain(result.d);"));
}

TEST(PrintCpp, SafeHeaderSaysDegreesRoundingsAndMagnitudes) {
  const std::string text = header("predicate f(moving scalar a, scalar b) { sign a * b as y }", BoundMode::safe);
  EXPECT_TRUE(contains(text, "y[2]: degree 1 in t, k = "));
  EXPECT_TRUE(contains(text, "operations for values 2 (2 products)"));
  EXPECT_TRUE(contains(text, "Bound mode safe, scalar type double. Assumes rounding to nearest and gradual underflow"));
  EXPECT_TRUE(contains(text, "from test.pred (FNV-1a 0000000000001234)"));
}

TEST(PrintCpp, SinglePrecisionLiteralsHaveTheSuffix) {
  const std::string text =
      header("predicate f(scalar a) { range |a| <= 1/3 sign 3 * a as y }", BoundMode::tight, Precision::binary32);
  EXPECT_TRUE(contains(text, "product(a, 0x1.8p+1f)"));
  EXPECT_EQ(text.find("double"), std::string::npos) << text;
  // The largest float below 1/3 (rounded to double): rounding it up would let a number pass that breaks the range.
  EXPECT_TRUE(contains(text, "magnitude(a) <= 0x1.555554p-2f"));
}

TEST(PrintCpp, ArgumentsAvoidTheNamesOfGeneratedCode) {
  const std::string text = header(
      "predicate f(scalar v0, scalar product, moving scalar x) { sign v0 * product * x as y }", BoundMode::tight);
  EXPECT_TRUE(contains(text, "evaluate(double v0_, double product_, double x_t0, double x_t1)"));
}

TEST(PrintCpp, LinesEndBeforeColumn120) {
  std::string source = "predicate f(moving point";
  for (int i = 0; i < 12; ++i) source += (i == 0 ? " " : ", ") + std::string("parameter_number_") + std::to_string(i);
  source += ", bounded scalar k) { range |parameter_number_3| <= 8 sign k * (0";
  for (int i = 0; i < 12; ++i) source += " + dot(parameter_number_" + std::to_string(i) + ", parameter_number_3)";
  source += ") as y }";
  for (const BoundMode mode : {BoundMode::none, BoundMode::safe, BoundMode::tight}) {
    std::istringstream lines(header(source, mode));
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120U) << line;
  }
}

TEST(PrintCpp, CommentsCannotEscape) {
  EXPECT_EQ(comment_text("a \\"), "a \\ .");
  EXPECT_EQ(comment_text("a\nb\tc  "), "a b c");
  EXPECT_EQ(comment_text("a\xe2\x80\xae b"), "a b");
  EXPECT_EQ(comment_text("\xc3\xa9"), "\xc3\xa9");
  EXPECT_EQ(comment_lines("  ", ""), "  //\n");
  EXPECT_EQ(comment_lines("", " a b"), "// a b\n");
}

TEST(PrintCpp, LiteralsReadBackExactly) {
  for (const double x : {0.0, 1.0, -3.0, 0.1, 0x1.00001p-53, 4.9e-324, 1.7976931348623157e308}) {
    EXPECT_EQ(std::strtod(literal(x, Precision::binary64).c_str(), nullptr), x);
  }
  EXPECT_EQ(literal(INFINITY, Precision::binary32), "__builtin_inff()");
}

TEST(PrintCpp, SameTextEveryTime) {
  const dsl::Program program = testing_support::program(
      "predicate f(moving point p, a, b, c) {\n"
      "  stage s { sign dot(cross(b - a, c - a), p - a) as y }\n"
      "  stage t { sign cross(b - a, c - a) as n }\n"
      "}");
  const std::string first = header(program, BoundMode::tight);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(header(program, BoundMode::tight), first);
}

TEST(Hash, IsPublishedFnv1a) {
  const auto hash = [](std::string_view text) {
    Fnv1a h;
    h.add(text);
    return h.value();
  };
  EXPECT_EQ(hash(""), 0xcbf29ce484222325U);  // test vectors of the authors' page
  EXPECT_EQ(hash("a"), 0xaf63dc4c8601ec8cU);
  EXPECT_EQ(hash("foobar"), 0x85944171f73967e8U);
}

TEST(Hash, KnowsWhereOneFileEnds) {
  Fnv1a ab_c;
  ab_c.add_text("ab"), ab_c.add_text("c");
  Fnv1a a_bc;
  a_bc.add_text("a"), a_bc.add_text("bc");
  EXPECT_NE(ab_c.value(), a_bc.value());
}

}  // namespace
}  // namespace tightrope::codegen
