/// Translation validation: generated headers pass, and whatever is changed in them is noticed.

#include "codegen/clang/validate.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <regex>

#include "codegen/clang/format.h"
#include "codegen/compile.h"
#include "codegen/print_cpp.h"
#include "tests/unit/codegen/test_program.h"

namespace tightrope::codegen {
namespace {

/// A file's predicates with the bounds of one mode, as they were analysed, and the header that was printed of them.
class Generated {
 public:
  Generated(const std::string& source, BoundMode mode, Precision precision = Precision::binary64,
            Form form = Form::scalar)
      : program_(testing_support::program(source)), mode_(mode), precision_(precision), form_(form) {
    dsl::Diagnostics diagnostics;
    for (const dsl::Predicate& p : program_.predicates) {
      bounded_.push_back(add_bounds(p, mode, precision, diagnostics));
    }
    EXPECT_FALSE(diagnostics.has_errors());
    std::vector<GeneratedPredicate> generated;
    for (std::size_t i = 0; i < bounded_.size(); ++i) generated.push_back({&program_.predicates[i], &bounded_[i]});
    text_ = formatted(print_header(generated, {"test.pred", 0x1234, mode, precision, false, {}, form}), "test.h");
  }

  const std::string& text() const { return text_; }

  /// What validation says of `text` in place of the header that was printed.
  std::string verdict(const std::string& text) const {
    std::vector<AnalysedPredicate> analysed;
    for (std::size_t i = 0; i < bounded_.size(); ++i) analysed.push_back({&program_.predicates[i], &bounded_[i]});
    return validate(text, "test.h", analysed, mode_, precision_, form_);
  }

