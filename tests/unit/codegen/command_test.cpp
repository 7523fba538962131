#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "codegen/compile.h"
#include "tests/unit/codegen/test_program.h"

namespace tightrope::codegen {
namespace {

namespace fs = std::filesystem;
using testing_support::read_text;
using testing_support::ScratchFolder;

constexpr const char* orient2d = "predicate orient2d(point2 a, b, c) { sign det(b - a, c - a) as side }\n";
constexpr const char* wrong = "predicate f(scalar a, vec3 v) { sign a + v as y }\npredicate g() { sign crss as z }\n";

struct Outcome {
  int status = -1;
  std::string output;
  std::string errors;
};

/// Runs `tightrope ARGUMENTS` in a folder.
Outcome tightrope(const ScratchFolder& folder, const std::string& arguments) {
  const fs::path out = folder.path() / ".out";
  const fs::path err = folder.path() / ".err";
  const std::string command = "cd '" + folder.path().string() + "' && '" TIGHTROPE_COMMAND "' " + arguments + " >'" +
                              out.string() + "' 2>'" + err.string() + "'";
  const int status = std::system(command.c_str());
  Outcome run{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(out), read_text(err)};
  fs::remove(out);
  fs::remove(err);
  return run;
}

std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Command, CheckAcceptsARightProgramAndReportsEveryErrorOfAWrongOne) {
  const ScratchFolder folder;
  folder.write("right.pred", orient2d);
  folder.write("wrong.pred", wrong);
  const Outcome right = tightrope(folder, "check right.pred");
  EXPECT_EQ(right.status, 0);
  EXPECT_EQ(right.output, "right.pred: 1 predicate, no errors\n");
  EXPECT_EQ(right.errors, "");
  const Outcome both = tightrope(folder, "check wrong.pred right.pred");
  EXPECT_EQ(both.status, 1);
  EXPECT_EQ(both.output, "right.pred: 1 predicate, no errors\n");
  EXPECT_TRUE(has(both.errors, "wrong.pred:1:")) << both.errors;
  EXPECT_TRUE(has(both.errors, "wrong.pred:2:")) << both.errors;
}

TEST(Command, CompileWritesOneHeaderForEveryBoundAndScalarType) {
  const ScratchFolder folder;
  folder.write("orient2d.pred", orient2d);
  EXPECT_EQ(tightrope(folder, "compile orient2d.pred -o one").status, 0);
  EXPECT_EQ(files_in(folder.path() / "one"), (std::vector<std::string>{"orient2d.tight.double.h"}));
  EXPECT_EQ(tightrope(folder, "compile orient2d.pred --bound safe,float --real float -o two/deep").status, 0);
  EXPECT_EQ(files_in(folder.path() / "two" / "deep"),
            (std::vector<std::string>{"orient2d.float.float.h", "orient2d.safe.float.h"}));
  EXPECT_EQ(tightrope(folder, "compile orient2d.pred --bound all --real all --tests -o all").status, 0);
  EXPECT_EQ(files_in(folder.path() / "all"),
            (std::vector<std::string>{"CMakeLists.txt", "orient2d.exact.double.h", "orient2d.exact.float.h",
                                      "orient2d.float.double.h", "orient2d.float.float.h", "orient2d.interval.double.h",
                                      "orient2d.interval.float.h", "orient2d.safe.double.h", "orient2d.safe.float.h",
                                      "orient2d.staged.double.h", "orient2d.staged.float.h", "orient2d.test.cpp",
                                      "orient2d.tight.double.h", "orient2d.tight.float.h"}));
  // `all` has mode `static` where it applies.
  folder.write("ranged.pred", "predicate ranged(scalar x, y) { range |x, y| <= 1 sign x - y as s }\n");
  EXPECT_EQ(tightrope(folder, "compile ranged.pred --bound all -o all").status, 0);
  EXPECT_TRUE(fs::exists(folder.path() / "all" / "ranged.static.double.h"));
}

TEST(Command, TargetSimdWritesHeadersForVectorClasses) {
  const ScratchFolder folder;
  folder.write("orient2d.pred", orient2d);
  EXPECT_EQ(tightrope(folder, "compile orient2d.pred --target simd --bound all -o simd").status, 0);
  EXPECT_EQ(files_in(folder.path() / "simd"),
            (std::vector<std::string>{"orient2d.float.double.simd.h", "orient2d.interval.double.simd.h",
                                      "orient2d.safe.double.simd.h", "orient2d.tight.double.simd.h"}));
  EXPECT_EQ(tightrope(folder, "compile orient2d.pred --target cpp,simd --real float --bound exact,safe -o both").status,
            0);
  EXPECT_EQ(
      files_in(folder.path() / "both"),
      (std::vector<std::string>{"orient2d.exact.float.h", "orient2d.safe.float.h", "orient2d.safe.float.simd.h"}));
}

TEST(Command, TargetCudaWritesBatchesBesideTheHeaders) {
  const ScratchFolder folder;
  folder.write("orient2d.pred", orient2d);
  const std::vector<std::string> batches = {"orient2d.tight.float.cu", "orient2d.tight.float.cuda.h",
                                            "orient2d.tight.float.h"};
  EXPECT_EQ(tightrope(folder, "compile orient2d.pred --target cuda --real float -o cuda").status, 0);
  EXPECT_EQ(files_in(folder.path() / "cuda"), batches);
  EXPECT_EQ(tightrope(folder, "compile orient2d.pred --target cuda,cpp --real float -o both").status, 0);
  EXPECT_EQ(files_in(folder.path() / "both"), batches);
  // What runs on the host alone is left out under `all`, and written where cpp is asked for, too.
  EXPECT_EQ(tightrope(folder, "compile orient2d.pred --target cuda --bound all -o all").status, 0);
  EXPECT_FALSE(fs::exists(folder.path() / "all" / "orient2d.exact.double.h"));
  EXPECT_TRUE(fs::exists(folder.path() / "all" / "orient2d.interval.double.cu"));
  EXPECT_EQ(tightrope(folder, "compile orient2d.pred --target cuda,cpp --bound exact,safe -o exact").status, 0);
  EXPECT_EQ(files_in(folder.path() / "exact"),
            (std::vector<std::string>{"orient2d.exact.double.h", "orient2d.safe.double.cu",
                                      "orient2d.safe.double.cuda.h", "orient2d.safe.double.h"}));
}

TEST(Command, SameInputGivesTheSameBytesWhereverItLies) {
  const ScratchFolder folder;
  fs::create_directories(folder.path() / "elsewhere");
  folder.write("orient2d.pred", orient2d);
  folder.write("elsewhere/orient2d.pred", orient2d);
  EXPECT_EQ(tightrope(folder, "compile orient2d.pred --bound all --real all --target all --tests -o a").status, 0);
  EXPECT_EQ(
      tightrope(folder, "compile elsewhere/../elsewhere/orient2d.pred --bound all --real all --target all --tests -o b")
          .status,
      0);
  for (const std::string& name : files_in(folder.path() / "a")) {
    EXPECT_EQ(read_text(folder.path() / "a" / name), read_text(folder.path() / "b" / name)) << name;
  }
}

TEST(Command, HashFollowsTheImportedText) {
  const ScratchFolder folder;
  folder.write("shapes.pred", "function twice(a) = 2 * a\n");
  folder.write("main.pred", "import \"shapes.pred\"\npredicate f(scalar a) { sign twice(a) as y }\n");
  EXPECT_EQ(tightrope(folder, "compile main.pred -o a").status, 0);
  folder.write("shapes.pred", "function twice(b) = 2 * b\n");
  EXPECT_EQ(tightrope(folder, "compile main.pred -o b").status, 0);
  const std::string a = read_text(folder.path() / "a" / "main.tight.double.h");
  const std::string b = read_text(folder.path() / "b" / "main.tight.double.h");
  EXPECT_NE(a.substr(0, a.find('\n')), b.substr(0, b.find('\n')));
  EXPECT_EQ(a.substr(a.find('\n')), b.substr(b.find('\n')));
}

TEST(Command, WrongProgramsWriteNothing) {
  const ScratchFolder folder;
  folder.write("wrong.pred", wrong);
  const Outcome run = tightrope(folder, "compile wrong.pred --tests --depfile out/wrong.d -o out");
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.output, "");
  EXPECT_FALSE(fs::exists(folder.path() / "out"));
}

