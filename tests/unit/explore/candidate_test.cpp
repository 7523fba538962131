#include "codegen/explore/candidate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "codegen/explore/accuracy.h"
#include "codegen/explore/float_first.h"
#include "dsl/evaluate.h"
#include "tests/unit/explore/predicates.h"

namespace tightrope::codegen::explore {
namespace {

using namespace testing_support;

const Candidate& find(const std::vector<Candidate>& all, const std::string& name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Candidate& c) { return c.name() == name; });
  EXPECT_NE(found, all.end()) << name;
  return found == all.end() ? all.front() : *found;
}

TEST(Schemes, HaveNamesOfTheirOwn) {
  const std::vector<Scheme> all = all_schemes();
  EXPECT_EQ(all.size(), 122U);
  std::set<std::string> names;
  for (const Scheme& scheme : all) names.insert(name(scheme));
  EXPECT_EQ(names.size(), all.size());
  EXPECT_EQ(name(all.front()), "tight");
}

TEST(Candidates, OfCodeThatIsTheSameThereIsOne) {
  const std::vector<Candidate> all = candidates(lowerings(orientation), Precision::binary64);
  std::set<std::string> codes;
  std::size_t combinations = 0;
  for (const Candidate& c : all) {
    EXPECT_FALSE(c.scheme.recomputes) << "one stage has nothing to keep";
    EXPECT_EQ(c.scheme.products, dsl::ProductScheme::direct) << "nothing moves";
    const std::string kind = std::string(codegen::name(c.scheme.bound)) + (c.filter ? "filter" : "");
    EXPECT_TRUE(codes.insert(kind + print(c.bounded.graph)).second) << c.name();
    combinations += 1 + c.aliases.size();
  }
  EXPECT_EQ(combinations, 122U - 24) << "`static` needs ranges; all the rest is some candidate's alias";
  const auto& aliases = find(all, "tight").aliases;
  EXPECT_NE(std::find(aliases.begin(), aliases.end(), "tight-delta-casteljau"), aliases.end());
}

TEST(Candidates, EveryChoiceMakesADifferenceWhereItCan) {
  const std::vector<Candidate> all = candidates(lowerings(everything), Precision::binary64);
  for (const char* name : {"tight", "tight-delta", "tight-casteljau", "tight-balanced", "tight-factored", "tight-fma",
                           "tight-recompute", "tight-float-first", "safe-delta-balanced-fma", "interval", "float"}) {
    EXPECT_EQ(find(all, name).name(), name);
  }
  const auto operations = [&](const char* name) { return find(all, name).operations(1); };
  EXPECT_LT(operations("tight-factored"), operations("tight"));
  EXPECT_GT(operations("tight-recompute"), operations("tight"));
  EXPECT_GT(operations("tight-casteljau"), operations("tight"));
  EXPECT_LT(operations("float-fma"), operations("tight-fma"));
  const Schedule recomputed = schedule(find(all, "tight-recompute").bounded);
  EXPECT_EQ(std::count(recomputed.saved.begin(), recomputed.saved.end(), true), 0);
  for (const StageSchedule& stage : recomputed.stages) {
    for (const Step& step : stage.steps) EXPECT_NE(step.kind, Step::Kind::load);
  }
}

TEST(Candidates, DeCasteljauInterpolatesNTimes) {
  const auto all = candidates(lowerings("predicate f(scalar k[3], scalar t) { sign bernstein(k) at t as y }\n"),
                              Precision::binary64);
  const OperationCount casteljau = find(all, "float-casteljau").values(0);
  EXPECT_EQ(casteljau.products, 6) << "two a point, three points in two levels";
  EXPECT_EQ(casteljau.sums, 3 + 1) << "one a point, and 1 - t";
  const OperationCount horner = find(all, "float").values(0);
  EXPECT_EQ(horner.sums, 2 + 1);
  EXPECT_LT(horner.products, casteljau.products);
}