 private:
  dsl::Program program_;
  BoundMode mode_;
  Precision precision_;
  Form form_;
  std::vector<BoundedPredicate> bounded_;
  std::string text_;
};

/// `text` with the first place where `pattern` matches replaced.
std::string changed(const std::string& text, const std::string& pattern, const std::string& replacement) {
  const std::string result =
      std::regex_replace(text, std::regex(pattern), replacement, std::regex_constants::format_first_only);
  EXPECT_NE(result, text) << "nothing matches " << pattern;
  return result;
}

const char* const two_stages = R"(
predicate f(moving point p, point a, bounded scalar k, scalar s, r) {
  range |p, k| <= 0.3
  stage one {
    let d = p - a
    sign dot(d, d) as Y, min(k, s) as least, max(s, r) - 3 * s as most
  }
  stage two { sign dot(d, d) * k as Z, (abs(s) / 3 - r) * k as q, 1/1024 * s - r as x }
}
)";

struct Change {
  const char* what;
  const char* pattern;
  const char* replacement;
  const char* message;
};

TEST(Validate, CatchesEveryKindOfChange) {
  const Generated generated(two_stages, BoundMode::none);
  ASSERT_EQ(generated.verdict(generated.text()), "");
  const Change table[] = {
      {"operands swapped in a subtraction", R"(= difference\(p_t0\[0\], a\[0\]\);)", "= difference(a[0], p_t0[0]);",
       "no operation of the an"},
      {"a term dropped", R"((const double v\d+ = v\d+) \+ v\d+;)", "$1;", "never|no operation|the value in"},
      {"a literal changed in its last bit", "0x1.8p\\+1", "0x1.8000000000001p+1", "no operation of the analysed graph"},
      {"a literal that no double holds", "0x1.8p\\+1", "0x1.80000000000001p+1", "does not hold exactly"},
      {"a float literal where a double is due", "/ 0x1.8p\\+1", "/ 0x1.8p+1f", "a number of type float converted"},
      {"an int literal where a double is due", "/ 0x1.8p\\+1", "/ 3", "a number of type int converted"},
      {"a contraction barrier removed", R"(product\((\w+), (\w+)\))", "$1 * $2", "a bare product"},
      {"another function", "minimum\\(", "maximum(", "no operation of the analysed graph"},
      {"a function of no meaning here", R"(magnitude\()", "-__builtin_ceil(", "something else than the runtime's"},
      {"the function of another namespace", R"(minimum\()", "::minimum(", "not accepted by the compiler"},
      {"a wrong element of an output", R"(result\.Y\[1\] =)", "result.Y[2] =", "the value in|set twice"},
      {"an element beyond the end", R"(result\.Y\[1\] =)", "result.Y[3] =", "does not have"},
      {"an output not set", R"(result\.Y\[1\] = [^;]*;)", "", "element 1 of output Y is never set"},
      {"an output set twice", R"((result\.Y\[1\] = [^;]*;))", "$1 $1", "set twice"},
      {"another output", R"(result\.least =)", "result.most =", "the value in"},
      {"an added statement", R"(return result;\n  \})", "result.Y[0].value += 1;\n return result;\n }",
       "no part of the an"},
      {"an added loop", R"(return result;\n  \})", "for (;;) {}\n return result;\n }", "no part of the analysed graph"},
      {"an added branch", R"(return result;\n  \})", "if (s > 0) return {};\n return result;\n }", "no part of"},
      {"a volatile local", R"(const double v3)", "const volatile double v3", "is of type"},
      {"a wider local", R"(const double v3)", "const long double v3", "is of type"},
      {"a narrower local", R"(const double v3)", "const float v3", "is of type"},
      {"a static local", R"(const double v3)", "static const double v3", "no part of the analysed graph"},
      {"a local that is a reference", R"(const double v3)", "const double& v3", "is of type"},
      {"another input", R"(p_t0\[0\], a)", "p_t1[0], a", "no operation of the analysed graph"},
      {"another component", R"(p_t0\[0\], a)", "p_t0[1], a", "no operation of the analysed graph"},
      {"a component beyond the end", R"(p_t0\[0\], a)", "p_t0[3], a", "beyond the end"},
      {"a bound in place of a value", R"(minimum\(k\.value)", "minimum(k.bound", "no operation of the analysed graph"},
      {"State set twice", R"((state\.v\d+ = \w+;))", "$1 $1", "sets a member of State twice"},
      {"State read before it is set", R"(state\.v\d+ = \w+;)", "", "read before it is set"},
      {"a member of State of another type", R"(struct State \{\n +double)", "struct State { float", "of another type"},
      {"another limit", R"(<= 0x1.3333333333333p-2)", "<= 0x1.3333333333334p-2", "another range than the declared"},
      {"a strict limit", R"(<= 0x1.3333333333333p-2)", "< 0x1.3333333333333p-2", "is no test of a range"},
      {"an input not tested", R"(magnitude\(p_t1\[2\]\) <= \S+ &&)", "", "in_range does not test abs\\(input 5\\)"},
      {"a bound not tested", R"(&&\s+k\.bound <= [^;]*;)", ";", "in_range does not test input"},
      {"the range not consulted", R"(!in_range\()", "in_range(", "is not the test of the range"},
      {"the range of other arguments", R"(in_range\(p_t0, p_t1, a)", "in_range(p_t1, p_t0, a", "is not the test"},
      {"arguments swapped on the way", R"(one_in_range\(p_t0, p_t1, a, k)", "one_in_range(p_t1, p_t0, a, k",
       "does not pass"},
      {"an output left as it is", R"(make_uncertain\(result\.Y\);)", "", "should become uncertain"},
      {"State left as it is", R"(state = State\{\};)", "", "State is not emptied"},
      {"another stage", R"(return two_in_range\()", "return two(", "does not pass on"},
      {"an added function", R"(using real = double;)", "using real = double; static int g() { return 0; }",
       "predicates do"},
      {"an added member", R"(using real = double;)", "using real = double; int member;", "predicates do not have"},
      {"an added declaration", R"(namespace tightrope::generated \{)", "namespace tightrope::generated { inline int g;",
       "no ana"},
      {"a function that hides the runtime's", R"(using real = double;)",
       "using real = double; static double product(double a, double b) { return a * b; }",
       "something else|predicates do not"},
      {"another type under the name real", R"(using real = double;)", "using real = float;", "another type"},
      {"another mode", R"(bound::none)", "bound::tight", "another bound mode"},
      {"another name", R"(struct f;)", "struct g;", "no analysed predicate|not accepted"},
      {"a macro", R"(#pragma once)", "#define v4 v5", "a preprocessor line"},
      {"a conditional", R"(#pragma once)", "#ifdef __clang__\n#endif", "a preprocessor line"},
      {"another header", R"(#pragma once)", "#include <cmath>", "a preprocessor line"},
      {"no precise arithmetic", "TIGHTROPE_PRECISE_BEGIN", "", "an operation that may be changed"},
      {"no C++", R"(return result;)", "return", "not accepted by the compiler:\ntest.h:"},
  };
  for (const Change& change : table) {
    const std::string verdict = generated.verdict(changed(generated.text(), change.pattern, change.replacement));
    EXPECT_TRUE(std::regex_search(verdict, std::regex(change.message))) << change.what << ": \"" << verdict << '"';
  }
}

TEST(Validate, CatchesAnotherAssociation) {
  const Generated generated("predicate f(scalar a, b, c, d) { sign a * b + c + d as y }", BoundMode::none);
  ASSERT_EQ(generated.verdict(generated.text()), "");
  const std::string other = changed(generated.text(), R"(const double v1 = .*\n.*const double v2 = .*)",
                                    "const double v1 = c + d;\n const double v2 = v0 + v1;");
  EXPECT_NE(generated.verdict(other).find("`v1 = c + d` is no operation of the analysed graph"), std::string::npos)
      << generated.verdict(other);
}

TEST(Validate, CatchesTwoMembersOfStateSwapped) {
  const Generated generated(
      "predicate f(scalar a, b) { let x = a + b let y = a - b stage one { sign x * y as p }"
      " stage two { sign x as x, y as y } }",
      BoundMode::none);
  ASSERT_EQ(generated.verdict(generated.text()), "");
  const std::string& text = generated.text();
  const std::string once = changed(text, R"(const double (v\d) = state\.v0)", "const double $1 = state.v1");
  EXPECT_NE(generated.verdict(once).find("the value in `result."), std::string::npos) << generated.verdict(once);
}

TEST(Validate, NamesTheLine) {
  const Generated generated("predicate f(scalar a, b) { sign a - b as y }", BoundMode::none);
  const std::string tampered = changed(generated.text(), R"(difference\(a, b\);)", "difference(b, a);");
  const auto place = tampered.find("difference(b, a);");
  const auto line = 1 + std::count(tampered.begin(), tampered.begin() + static_cast<std::ptrdiff_t>(place), '\n');
  EXPECT_EQ(generated.verdict(tampered),
            "test.h:" + std::to_string(line) +
                ": `v0 = difference(b, a)` is no operation of the analysed graph: sub(input 1, input 0)");
}

/// The proof is about arithmetic, not about text: other names, another order of independent lines, parentheses.
TEST(Validate, PassesOtherSpellingsOfTheSameArithmetic) {
  const Generated generated("predicate f(scalar a, b) { sign (a - b) * (a + b) as y }", BoundMode::none);
  const std::string& text = generated.text();
  EXPECT_EQ(generated.verdict(std::regex_replace(text, std::regex(R"(\bv1\b)"), "difference")), "");
  EXPECT_EQ(generated.verdict(changed(text, R"(( +const double v0.*\n)( +const double v1.*\n))", "$2$1")), "");
  EXPECT_EQ(generated.verdict(changed(text, R"(a - b)", "((a) - b)")), "");
  EXPECT_EQ(generated.verdict(changed(text, R"(a \+ b)", "b + a")), "");
}

TEST(Validate, FollowsScalingsInSeveralSteps) {
  const auto scaled = [](const std::string& factor, Precision precision) {
    const Generated generated("predicate f(scalar a) { sign " + factor + " * a as y }", BoundMode::none, precision);
    EXPECT_EQ(generated.verdict(generated.text()), "") << generated.text();
    return generated;
  };
  scaled("2^1023", Precision::binary64);
  scaled("2^-1074", Precision::binary64);
  const Generated up = scaled("2^1030", Precision::binary64);
  EXPECT_NE(up.verdict(changed(up.text(), "0x1p\\+7", "0x1p+8")), "");
  const Generated down = scaled("2^-1075", Precision::binary64);
  EXPECT_NE(down.verdict(changed(down.text(), "0x1p-53", "0x1p-54")), "");
  EXPECT_NE(scaled("2^-150", Precision::binary32).text().find("0x1p-24f"), std::string::npos);
  // Two steps that round twice: not the same number.
  EXPECT_NE(down.verdict(changed(down.text(), "0x1p-1022, *0x1p-53|0x1p-1022\\), 0x1p-53", "0x1p-1074), 0x1p-1")), "");
}

/// Every line of a header changed in every way that may matter: no mutant survives.
int mutants(const Generated& generated) {
  const std::vector<std::pair<std::regex, std::string>> mutations = {
      {std::regex(R"(= ([^;{]*) - ([^;]*);)"), "= $2 - $1;"},
      {std::regex(R"(= ([^;{]*) - ([^;]*);)"), "= $1 + $2;"},
      {std::regex(R"(= ([^;{]*) \+ ([^;]*);)"), "= $1 - $2;"},
      {std::regex(R"(= ([^;{]*) \+ ([^;]*);)"), "= $1;"},
      {std::regex(R"(= ([^;{]*) / ([^;]*);)"), "= $2 / $1;"},
      {std::regex(R"(product\((.*), (.*)\))"), "$1 * $2"},
      {std::regex(R"(product\()"), "maximum("},
      {std::regex(R"(magnitude\()"), "-("},
      {std::regex(R"(minimum\()"), "maximum("},
      {std::regex(R"(maximum\()"), "minimum("},
      {std::regex(R"(max_magnitude\()"), "maximum("},
      {std::regex(R"(0x1([.p]))"), "0x2$1"},
      {std::regex(R"(p([-+])(\d+))"), "p${1}1$2"},
      {std::regex(R"((= \{.*), (.*)\};)"), "$1, 1};"},
      {std::regex(R"(= \{(.*), (.*)\};)"), "= {$2, $1};"},
      {std::regex(R"(\[0\])"), "[1]"},
      {std::regex(R"(const (double|float) (v\d+) = (.*);)"), "const $1 $2 = -($3);"},
      {std::regex(R"(.*(state\.|result\.).* = .*)"), ""},
  };
  int count = 0;
  const std::string& text = generated.text();
  const std::size_t start = text.find("#pragma once");
  for (std::size_t begin = start; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    const std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    if (line.find("//") != std::string::npos) continue;
    for (const auto& [pattern, replacement] : mutations) {
      std::string mutant = std::regex_replace(line, pattern, replacement, std::regex_constants::format_first_only);
      if (mutant == line) continue;
      mutant = text.substr(0, end - line.size()) + mutant + text.substr(end);
      ++count;
      EXPECT_NE(generated.verdict(mutant), "") << "survives: " << line << " -> " << replacement;
    }
  }
  return count;
}

TEST(Validate, NoMutantSurvives) {
  const std::string source = R"(
predicate f(moving scalar p, scalar a, bounded scalar k) {
  range |a| <= 4
  stage one { sign p * p - a as Y, min(k, a) as least }
  stage two { sign p * k - a / 3 as Z, max(p at 0, a) as most }
})";
  for (const BoundMode mode : {BoundMode::none, BoundMode::safe, BoundMode::tight}) {
    EXPECT_GT(mutants(Generated(source, mode, mode == BoundMode::safe ? Precision::binary32 : Precision::binary64)),
              40);
  }
}