TEST(Command, ErrorsSharedByBoundsAreReportedOnce) {
  const ScratchFolder folder;
  folder.write("large.pred", "predicate f(scalar a) { sign a - 16777217 as y }\n");
  const Outcome run = tightrope(folder, "compile large.pred --bound safe,tight --real float -o out");
  EXPECT_EQ(run.status, 1);
  const std::size_t first = run.errors.find("error:");
  ASSERT_NE(first, std::string::npos) << run.errors;
  EXPECT_EQ(run.errors.find("error:", first + 1), std::string::npos) << run.errors;
}

struct BadUsage {
  const char* arguments;
  const char* message;
};

TEST(Command, BadUsageIsOneClearLineAndStatus2) {
  const ScratchFolder folder;
  folder.write("orient2d.pred", orient2d);
  folder.write("file", "in the way\n");
  const BadUsage table[] = {
      {"compile orient2d.pred --bound ball -o out",
       "tightrope: error: --bound: unknown value 'ball' (accepted: float, safe, tight, static, interval, exact, "
       "staged, all)"},
      {"compile orient2d.pred --real half -o out",
       "tightrope: error: --real: unknown value 'half' (accepted: double, float, all)"},
      {"compile orient2d.pred --products fast -o out",
       "tightrope: error: --products: unknown value 'fast' (accepted: direct, karatsuba)"},
      {"compile orient2d.pred --target opencl -o out",
       "tightrope: error: --target: unknown value 'opencl' (accepted: cpp, simd, cuda, all)"},
      {"compile orient2d.pred --target cuda --bound tight,exact -o out",
       "tightrope: error: --bound: mode exact runs on the host, on one query at a time (needs --target cpp, not cuda)"},
      {"compile orient2d.pred --target simd --bound staged -o out",
       "tightrope: error: --bound: mode staged runs on the host, on one query at a time (needs --target cpp, not "
       "simd)"},
      {"compile orient2d.pred --target cuda --tests -o out",
       "tightrope: error: --tests: the generated tests need --target cpp"},
      {"report orient2d.pred --format xml",
       "tightrope: error: --format: unknown value 'xml' (accepted: text, json, table)"},
      {"compile missing.pred -o out", "tightrope: error: cannot read missing.pred"},
      {"check missing.pred", "tightrope: error: cannot read missing.pred"},
      {"check .", "tightrope: error: cannot read ."},
      {"compile orient2d.pred -o file", "tightrope: error: cannot write file/orient2d.tight.double.h: "},
      {"compile orient2d.pred -o out --depfile file/x.d", "tightrope: error: cannot write file/x.d: "},
      {"compile orient2d.pred --frobnicate", "--frobnicate"},
      {"compile", "FILE"},
      {"", "subcommand"},
  };
  for (const BadUsage& row : table) {
    const Outcome run = tightrope(folder, row.arguments);
    EXPECT_EQ(run.status, 2) << row.arguments << "\n" << run.errors;
    EXPECT_TRUE(has(run.errors, row.message)) << row.arguments << "\n" << run.errors;
    EXPECT_EQ(run.output, "") << row.arguments;
  }
  EXPECT_EQ(files_in(folder.path()), (std::vector<std::string>{"file", "orient2d.pred"}));
}

