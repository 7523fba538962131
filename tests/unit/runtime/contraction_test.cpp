/// What compilers make of runtime/tightrope/arithmetic.h: read from the assembly of every compiler on the path, because
/// this test's own flags say little about users' flags.

#include <gtest/gtest.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

#if defined(__x86_64__)
const std::string fused_flags = "-mfma";
const std::vector<std::string> fused_mnemonics = {"vfmadd", "vfmsub", "vfnmadd", "vfnmsub"};
#elif defined(__aarch64__)
const std::string fused_flags;
const std::vector<std::string> fused_mnemonics = {"fmadd", "fmsub", "fnmadd", "fnmsub", "fmla", "fmls"};
#else
const std::string fused_flags;
const std::vector<std::string> fused_mnemonics;
#endif

struct Compilation {
  bool succeeded;
  std::string assembly;
  std::string messages;
};

class Compiler : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (system(("command -v " + GetParam() + " >/dev/null 2>&1").c_str()) != 0) GTEST_SKIP() << "no " << GetParam();
    std::string name = ::testing::TempDir() + "tightrope-contraction-XXXXXX";
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    directory_ = name;
  }
  void TearDown() override {
    if (directory_.empty()) return;
    for (const char* file : {"/code.cpp", "/code.s", "/messages"}) unlink((directory_ + file).c_str());
    rmdir(directory_.c_str());
  }

  Compilation compile(const std::string& code, const std::string& flags) const {
    std::ofstream(directory_ + "/code.cpp") << code;
    unlink((directory_ + "/code.s").c_str());
    const std::string command = GetParam() + " -std=c++20 " + flags + " -I" TIGHTROPE_SOURCE_DIR "/runtime -S -o " +
                                directory_ + "/code.s " + directory_ + "/code.cpp >" + directory_ + "/messages 2>&1";
    const bool succeeded = system(command.c_str()) == 0;
    return {succeeded, text("/code.s"), text("/messages")};
  }

 private:
  std::string text(const char* file) const {
    std::ostringstream all;
    all << std::ifstream(directory_ + file).rdbuf();
    return all.str();
  }
  std::string directory_;
};

bool has_fused_operation(const std::string& assembly) {
  for (const std::string& mnemonic : fused_mnemonics) {
    if (assembly.find(mnemonic) != std::string::npos) return true;
  }
  return false;
}

const char* const barrier = R"(
#include <tightrope/arithmetic.h>
template <class Real> Real dot(const Real* a, const Real* b) {
  using tightrope::product;
  return product(a[0], b[0]) - product(a[1], b[1]) + product(a[2], b[2]);
}
template double dot(const double*, const double*);
template float dot(const float*, const float*);
)";
const char* const no_barrier = R"(
template <class Real> Real dot(const Real* a, const Real* b) { return a[0] * b[0] - a[1] * b[1] + a[2] * b[2]; }
template double dot(const double*, const double*);
template float dot(const float*, const float*);
)";

TEST_P(Compiler, DoesNotFuseProductsBehindTheBarrier) {
  if (fused_mnemonics.empty()) GTEST_SKIP() << "unknown architecture";
  for (const std::string flags : {"-O1", "-O2", "-O3", "-O3 -ffp-contract=fast"}) {
    const Compilation guarded = compile(barrier, flags + " " + fused_flags);
    ASSERT_TRUE(guarded.succeeded) << guarded.messages;
    EXPECT_FALSE(has_fused_operation(guarded.assembly)) << flags << '\n' << guarded.assembly;
  }
}

TEST_P(Compiler, FusesWithoutTheBarrier) {  // so the test above can fail
  if (fused_mnemonics.empty()) GTEST_SKIP() << "unknown architecture";
  const Compilation bare = compile(no_barrier, "-O3 -ffp-contract=fast " + fused_flags);
  ASSERT_TRUE(bare.succeeded) << bare.messages;
  EXPECT_TRUE(has_fused_operation(bare.assembly)) << bare.assembly;
}

TEST_P(Compiler, TheBarrierCostsNoMemoryAccess) {
  if (fused_flags.empty()) GTEST_SKIP() << "counts x86 stores";
  const Compilation guarded = compile(barrier, "-O3 " + fused_flags);
  ASSERT_TRUE(guarded.succeeded) << guarded.messages;
  EXPECT_EQ(guarded.assembly.find("(%rsp)"), std::string::npos) << guarded.assembly;
}

TEST_P(Compiler, RefusesFastMathAndItsParts) {
  const std::string include = "#include <tightrope/sign.h>\n";
  for (const std::string flags : {"-ffast-math", "-ffinite-math-only", "-Ofast"}) {
    const Compilation fast = compile(include, flags);
    EXPECT_FALSE(fast.succeeded) << flags;
    EXPECT_NE(fast.messages.find("Tightrope: error bounds do not hold"), std::string::npos) << fast.messages;
  }
  for (const std::string flags : {"-O3", "-O3 -fno-math-errno -fno-trapping-math"}) {
    const Compilation sound = compile(include, flags);
    EXPECT_TRUE(sound.succeeded) << flags << sound.messages;
  }
}

INSTANTIATE_TEST_SUITE_P(OnThePath, Compiler, ::testing::Values("g++", "clang++"), [](const auto& test) {
  return test.param == "g++" ? std::string("gcc") : std::string("clang");
});

}  // namespace