TEST(Candidates, StaticWhereRangesAllowIt) {
  EXPECT_EQ(find(candidates(lowerings(ranged), Precision::binary64), "static").name(), "static");
}

/// Inputs of one scale, some of them equal or close to others, and of mixed scales.
Row extreme_row(const dsl::Predicate& predicate, Precision inputs, std::mt19937_64& random) {
  const int widest = inputs == Precision::binary64 ? 1070 : 148;
  const int scale = static_cast<int>(random() % static_cast<unsigned>(2 * widest)) - widest;
  const bool mixed = random() % 4 == 0;
  Row row;
  for (std::size_t i = 0; i < predicate.slots.size(); ++i) {
    double x = std::ldexp(static_cast<double>(random() >> 11), -52) - 1;
    x = std::ldexp(x, mixed               ? static_cast<int>(random() % 60) - 30
                      : random() % 2 == 0 ? std::min(scale, widest - 50)
                                          : 0);
    if (random() % 4 == 0) x = static_cast<double>(static_cast<int>(random() % 5) - 2);
    if (i > 0 && random() % 4 == 0) x = std::nextafter(row[static_cast<std::size_t>(random() % i)], x);
    if (inputs == Precision::binary32) x = static_cast<double>(static_cast<float>(x));
    row.push_back(x);
  }
  return row;
}

std::vector<Row> extreme_rows(const dsl::Predicate& predicate, Precision inputs, int count) {
  std::mt19937_64 random(2);
  std::vector<Row> rows;
  for (int i = 0; i < count; ++i) rows.push_back(extreme_row(predicate, inputs, random));
  return rows;
}

struct Verdict {
  int checked = 0;
  int definite = 0;
  int broken = 0;
};

/// Bounds and signs of a candidate, held against exact arithmetic.
Verdict judge(const Candidate& candidate, const dsl::Predicate& written, const std::vector<Row>& rows) {
  Verdict verdict;
  const std::size_t last = written.stages.size() - 1;
  for (const Row& row : rows) {
    std::vector<Enclosure> slots(row.begin(), row.end());
    slots.resize(2 * row.size());
    const auto exact = dsl::evaluate<Enclosure>(written.graph, slots);
    const std::vector<Computed> computed = compute(candidate, row, last);
    const std::vector<Place> all = places(written, last);
    for (std::size_t p = 0; p < all.size(); ++p) {
      const Enclosure& truth =
          exact[static_cast<std::size_t>(written.stages[all[p].stage].outputs[all[p].output].nodes[all[p].element])];
      const auto& [value, bound] = computed[p];
      const int sign = value > bound ? 1 : value < -bound ? -1 : 0;
      ++verdict.checked;
      verdict.definite += sign != 0;
      const bool wrong = sign != 0 && sign != truth.sign();
      const bool outside =
          std::isfinite(value) && std::isfinite(bound) && abs(Enclosure(value) - truth).lower() > DyadicRatio(bound);
      verdict.broken += wrong || outside;
    }
  }
  return verdict;
}

TEST(Candidates, BoundsOfEverySchemeHoldAtAllScales) {
  for (const Precision inputs : {Precision::binary64, Precision::binary32}) {
    const Lowerings source = lowerings(everything);
    for (const Candidate& candidate : candidates(source, inputs)) {
      if (candidate.scheme.bound == BoundMode::none || candidate.scheme.recomputes) continue;
      const Verdict verdict = judge(candidate, source.written(), extreme_rows(source.written(), inputs, 25));
      EXPECT_EQ(verdict.broken, 0) << candidate.name();
      EXPECT_GT(verdict.definite, verdict.checked / 10) << candidate.name();
    }
  }
}