/// The file system refuses to say anything about such a name.
TEST(Command, NamesTooLongForTheFileSystemAreAnErrorLikeOthers) {
  const ScratchFolder folder;
  folder.write("orient2d.pred", orient2d);
  const std::string name(300, 'x');
  for (const std::string& arguments :
       {"compile orient2d.pred -o " + name, "compile orient2d.pred -o out --depfile " + name}) {
    const Outcome run = tightrope(folder, arguments);
    EXPECT_EQ(run.status, 2) << run.errors;
    EXPECT_TRUE(has(run.errors, "tightrope: error: cannot write " + name)) << run.errors;
    EXPECT_EQ(files_in(folder.path()), (std::vector<std::string>{"orient2d.pred"}));
  }
}

TEST(Command, TestsDoNotReplaceAProjectOfTheUsersOwn) {
  const ScratchFolder folder;
  folder.write("orient2d.pred", orient2d);
  folder.write("CMakeLists.txt", "project(mine)\n");
  const Outcome refused = tightrope(folder, "compile orient2d.pred --tests");
  EXPECT_EQ(refused.status, 2);
  EXPECT_TRUE(has(refused.errors, "CMakeLists.txt is there and was not generated")) << refused.errors;
  EXPECT_EQ(read_text(folder.path() / "CMakeLists.txt"), "project(mine)\n");
  EXPECT_EQ(files_in(folder.path()), (std::vector<std::string>{"CMakeLists.txt", "orient2d.pred"}));
  EXPECT_EQ(tightrope(folder, "compile orient2d.pred --tests -o out").status, 0);
  EXPECT_EQ(tightrope(folder, "compile orient2d.pred --tests -o out").status, 0) << "ours may be written again";
}

