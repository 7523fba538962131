#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "codegen/charts/pareto.h"
#include "codegen/charts/text.h"
#include "codegen/charts/ticks.h"

namespace tightrope::charts {
namespace {

std::vector<std::string> labels_of(const std::vector<Tick>& ticks) {
  std::vector<std::string> labels;
  for (const Tick& tick : ticks) {
    if (!tick.label.empty()) labels.push_back(tick.label + (tick.exponent.empty() ? "" : "^" + tick.exponent));
  }
  return labels;
}

using Words = std::vector<std::string>;

TEST(Ticks, AreOneTwoAndFiveOnShortAxesAndPowersOfTenOnLongOnes) {
  EXPECT_EQ(labels_of(log_ticks(40, 900, 5)), (Words{"50", "100", "200", "500"}));
  EXPECT_EQ(labels_of(log_ticks(0.0015, 0.06, 7)), (Words{"0.002", "0.005", "0.01", "0.02", "0.05"}));
  EXPECT_EQ(labels_of(log_ticks(3e-6, 2e-2, 7)), (Words{"10^-5", "10^-4", "10^-3", "10^-2"}));
  EXPECT_EQ(labels_of(log_ticks(1e-5, 4e-5, 7)), (Words{"10^-5", "2·10^-5"}));
  EXPECT_EQ(labels_of(log_ticks(1e-40, 1e-10, 7)),
            (Words{"10^-40", "10^-35", "10^-30", "10^-25", "10^-20", "10^-15", "10^-10"}));
}

TEST(Ticks, LieWithinTheAxisAreAtLeastTwoAndNeverTooMany) {
  for (double low = 1e-300; low < 1e290; low *= 37) {
    for (const double ratio : {31.7, 1e3, 1e7, 1e19, 1e60}) {
      if (low * ratio > 1e295) break;
      const auto ticks = log_ticks(low, low * ratio, 6);
      const auto labels = labels_of(ticks);
      EXPECT_GE(labels.size(), 2U) << low << " " << ratio;
      EXPECT_LE(labels.size(), 7U) << low << " " << ratio;
      for (const Tick& tick : ticks) {
        EXPECT_GE(tick.value, low * (1 - 1e-9));
        EXPECT_LE(tick.value, low * ratio * (1 + 1e-9));
      }
    }
  }
}

TEST(Text, WidthsAreThoseOfDejaVuSans) {
  EXPECT_EQ(text_width("", 12), 0);
  EXPECT_NEAR(text_width("tight", 10), (393 + 278 + 635 + 634 + 393) / 100.0, 1e-9);
  EXPECT_EQ(text_width("é·×", 10), 30);  // three characters, not bytes
}

TEST(Text, BreaksAtSpaces) {
  EXPECT_EQ(wrapped("one two  three", text_width("one two", 12), 12), (Words{"one two", "three"}));
  EXPECT_EQ(wrapped("averyverylongword x", 20, 12), (Words{"averyverylongword", "x"}));
  EXPECT_TRUE(wrapped("", 100, 12).empty());
}

TEST(Text, PrintsNothingThatIsNoCharacter) {
  EXPECT_EQ(printable("a\nb\tc\x7F"), "a b c ");
  EXPECT_EQ(printable("caf\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80"), "caf\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80");
  // Cut short, a stray continuation, overlong, a surrogate, beyond Unicode, no character.
  EXPECT_EQ(printable("\xC3"), "?");
  EXPECT_EQ(printable("\x80z"), "?z");
  EXPECT_EQ(printable("\xC0\xAF"), "??");
  EXPECT_EQ(printable("\xE0\x80\xAF"), "???");
  EXPECT_EQ(printable("\xED\xA0\x80"), "???");
  EXPECT_EQ(printable("\xF4\x90\x80\x80"), "????");
  EXPECT_EQ(printable("\xEF\xBF\xBF"), "???");
  EXPECT_EQ(escaped("<a & \"b\">"), "&lt;a &amp; &quot;b&quot;&gt;");
}

/// The definition, one by one.
bool beaten(const std::vector<Cost>& costs, std::size_t i) {
  for (std::size_t j = 0; j < costs.size(); ++j) {
    const bool no_worse = costs[j].first <= costs[i].first && costs[j].second <= costs[i].second;
    const bool better = costs[j].first < costs[i].first || costs[j].second < costs[i].second;
    if (no_worse && (better || j < i)) return true;
  }
  return false;
}

TEST(Pareto, FrontIsWhatNoOtherBeats) {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<Cost> costs;
    for (std::uint64_t i = 0; i < 1 + random() % 12; ++i) {
      costs.push_back({static_cast<double>(random() % 6), static_cast<double>(random() % 6)});
    }
    const auto front = pareto_front(costs);
    for (std::size_t i = 0; i < costs.size(); ++i) {
      EXPECT_EQ(std::count(front.begin(), front.end(), i), beaten(costs, i) ? 0 : 1);
    }
    for (std::size_t k = 1; k < front.size(); ++k) EXPECT_LT(costs[front[k - 1]].first, costs[front[k]].first);
  }
  EXPECT_TRUE(pareto_front({}).empty());
}

}  // namespace
}  // namespace tightrope::charts
