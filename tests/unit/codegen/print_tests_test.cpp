#include "codegen/print_tests.h"

#include <gtest/gtest.h>

#include "codegen/print_reference.h"
#include "tests/unit/codegen/test_program.h"

namespace tightrope::codegen {
namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TestOptions options(std::vector<BoundMode> modes, std::vector<Precision> precisions, bool same_products = true) {
  return {"file", "file.pred", 1, std::move(modes), std::move(precisions), same_products};
}

const char* const source =
    "predicate f(moving point2 p, a, bounded scalar k) {\n"
    "  range |k| <= 2\n"
    "  property antisymmetric(p, a)\n"
    "  property scale(-1) of y\n"
    "  stage one { sign det(p, a) as d }\n"
    "  stage two { sign k as y }\n"
    "}\n";

TEST(PrintTests, IncludeEveryHeaderAndTestEveryFamilyInEveryScalarType) {
  const std::string text =
      print_tests(testing_support::program(source),
                  options({BoundMode::safe, BoundMode::tight}, {Precision::binary64, Precision::binary32}));
  for (const char* part : {"#include \"file.safe.double.h\"",
                           "#include \"file.safe.float.h\"",
                           "#include \"file.tight.double.h\"",
                           "#include \"file.tight.float.h\"",
                           "Family::uniform",
                           "Family::lattice",
                           "Family::zero_set",
                           "Family::dependent",
                           "Family::scales",
                           "Family::far_away",
                           "Family::mixed",
                           "Family::underflow",
                           "Family::extreme",
                           "Family::not_finite",
                           "check_worst_errors<float>",
                           "check_usefulness<double>",
                           "check_ranges<double>",
                           "keeps_antisymmetric_p_a)",
                           "keeps_scale_m1)",
                           "f_evaluate<bound::safe, double>"}) {
    EXPECT_TRUE(has(text, part)) << part << " is not in\n" << text;
  }
}

TEST(PrintTests, WithoutBoundsOnlyValuesAreTested) {
  const std::string text =
      print_tests(testing_support::program(source), options({BoundMode::none}, {Precision::binary64}));
  EXPECT_TRUE(has(text, "\"float double\", false, 0"));
  EXPECT_FALSE(has(text, "check_worst_errors"));
  EXPECT_FALSE(has(text, "check_property"));
}

TEST(PrintTests, ReferenceIsTheGraphWithoutNodesThatNoOutputNeeds) {
  const dsl::Program program =
      testing_support::program("predicate f(vec2 a, b) { let unused = a.x * a.x * a.x sign det(a, b) as d }");
  const std::string text = print_reference(program.predicates[0], true, 1'000'000);
  EXPECT_TRUE(has(text,
                  "constexpr Operation f_operations[] = {\n"
                  "    input(0), input(1), input(2), input(3), mul(0, 3), mul(1, 2), sub(4, 5)};\n"
                  "constexpr int f_results[] = {\n    6};\n"))
      << text;
}

TEST(PrintTests, PermutationsMoveWholeParameters) {
  const dsl::Program program = testing_support::program(source);
  const std::string text = print_reference(program.predicates[0], true, 1000);
  EXPECT_TRUE(has(text, "{\"antisymmetric(p, a)\", Property::Kind::permutation, -1, 0, {4, 5, 6, 7, 0, 1, 2, 3, 8}, "))
      << text;
  EXPECT_TRUE(has(text, "{\"scale(-1)\", Property::Kind::scale, 1, -1, {}, {3}}")) << text;
}

TEST(PrintTests, CyclicPutsEveryParameterInThePlaceOfTheOneBefore) {
  const dsl::Program program =
      testing_support::program("predicate f(scalar a, b, c) { property cyclic(a, b, c) sign a * b * c as y }");
  EXPECT_TRUE(has(print_reference(program.predicates[0], true, 1000),
                  "{\"cyclic(a, b, c)\", Property::Kind::permutation, 1, 0, {1, 2, 0}, {0}}"));
}

TEST(PrintTests, OtherProductsAreNotHeldToTheReferencesRoundings) {
  const dsl::Program program = testing_support::program(source);
  EXPECT_TRUE(has(print_reference(program.predicates[0], true, 1000), "f_properties, true,"));
  EXPECT_TRUE(has(print_reference(program.predicates[0], false, 1000), "f_properties, false,"));
}

TEST(PrintTests, ProjectBuildsEveryTestOfItsFolder) {
  const std::string text = print_test_project();
  for (const char* part : {"*.test.cpp", "TIGHTROPE_INCLUDE_DIR", "find_package(GTest REQUIRED)",
                           "find_package(Tightrope REQUIRED)", "enable_testing()"}) {
    EXPECT_TRUE(has(text, part)) << part << " is not in\n" << text;
  }
}

}  // namespace
}  // namespace tightrope::codegen
