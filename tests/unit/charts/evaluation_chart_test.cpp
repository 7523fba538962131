#include <gtest/gtest.h>

#include <algorithm>

#include "codegen/charts/layout.h"
#include "tests/unit/charts/boxes.h"
#include "tests/unit/charts/evaluation_rows.h"

namespace tightrope::ccd {
namespace {

using charts::Chart;
using charts::Datum;
using charts::Panel;
using charts::Series;

const std::vector<Precision> both = {Precision::in_double, Precision::in_float};

/// The marker of a method in a precision; there is exactly one.
const Datum& marker(const Panel& panel, Method method, Precision precision) {
  const std::string wanted = std::string(name(method)) + ", " + std::string(name(precision));
  const Datum* found = nullptr;
  for (const Series& series : panel.series) {
    if (!series.markers || series.name != wanted) continue;
    EXPECT_EQ(found, nullptr) << wanted << " twice";
    EXPECT_EQ(series.data.size(), 1U);
    found = &series.data.front();
  }
  if (found == nullptr) throw std::logic_error("no marker of " + wanted);
  return *found;
}

bool conservative(Method method) {
  for (const MethodInfo& info : methods()) {
    if (info.method == method) return info.conservative;
  }
  return false;
}

/// Whether the front of all conservative rows of this kind and precision has it, by the definition.
bool belongs_to_front(const std::vector<EvaluationRow>& rows, const EvaluationRow& row) {
  const auto is_candidate = [&](const EvaluationRow& r) {
    return r.kind == row.kind && r.precision == row.precision && conservative(r.method) &&
           r.mistakes->false_negatives == 0;
  };
  if (!is_candidate(row)) return false;
  return std::none_of(rows.begin(), rows.end(), [&](const EvaluationRow& r) {
    const bool no_worse =
        r.ns_per_query <= row.ns_per_query && r.mistakes->false_positives <= row.mistakes->false_positives;
    const bool better =
        r.ns_per_query < row.ns_per_query || r.mistakes->false_positives < row.mistakes->false_positives;
    return is_candidate(r) && no_worse && (better || &r < &row);
  });
}

TEST(EvaluationChart, HasEveryRowWhereItBelongsAndTheFrontAround) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto rows = random_rows(seed, both);
    const Chart chart = evaluation_chart(rows, "here");
    ASSERT_EQ(chart.panels.size(), 2U);
    for (const EvaluationRow& row : rows) {
      const Panel& panel = chart.panels[row.kind == Kind::vertex_face ? 0 : 1];
      const Datum& datum = marker(panel, row.method, row.precision);
      EXPECT_EQ(datum.x, row.ns_per_query);
      EXPECT_EQ(datum.y, static_cast<double>(row.mistakes->false_positives) / 2500);
      EXPECT_EQ(!datum.alarm.empty(), row.mistakes->false_negatives > 0);
      EXPECT_EQ(datum.ring, belongs_to_front(rows, row)) << name(row.method) << ", seed " << seed;
    }
  }
}

TEST(EvaluationChart, AMethodThatMissesIsCrossedOutAndNotOnTheFrontWhateverItPromises) {
  std::vector<EvaluationRow> rows = {
      row_of(Method::tight, Kind::vertex_face, Precision::in_double, 100, 5, 0),
      row_of(Method::bsc_exact, Kind::vertex_face, Precision::in_double, 90, 0, 0),
  };
  EXPECT_TRUE(marker(evaluation_chart(rows, "").panels[0], Method::bsc_exact, Precision::in_double).ring);
  rows[1].mistakes->false_negatives = 1234;
  const Chart chart = evaluation_chart(rows, "");
  const Datum& wrong = marker(chart.panels[0], Method::bsc_exact, Precision::in_double);
  EXPECT_EQ(wrong.alarm, "1,234 missed");
  EXPECT_FALSE(wrong.ring);
  EXPECT_TRUE(marker(chart.panels[0], Method::tight, Precision::in_double).ring);
}

TEST(EvaluationChart, WithoutConservativeMethodsThereIsNoFront) {
  const std::vector<EvaluationRow> rows = {row_of(Method::bsc_float, Kind::edge_edge, Precision::in_double, 10, 0, 3)};
  const Chart chart = evaluation_chart(rows, "");
  ASSERT_EQ(chart.legend.size(), 1U);
  EXPECT_TRUE(chart.legend[0].alarm);
}