TEST(Candidates, BoundsThatLeaveOutATermAreNoticed) {
  const Lowerings source = lowerings(cancelling);
  const auto drawn = random_rows(source.written(), Precision::binary64, 500);
  std::vector<Row> rows;
  for (const NearZero& near : samples(source.written(), drawn, Precision::binary64, 0).near_zero) {
    rows.push_back(near.row);
  }
  for (const char* name : {"tight-delta", "tight-casteljau", "tight-balanced", "tight-factored", "tight-float-first"}) {
    Candidate candidate = find(candidates(source, Precision::binary64), name);
    EXPECT_EQ(judge(candidate, source.written(), rows).broken, 0) << name;
    dsl::Diagnostics diagnostics;
    const Weakening weakening = Weakening::drop_rounding_of_products;
    candidate.bounded = add_bounds(candidate.predicate, BoundMode::tight, Precision::binary64, diagnostics, weakening);
    if (candidate.filter) {
      candidate.filter->bounded =
          add_bounds(candidate.filter->predicate, BoundMode::tight, Precision::binary32, diagnostics, weakening);
    }
    EXPECT_GT(judge(candidate, source.written(), rows).broken, 0) << name;
  }
}

/// Without the rounding errors of its inputs the filter is wrong.
TEST(FloatFirst, InputsThatAreRoundedWithoutABoundAreNoticed) {
  const Lowerings source = lowerings(orientation);
  Candidate candidate = find(candidates(source, Precision::binary64), "tight-float-first");
  EXPECT_EQ(judge(candidate, source.written(), extreme_rows(source.written(), Precision::binary64, 500)).broken, 0);
  dsl::Diagnostics diagnostics;
  candidate.filter->bounded = add_bounds(candidate.filter->predicate, BoundMode::tight, Precision::binary32,
                                         diagnostics, Weakening::drop_input_bound);
  EXPECT_GT(judge(candidate, source.written(), extreme_rows(source.written(), Precision::binary64, 500)).broken, 0);
}

TEST(FloatFirst, RoundedInputsKeepTheirDistance) {
  std::mt19937_64 random(3);
  int rounded = 0;
  for (int i = 0; i < 20000; ++i) {
    const int exponent = static_cast<int>(random() % 320) - 190;
    const double x = std::ldexp(1 + std::ldexp(static_cast<double>(random() >> 12), -52), exponent);
    const auto [value, bound] = rounded_input(x);
    if (!std::isfinite(value)) {
      EXPECT_GT(bound, std::numeric_limits<float>::max());
      continue;
    }
    const DyadicRatio distance = abs(Enclosure(static_cast<double>(value)) - Enclosure(x)).lower();
    ASSERT_LE(distance, DyadicRatio(static_cast<double>(bound))) << x;
    rounded += bound > 0;
  }
  EXPECT_GT(rounded, 15000);
  EXPECT_EQ(rounded_input(0.1F).bound, 0);
  EXPECT_TRUE(std::isnan(rounded_input(NAN).bound));
}

TEST(FloatFirst, DecidesEasySignsInSinglePrecisionAndHardOnesInDouble) {
  const Lowerings source = lowerings(orientation);
  const Candidate candidate = find(candidates(source, Precision::binary64), "tight-float-first");
  const Row easy = {0, 0, 1, 0, 0.25, 1};
  const Row hard = {0, 0, 1, 0x1p-30, 1, 0x1p-30 + 0x1p-45};  // too close for 24 bits
  EXPECT_EQ(compute(candidate, easy, 0)[0].bound, compute(candidate, easy, 0)[0].bound);
  EXPECT_GT(compute(candidate, easy, 0)[0].value, 0.5);
  const Computed decided = compute(candidate, hard, 0)[0];
  EXPECT_GT(decided.value, decided.bound);
}

TEST(FloatFirst, NeedsExactInputsAndSigns) {
  for (const char* text : {"predicate f(bounded scalar x, scalar y) { sign x * y + y as z }\n",
                           "predicate f(scalar x, y) { value x * y + y as z }\n"}) {
    const auto all = candidates(lowerings(text), Precision::binary64);
    EXPECT_TRUE(std::none_of(all.begin(), all.end(), [](const Candidate& c) { return c.scheme.float_first; })) << text;
  }
}

}  // namespace
}  // namespace tightrope::codegen::explore
