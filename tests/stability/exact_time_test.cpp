/// The exact stage on the public benchmark's sample queries: every answer, and every time of first contact against the
/// oracle's.

#include "ccd/impact/exact_time.h"

#include <gtest/gtest.h>

#include "oracle/oracle.h"
#include "tests/stability/samples.h"
#include "tests/stability/show_query.h"

namespace tightrope::ccd {
namespace {

class ExactTimeOfSamples : public test::SamplesFixture {};

TEST_F(ExactTimeOfSamples, IsThatOfTheOracle) {
  for (const QueryBlock& block : queries_) {
    const Pair pair = block.kind == Kind::vertex_face ? Pair::vertex_face : Pair::edge_edge;
    for (std::size_t i = 0; i < block.size(); ++i) {
      const auto points = std::span(block.points).subspan(coordinates_per_query * i).first<coordinates_per_query>();
      const auto found = exact_first_contact(pair, points.data(), 0, 1);
      ASSERT_EQ(found.has_value(), block.truths[i] != 0) << show_query(points.data());
      if (!found) continue;
      const auto truth = oracle::first_contact(block.kind, points);
      EXPECT_EQ(found->lower, truth->lower) << show_query(points.data());
      EXPECT_EQ(found->upper, truth->upper) << show_query(points.data());
      const auto coarse = exact_first_contact(pair, points.data(), 1e-6, 1);
      EXPECT_LE(coarse->lower, truth->lower);
      EXPECT_GE(coarse->upper, truth->upper);
      EXPECT_LE(coarse->upper - coarse->lower, 1e-6);
    }
  }
}

}  // namespace
}  // namespace tightrope::ccd
