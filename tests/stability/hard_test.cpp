/// Every contact that some code once missed is found, for ever (tests/data/hard).

#include <gtest/gtest.h>

#include <algorithm>

#include "oracle/oracle.h"
#include "scenes/single_precision.h"
#include "tests/stability/query_folder.h"
#include "tests/stability/show_query.h"

namespace tightrope::ccd {
namespace {

TEST(Hard, EveryContactIsFoundByConservativeMethodsAndTheOracle) {
  const std::array<QueryBlock, 2> all = queries_below(TIGHTROPE_SOURCE_DIR "/tests/data/hard");
  EXPECT_EQ(all[0].size(), 76U);
  EXPECT_EQ(all[1].size(), 90U);
  for (const QueryBlock& block : all) {
    for (std::size_t i = 0; i < block.size(); ++i) {
      const auto points = std::span(block.points).subspan(coordinates_per_query * i).first<coordinates_per_query>();
      EXPECT_EQ(block.truths[i], 1);
      EXPECT_TRUE(oracle::contact(block.kind, points)) << "oracle\n" << show_query(points.data());
      for (const MethodInfo& method : methods()) {
        if (!method.conservative) continue;
        EXPECT_TRUE(collides(block.kind, points.data(), method.method)) << method.name << "\n"
                                                                        << show_query(points.data());
      }
    }
  }
}

/// Rounded to float they are other queries, most of them still contacts.
TEST(Hard, EveryContactThatIsLeftInFloatIsFoundByConservativeMethods) {
  for (const QueryBlock& block : queries_below(TIGHTROPE_SOURCE_DIR "/tests/data/hard")) {
    const SingleBlock single = in_single_precision(block, true);
    EXPECT_GT(std::count(single.truths.begin(), single.truths.end(), 1), 20);
    for (std::size_t i = 0; i < single.truths.size(); ++i) {
      if (single.truths[i] == 0) continue;
      for (const MethodInfo& method : methods()) {
        if (!method.conservative) continue;
        EXPECT_TRUE(collides(block.kind, single.points.data() + coordinates_per_query * i, method.method))
            << method.name << "\n"
            << show_query(block.points.data() + coordinates_per_query * i);
      }
    }
  }
}

}  // namespace
}  // namespace tightrope::ccd