TEST(EvaluationChart, StairsJoinTheFrontAndNothingElse) {
  const std::vector<EvaluationRow> rows = {
      row_of(Method::bsc_float, Kind::edge_edge, Precision::in_double, 10, 0, 3),
      row_of(Method::bsc_safe, Kind::edge_edge, Precision::in_double, 50, 20, 0),
      row_of(Method::tight, Kind::edge_edge, Precision::in_double, 60, 10, 0),
      row_of(Method::safe, Kind::edge_edge, Precision::in_double, 70, 15, 0),
      row_of(Method::bsc_exact, Kind::edge_edge, Precision::in_double, 500, 0, 0),
  };
  const Chart chart = evaluation_chart(rows, "");
  ASSERT_EQ(chart.panels.size(), 1U);
  const Series& stairs = chart.panels[0].series.front();
  EXPECT_FALSE(stairs.markers);
  std::vector<std::pair<double, double>> corners;
  for (const Datum& datum : stairs.data) corners.emplace_back(datum.x, datum.y * 2500);
  const std::vector<std::pair<double, double>> expected = {{50, 20}, {60, 20}, {60, 10}, {500, 10}, {500, 0}};
  ASSERT_EQ(corners.size(), expected.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    EXPECT_EQ(corners[i].first, expected[i].first);
    EXPECT_NEAR(corners[i].second, expected[i].second, 1e-9);
  }
}

TEST(EvaluationChart, MarkersOfMethodsDifferInColourAndInShape) {
  const Chart chart = evaluation_chart(random_rows(1, {Precision::in_double}), "");
  std::vector<charts::Style> styles;
  for (const Series& series : chart.panels[0].series) {
    if (!series.markers) continue;
    for (const charts::Style& other : styles) {
      EXPECT_NE(other.colour, series.style.colour);
      EXPECT_NE(other.shape, series.style.shape);
    }
    styles.push_back(series.style);
  }
  EXPECT_EQ(styles.size(), methods().size());
}

TEST(EvaluationChart, LabelsDoNotOverlapAndZerosHaveABandOfTheirOwn) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const auto precisions = seed % 2 == 0 ? both : std::vector<Precision>{Precision::in_double};
    const Chart chart = evaluation_chart(random_rows(seed, precisions), "cloth-fold.h5");
    const charts::Layout layout = charts::layout(chart);
    EXPECT_EQ(charts::overlapping(layout.texts), "") << "seed " << seed;
    EXPECT_EQ(charts::misplaced(layout), "") << "seed " << seed;
    EXPECT_EQ(layout.labels_left_out, 0) << "seed " << seed;
    for (std::size_t p = 0; p < layout.panels.size(); ++p) {
      const charts::PanelLayout& panel = layout.panels[p];
      ASSERT_TRUE(panel.zero_band);
      for (const charts::DatumPlace& place : panel.data) {
        const Datum& datum = chart.panels[p].series[place.series].data[place.datum];
        EXPECT_EQ(datum.y == 0, place.place.y > panel.zero_band->top);
        EXPECT_TRUE(panel.frame.contains(charts::box_around(place.place, 12, 12)));
      }
      EXPECT_EQ(panel.y_ticks.back().label, "0");
    }
  }
}

/// All in one place, all zero, one method only, no query without contact.
TEST(EvaluationChart, ExtremeSetsHaveCharts) {
  std::vector<EvaluationRow> same;
  for (const MethodInfo& info : methods()) {
    for (const Precision precision : both) same.push_back(row_of(info.method, Kind::vertex_face, precision, 80, 0, 0));
  }
  std::vector<EvaluationRow> one = {row_of(Method::tight, Kind::edge_edge, Precision::in_float, 1e-3, 2500, 0)};
  std::vector<EvaluationRow> all_collide = one;
  all_collide[0].mistakes = Mistakes{3000, 0, 0};
  for (const auto& rows : {same, one, all_collide}) {
    const Chart chart = evaluation_chart(rows, "x");
    const charts::Layout layout = charts::layout(chart);
    EXPECT_EQ(charts::overlapping(layout.texts), "");
    EXPECT_EQ(charts::misplaced(layout), "");
    EXPECT_EQ(layout.labels_left_out, 0);
  }
  EXPECT_EQ(false_positive_rate(all_collide[0]), 0);
  EXPECT_EQ(false_positive_rate(one[0]), 1);
}

TEST(EvaluationChart, SaysHowManyQueriesAndWhatIsWhat) {
  const Chart chart = evaluation_chart(random_rows(2, both), "sample-queries");
  EXPECT_EQ(chart.title, "Speed against accuracy: 6,000 collision queries");
  EXPECT_EQ(chart.subtitle, "sample-queries");
  EXPECT_EQ(chart.panels[1].title, "edge-edge: 3,000 queries, 500 in contact");
  EXPECT_NE(chart.caption.find("conservative methods"), chart.caption.find("Conservative methods"));
  EXPECT_NE(chart.caption.find("red cross"), std::string::npos);
}

}  // namespace
}  // namespace tightrope::ccd
