#include "codegen/charts/labels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tightrope::charts {
namespace {

constexpr Box frame{50, 20, 750, 320};

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * std::ldexp(static_cast<double>(random() >> 11), -53);
}

/// Markers in a cluster of this size, the labels 40 to 130 pixels wide.
std::vector<LabelRequest> cluster(int n, double size, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<LabelRequest> requests;
  for (int i = 0; i < n; ++i) {
    const Place marker{400 + uniform(random, -size, size) / 2, 170 + uniform(random, -size, size) / 5};
    requests.push_back({marker, 6, uniform(random, 40, 130), 14});
  }
  return requests;
}

std::vector<Box> markers_of(const std::vector<LabelRequest>& requests) {
  std::vector<Box> boxes;
  for (const LabelRequest& r : requests) boxes.push_back(box_around(r.marker, 2 * r.radius, 2 * r.radius));
  return boxes;
}

struct Conflicts {
  int overlaps = 0;  ///< of labels with each other, with markers, with the frame
  int leaders = 0;   ///< through labels
};

Conflicts conflicts(const std::vector<LabelPlace>& places, const std::vector<Box>& markers, const Box& around = frame) {
  Conflicts count;
  for (std::size_t a = 0; a < places.size(); ++a) {
    if (!places[a].placed) continue;
    if (!around.contains(places[a].box)) ++count.overlaps;
    for (const Box& marker : markers) count.overlaps += overlap(places[a].box, marker) ? 1 : 0;
    for (std::size_t b = 0; b < places.size(); ++b) {
      if (a == b || !places[b].placed) continue;
      if (b < a && overlap(places[a].box, places[b].box)) ++count.overlaps;
      if (places[a].has_leader && meets(places[a].leader, places[b].box)) ++count.leaders;
    }
  }
  return count;
}

TEST(Labels, NeverOverlapNorCoverMarkersHoweverCloseTheMarkers) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    for (const double size : {0.0, 20.0, 120.0, 600.0}) {
      const auto requests = cluster(14, size, seed);
      const auto markers = markers_of(requests);
      const auto places = place_labels(requests, frame, markers, {});
      ASSERT_EQ(places.size(), requests.size());
      const Conflicts found = conflicts(places, markers);
      EXPECT_EQ(found.overlaps, 0) << "seed " << seed << ", size " << size;
      EXPECT_LE(found.leaders, size > 100 ? 0 : 14) << "seed " << seed << ", size " << size;
      for (const LabelPlace& place : places) EXPECT_TRUE(place.placed) << "seed " << seed << ", size " << size;
    }
  }
}

/// What the test above would say of labels that all stand to the right of their markers.
TEST(Labels, AllToTheRightOverlap) {
  const auto requests = cluster(14, 120, 1);
  std::vector<LabelPlace> places;
  for (const LabelRequest& r : requests) {
    const Place centre{r.marker.x + r.radius + r.width / 2, r.marker.y};
    places.push_back({.placed = true, .box = box_around(centre, r.width, r.height), .has_leader = false, .leader = {}});
  }
  EXPECT_GT(conflicts(places, markers_of(requests)).overlaps, 5);
}

TEST(Labels, LoneMarkersGetTheirLabelsToTheRightWithoutLeader) {
  const std::vector<LabelRequest> requests = {{{100, 100}, 6, 50, 14}, {{400, 200}, 6, 50, 14}};
  const auto places = place_labels(requests, frame, markers_of(requests), {});
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_FALSE(places[i].has_leader);
    EXPECT_GT(places[i].box.left, requests[i].marker.x + 6);
    EXPECT_LT(places[i].box.left, requests[i].marker.x + 12);
    EXPECT_NEAR(places[i].box.centre().y, requests[i].marker.y, 1e-9);
  }
}

TEST(Labels, AvoidLines) {
  const std::vector<LabelRequest> requests = {{{400, 170}, 6, 60, 14}};
  const std::vector<Segment> lines = {{{400, 170}, {700, 170}}};
  const auto places = place_labels(requests, frame, markers_of(requests), lines);
  EXPECT_FALSE(meets(lines[0], places[0].box));
}

TEST(Labels, AreLeftOutWhereThereIsNoRoomRatherThanOverlap) {
  const Box small{0, 0, 120, 40};
  std::vector<LabelRequest> requests;
  for (int i = 0; i < 6; ++i) requests.push_back({{10.0 + 20 * i, 20}, 6, 80, 14});
  const auto markers = markers_of(requests);
  const auto places = place_labels(requests, small, markers, {});
  EXPECT_EQ(conflicts(places, markers, small).overlaps, 0);
  int placed = 0;
  for (const LabelPlace& place : places) placed += place.placed ? 1 : 0;
  EXPECT_LT(placed, 6);
}

TEST(Labels, AreTheSameEveryTime) {
  const auto requests = cluster(14, 60, 3);
  const auto markers = markers_of(requests);
  const auto a = place_labels(requests, frame, markers, {});
  const auto b = place_labels(requests, frame, markers, {});
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].box.left, b[i].box.left);
    EXPECT_EQ(a[i].box.top, b[i].box.top);
  }
}

TEST(Geometry, SegmentsMeetBoxesWhereTheyPassThroughTheInside) {
  const Box box{0, 0, 10, 10};
  EXPECT_TRUE(meets({{-5, 5}, {15, 5}}, box));
  EXPECT_TRUE(meets({{5, 5}, {5, 5.5}}, box));
  EXPECT_TRUE(meets({{-1, 8}, {3, 12}}, box));
  EXPECT_FALSE(meets({{-1, 10}, {1, 12}}, box));
  EXPECT_FALSE(meets({{-5, 0}, {15, 0}}, box));
  EXPECT_FALSE(meets({{11, -5}, {11, 15}}, box));
  EXPECT_FALSE(meets({{-5, 5}, {0, 5}}, box));
}

}  // namespace
}  // namespace tightrope::charts
