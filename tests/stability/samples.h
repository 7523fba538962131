#pragma once
/// The public CCD benchmark's sample queries, for tests; without them the tests are skipped.

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "tests/stability/query_folder.h"

namespace tightrope::ccd::test {

/// Where they are: the folder named by TIGHTROPE_SAMPLE_QUERIES, else ../shared/data/sample-queries beside the
/// repository.
inline std::optional<std::string> sample_folder() {
  const char* named = std::getenv("TIGHTROPE_SAMPLE_QUERIES");
  const std::string folder = named != nullptr ? named : TIGHTROPE_SOURCE_DIR "/../shared/data/sample-queries";
  if (named == nullptr && !std::filesystem::is_directory(folder)) return std::nullopt;
  return folder;
}

class SamplesFixture : public testing::Test {
 protected:
  void SetUp() override {
    const auto folder = sample_folder();
    if (!folder) GTEST_SKIP() << "skipped: no sample queries (TIGHTROPE_SAMPLE_QUERIES is not set)";
    queries_ = queries_below(*folder);
    ASSERT_GT(queries_[0].size() + queries_[1].size(), 0U);
  }

  std::array<QueryBlock, 2> queries_;
};

}  // namespace tightrope::ccd::test
