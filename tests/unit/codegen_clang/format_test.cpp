#include "codegen/clang/format.h"

#include <gtest/gtest.h>

#include "tests/unit/codegen/test_program.h"

namespace tightrope::codegen {
namespace {

TEST(Format, BreaksLinesAndKeepsComments) {
  const std::string long_comment = "// " + std::string(130, 'x') + " y\n";
  EXPECT_EQ(formatted("struct   A{int a;};\n", "a.h"), "struct A {\n  int a;\n};\n");
  EXPECT_EQ(formatted(long_comment, "a.h"), long_comment);
  std::string call = "int f(";
  for (int i = 0; i < 40; ++i) call += "int argument" + std::to_string(i) + (i < 39 ? ", " : ");\n");
  std::istringstream lines(formatted(call, "a.h"));
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) EXPECT_LE(line.size(), 120u);
  EXPECT_GT(count, 3);
}

/// A configuration file beside the output, or above it, is the user's and for the user's code.
TEST(Format, ReadsNoConfiguration) {
  const testing_support::ScratchFolder folder;
  folder.write(".clang-format", "BasedOnStyle: GNU\nColumnLimit: 20\n");
  const std::string name = (folder.path() / "a.h").string();
  EXPECT_EQ(formatted("int f(int a,int b){return a+b;}\n", name), "int f(int a, int b) { return a + b; }\n");
}

TEST(Format, IsIdempotent) {
  const std::string once = formatted("namespace a {int f(int b) {if (b) {return 1;} return 2;}}\n", "a.h");
  EXPECT_EQ(formatted(once, "a.h"), once);
}

TEST(Format, LeavesVeryLongTextsAsTheyAre) {
  const std::string text = std::string(5'000'000, ' ') + "int   a;\n";
  EXPECT_EQ(formatted(text, "a.h"), text);
}

}  // namespace
}  // namespace tightrope::codegen