/// `compile` throws where validation fails. (A mode that has no rule for an operation says so, and that is all right
/// here.)
TEST(Validate, PassesEveryPredicateOfTheRepository) {
  namespace fs = std::filesystem;
  int headers = 0;
  const auto compile_file = [&](const fs::path& file, BoundMode mode, Precision precision) {
    CompileRequest request;
    request.file = file.string();
    request.modes = {mode};
    request.precisions = {precision};
    dsl::SourceMap sources;
    dsl::Diagnostics diagnostics;
    EXPECT_NO_THROW(headers += compile(request, sources, diagnostics).has_value() ? 1 : 0) << file;
  };
  for (const char* const folder : {"ccd/predicates", "tests/generated", "examples"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(TIGHTROPE_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".pred") continue;
      for (const BoundMode mode :
           {BoundMode::none, BoundMode::safe, BoundMode::tight, BoundMode::fixed, BoundMode::interval}) {
        compile_file(entry.path(), mode, Precision::binary64);
        compile_file(entry.path(), mode, Precision::binary32);
      }
    }
  }
  EXPECT_GE(headers, 40);
}

TEST(Validate, CatchesChangesInCodeForLanes) {
  for (const Precision precision : {Precision::binary64, Precision::binary32}) {
    for (const BoundMode mode : {BoundMode::none, BoundMode::safe, BoundMode::tight, BoundMode::interval}) {
      const Generated generated(two_stages, mode, precision, Form::lanes);
      EXPECT_EQ(generated.verdict(generated.text()), "");
    }
  }
  const Generated generated(two_stages, BoundMode::tight, Precision::binary64, Form::lanes);
  const Change table[] = {
      {"operands swapped", R"(= p_t0\[0\] - a\[0\];)", "= a[0] - p_t0[0];", "no operation of the an"},
      {"a contraction barrier removed", R"(product\((\w+), (\w+)\))", "$1 * $2", "a bare product"},
      {"a literal changed", "0x1.8p\\+1", "0x1.8000000000001p+1", "no operation of the analysed graph"},
      {"lanes of another type", R"(const Lanes<double> v3)", "const Lanes<float> v3", "is of type"},
      {"an output left out", R"(result\.Y\[1\] = [^;]*;)", "", "element 1 of output Y is never set"},
      {"a function that lanes do not have", R"(using real = Lanes<double>;)",
       "using real = Lanes<double>; static bool in_range() { return true; }", "predicates do not have"},
      {"another namespace", R"(namespace tightrope::TIGHTROPE_LANES \{)", "namespace tightrope::others {",
       "not accepted|outside namespace"},
  };
  for (const Change& change : table) {
    const std::string verdict = generated.verdict(changed(generated.text(), change.pattern, change.replacement));
    EXPECT_TRUE(std::regex_search(verdict, std::regex(change.message))) << change.what << ": " << verdict;
  }
}

}  // namespace
}  // namespace tightrope::codegen
