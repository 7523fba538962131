/// Programs that are enormous, deep or degenerate: an error or an answer within a second each, never a crash.

#include <gtest/gtest.h>
#include <unistd.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>

#include "dsl/program.h"

namespace tightrope::dsl {
namespace {

#if defined(__SANITIZE_ADDRESS__) || !defined(__OPTIMIZE__)
constexpr double seconds_allowed = 60;  // an instrumented or unoptimised build proves the absence of crashes only
#else
constexpr double seconds_allowed = 1;
#endif

/// A file in the folder for temporary files, as long as it lives.
class ScratchFile {
 public:
  explicit ScratchFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() / ("tightrope_stress_" + std::to_string(::getpid()) + ".pred")) {
    std::ofstream(path_, std::ios::binary) << text;
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

struct Loaded {
  std::string first_message;  ///< empty: the program is sound
  std::size_t errors = 0;
  std::size_t outputs = 0;
  double seconds = 0;  ///< of processor time, rendering of diagnostics included
};

Loaded load_text(const std::string& text) {
  const ScratchFile file(text);
  SourceMap sources;
  Diagnostics diagnostics;
  const std::clock_t begin = std::clock();
  const Program program = load_program(file.path(), sources, diagnostics);
  const std::string rendered = diagnostics.render(sources);
  Loaded loaded;
  loaded.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  loaded.errors = diagnostics.entries().size();
  if (loaded.errors > 0) loaded.first_message = diagnostics.entries().front().message;
  EXPECT_EQ(rendered.empty(), loaded.errors == 0);
  for (const Predicate& predicate : program.predicates) {
    for (const Stage& stage : predicate.stages) loaded.outputs += stage.outputs.size();
  }
  EXPECT_LT(loaded.seconds, seconds_allowed);
  return loaded;
}

std::string repeat(const std::string& text, int count) {
  std::string all;
  all.reserve(text.size() * static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

/// A predicate of the moving scalars a, b and the static scalar s whose one output is `expression`.
Loaded load_expression(const std::string& expression) {
  return load_text("predicate p(moving scalar a, b, static scalar s) {\n  sign " + expression + " as e\n}\n");
}

TEST(Stress, OneMegabyteOfSums) {
  const Loaded loaded = load_expression("a" + repeat("+a", 500'000));
  EXPECT_EQ(loaded.first_message, "");
  EXPECT_EQ(loaded.outputs, 1u);
}

TEST(Stress, OneMegabyteOfProducts) {
  EXPECT_EQ(load_expression("s" + repeat("*s", 500'000)).first_message, "");
  EXPECT_EQ(load_expression("a" + repeat("*a", 500'000)).first_message,
            "this polynomial has degree 65; at most 64 is allowed");
}

TEST(Stress, OneMegabyteOfNumbers) {
  load_expression("s + 1" + repeat("+1", 500'000));
  load_expression("s + 3" + repeat("*3", 500'000));
  load_expression("s + " + repeat("9", 1'000'000));
  load_expression("s + 0." + repeat("0", 1'000'000) + "1");
  load_expression("s + 1e" + repeat("9", 1'000'000));
}

TEST(Stress, OneMegabyteOfStatements) {
  std::string text = "predicate p(moving scalar a, b) {\n";
  for (int i = 0; i < 40'000; ++i) text += "  sign a as output_" + std::to_string(i) + "\n";
  EXPECT_EQ(load_text(text + "}\n").outputs, 40'000u);
}

TEST(Stress, OneMegabyteOfPredicates) {
  std::string text;
  for (int i = 0; i < 20'000; ++i) text += "predicate p" + std::to_string(i) + "(moving scalar a, b) { sign a - b }\n";
  EXPECT_EQ(load_text(text).outputs, 20'000u);
}

TEST(Stress, OneMegabyteOfErrors) {
  EXPECT_GT(load_text("predicate p(scalar a) {\n" + repeat("sign a a\n", 110'000) + "}\n").errors, 100u);
  EXPECT_GT(load_text("predicate p(scalar a) {\n" + repeat("sign unknown\n", 80'000) + "}\n").errors, 100u);
  EXPECT_GT(load_text("predicate p(scalar a) {\n" + repeat("sign a + vec2(a,a)\n", 50'000) + "}\n").errors, 100u);
  EXPECT_GT(load_text("predicate p(scalar a) { sign " + repeat("unknown+", 120'000) + "a }\n").errors, 100u);
}

TEST(Stress, OneMegabyteOfName) {
  const std::string name(1'000'000, 'x');
  load_text("predicate p(scalar " + name + ") { sign " + name + " }\n");
  load_text("predicate p(scalar a) { sign " + name + " }\n");
}

TEST(Stress, OneMegabyteOfOneComment) {
  EXPECT_EQ(load_text("/*" + repeat("* /", 350'000) + "*/ predicate p(scalar a) { sign a }").first_message, "");
  EXPECT_EQ(load_text("//" + repeat(" comment", 130'000) + "\npredicate p(scalar a) { sign a }").first_message, "");
}

TEST(Stress, TenThousandNestings) {
  const std::string message = "this is nested more than 200 levels deep";
  EXPECT_EQ(load_expression(repeat("(", 10'000) + "a" + repeat(")", 10'000)).first_message, message);
  EXPECT_EQ(load_expression(repeat("(", 10'000)).first_message, message);
  EXPECT_EQ(load_expression(repeat("[", 10'000) + "a" + repeat("]", 10'000)).first_message, message);
  EXPECT_EQ(load_expression(repeat("-", 10'000) + "a").first_message, message);
  EXPECT_EQ(load_expression(repeat("diff(", 10'000) + "a" + repeat(")", 10'000)).first_message, message);
  EXPECT_EQ(load_text("predicate p(scalar a) " + repeat("{", 10'000)).errors > 0, true);
  EXPECT_EQ(load_text(repeat("}", 10'000)).errors > 0, true);
}

TEST(Stress, DivisionByTheLiteralZero) {
  EXPECT_EQ(load_expression("a / 0").first_message, "division by zero");
  EXPECT_EQ(load_expression("1 / 0").first_message, "division by zero");
  EXPECT_EQ(load_expression("a at 1/0").first_message, "division by zero");
}

TEST(Stress, PolynomialOfDegree200) {
  EXPECT_NE(load_expression("a ^ 200").first_message, "");
  EXPECT_NE(load_expression("a" + repeat("*b", 199)).first_message, "");
  EXPECT_NE(load_expression("elevate(a, 200)").first_message, "");
  EXPECT_NE(load_expression("elevate(a, 2147483648)").first_message, "");
  EXPECT_NE(load_text("predicate p(scalar c[201]) { sign bernstein(c) as e }").first_message, "");
  EXPECT_EQ(load_expression("(a + b) ^ 64").first_message, "");
}

TEST(Stress, EndlessLoops) {
  const auto loop = [](const std::string& range) {
    return load_text("predicate p(scalar a) { for i in " + range + " { let b = a + i } sign a }").first_message;
  };
  EXPECT_NE(loop("0..1000000000"), "");
  EXPECT_NE(loop("0..10^30"), "");
  EXPECT_NE(loop("-10^18..10^18"), "");
  EXPECT_EQ(loop("0..-10^18"), "");
  EXPECT_NE(load_expression("sum([s for i in 0..1000000000])").first_message, "");
  std::string nested = "s";
  for (int i = 0; i < 20; ++i) nested = "sum([" + nested + " for i in 0..1000])";
  EXPECT_NE(load_expression(nested).first_message, "");
}

TEST(Stress, DoublingFunctions) {
  std::string text = "function f0(x) = x + 1\n";
  for (int i = 1; i < 100; ++i) {
    const std::string below = "f" + std::to_string(i - 1);
    text += "function f" + std::to_string(i) + "(x) = " + below + "(" + below + "(x))\n";
  }
  EXPECT_NE(load_text(text + "predicate p(scalar a) { sign f99(a) }").first_message, "");
}

TEST(Stress, DoublingValues) {
  std::string lets;
  for (int i = 0; i < 64; ++i) lets += "let x = x * x\n";
  load_text("predicate p(scalar x) {\n" + lets + "sign x }");  // a name bound again: an error, not 2^64 nodes
  lets = "let x0 = [s, s]\n";
  for (int i = 1; i < 64; ++i)
    lets += "let x" + std::to_string(i) + " = [x" + std::to_string(i - 1) + ", x" + std::to_string(i - 1) + "]\n";
  EXPECT_NE(load_text("predicate p(scalar s) {\n" + lets + "sign x63[0] as e }").first_message, "");
}

TEST(Stress, HugeNumbers) {
  for (const char* number :
       {"2^1000000000", "3^1000000000", "10^10^10", "1e1000000000", "1e-1000000000", "2^-1000000000", "(2/3)^999999999",
        "99999999999999999999999999999999999999999999", "2^(2^62)"}) {
    load_expression("s * " + std::string(number));
    load_expression("a ^ " + std::string(number));
    load_expression("[s][" + std::string(number) + "]");
  }
}

TEST(Stress, HugeParameters) {
  EXPECT_NE(load_text("predicate p(moving point a[100000][100000]) { sign a[0][0] as e }").first_message, "");
  EXPECT_NE(
      load_text("predicate p(moving point a[2147483647][2147483647][2147483647]) { sign a[0] as e }").first_message,
      "");
  EXPECT_EQ(load_text("predicate p(scalar a[65536]) { sign a[65535] as e }").first_message, "");
}

TEST(Stress, MalformedUtf8) {
  EXPECT_EQ(load_text("predicate p(scalar a) { sign a \xC3\x28 }").first_message, "malformed UTF-8");
  EXPECT_GT(load_text(repeat("\xF0\x80", 500'000)).errors, 0u);
  EXPECT_GT(load_text(repeat("\xE2\x82\xAC", 300'000)).errors, 0u);
  EXPECT_GT(load_text(std::string(1'000'000, '\0')).errors, 0u);
}

TEST(Stress, FilesThatCannotBeRead) {
  SourceMap sources;
  Diagnostics diagnostics;
  load_program("no such folder/no such file.pred", sources, diagnostics);
  EXPECT_TRUE(diagnostics.has_errors());
  EXPECT_NE(diagnostics.render(sources).find("no such file.pred:1:1: error: cannot read"), std::string::npos);
}

}  // namespace
}  // namespace tightrope::dsl