TEST(Command, HelpAndVersionEverywhere) {
  const ScratchFolder folder;
  for (const char* arguments : {"--help", "check --help", "compile --help", "report --help"}) {
    const Outcome run = tightrope(folder, arguments);
    EXPECT_EQ(run.status, 0) << arguments;
    EXPECT_TRUE(has(run.output, "Usage:")) << run.output;
  }
  const Outcome version = tightrope(folder, "--version");
  EXPECT_EQ(version.status, 0);
  EXPECT_TRUE(version.output.starts_with("tightrope ")) << version.output;
}

TEST(Command, DepfileNamesOutputsAndEveryFileRead) {
  const ScratchFolder folder;
  folder.write("shapes.pred", "function twice(a) = 2 * a\n");
  folder.write("main.pred", "import \"shapes.pred\"\npredicate f(scalar a) { sign twice(a) as y }\n");
  EXPECT_EQ(tightrope(folder, "compile main.pred --tests --depfile out/main.d -o out").status, 0);
  const std::string text = read_text(folder.path() / "out" / "main.d");
  const std::string root = fs::canonical(folder.path()).string();
  for (const char* name : {"/out/main.tight.double.h", "/out/main.test.cpp", "/main.pred", "/shapes.pred"}) {
    EXPECT_TRUE(has(text, root + name)) << text;
  }
  EXPECT_FALSE(has(text, "CMakeLists.txt")) << text;
}

TEST(Command, DepfileEscapesWhatMakeWouldSplit) {
  EXPECT_EQ(depfile_text({"/a b/c.h", "/x$.h"}, {"/p#.pred", "/q.pred"}),
            "/a\\ b/c.h \\\n/x$$.h: \\\n  /p\\#.pred \\\n  /q.pred\n");
}

TEST(Command, ReportIsReadableByPeopleAndPrograms) {
  const ScratchFolder folder;
  folder.write("orient2d.pred", orient2d);
  const Outcome text = tightrope(folder, "report orient2d.pred --bound safe,tight");
  EXPECT_EQ(text.status, 0);
  EXPECT_TRUE(has(text.output, "orient2d, bound safe, double\n")) << text.output;
  EXPECT_TRUE(has(text.output, "k = ")) << text.output;
  const Outcome json = tightrope(folder, "report orient2d.pred --bound all --real all --format json");
  const auto parsed = nlohmann::json::parse(json.output);
  ASSERT_EQ(parsed.size(), 8U);
  EXPECT_EQ(parsed[0]["predicate"], "orient2d");
  EXPECT_EQ(parsed[0]["stages"][0]["outputs"][0]["name"], "side");
}

}  // namespace
}  // namespace tightrope::codegen
