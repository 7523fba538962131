/// The commands need as much memory for many queries as for few.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "tests/unit/ccd/hdf5_file.h"
#include "tests/unit/ccd/scratch_directory.h"

namespace tightrope::ccd {
namespace {

/// `count` times a vertex that stays above a triangle; highly compressed, so that the file is small.
std::string write_queries(const ScratchDirectory& scratch, std::size_t count) {
  const double face[] = {0, 0, 0, 4, 0, 0, 0, 4, 0};
  std::vector<double> points;
  points.reserve(24 * count);
  for (std::size_t i = 0; i < count; ++i) {
    for (const double height : {2.0, 1.0}) {
      points.insert(points.end(), {1, 1, height});
      points.insert(points.end(), std::begin(face), std::end(face));
    }
  }
  Hdf5File file(scratch.path() / (std::to_string(count) + ".h5"));
  return file.chunks({4096, 8, 3}, 1).queries("vertex-face/queries", points).close().string();
}

/// Largest resident memory of a run of the command, in bytes.
long memory_of(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), TIGHTROPE_CCD_COMMAND);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    const int nothing = ::open("/dev/null", O_RDWR);
    for (const int stream : {0, 1, 2}) ::dup2(nothing, stream);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  int status = 0;
  rusage used{};
  EXPECT_EQ(::wait4(child, &status, 0, &used), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << arguments[1];
  return used.ru_maxrss * 1024;
}

TEST(BoundedMemory, DoesNotGrowWithTheNumberOfQueries) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "a sanitizer keeps memory that was freed";
#endif
  const ScratchDirectory scratch;
  constexpr std::size_t few = 140'000, many = 500'000;  // more than a block each
  constexpr long megabyte = 1'000'000;
  const std::string small = write_queries(scratch, few), large = write_queries(scratch, many);
  const std::vector<std::vector<std::string>> commands = {
      {"classify", "--method", "tight"}, {"toi"}, {"exact"}, {"evaluate", "--method", "tight"}, {"stages"}};
  for (const auto& command : commands) {
    auto with = [&](const std::string& file) {
      auto arguments = command;
      arguments.push_back(file);
      return memory_of(arguments);
    };
    const long of_small = with(small), of_large = with(large);
    EXPECT_LT(of_large - of_small, 4 * megabyte) << command[0];  // 69 MB of queries more
    EXPECT_LT(of_large, 128 * megabyte) << command[0];
  }
}

}  // namespace
}  // namespace tightrope::ccd
