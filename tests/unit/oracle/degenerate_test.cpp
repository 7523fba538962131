/// Queries whose answer and first time of contact are known by hand, each with its reason.

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <optional>
#include <ostream>
#include <string>

#include "ccd/oracle/decision.h"
#include "ccd/oracle/oracle.h"
#include "static_contact.h"

namespace tightrope::ccd {
namespace {

using oracle::Contact;
using oracle::Defect;
using test::Points;

constexpr Kind vf = Kind::vertex_face, ee = Kind::edge_edge;
constexpr double eta = std::numeric_limits<double>::denorm_min();
constexpr double big = 0x1p1021, huge = 0x1p1000, tiny = 0x1p-1000, e50 = 0x1p-50;

struct Known {
  const char* name;
  Kind kind;
  Points points;  // v f0 f1 f2, resp. ea0 ea1 eb0 eb1, at t = 0, then at t = 1
  std::optional<Contact> first;
  const char* why;
};
void PrintTo(const Known& known, std::ostream* out) { *out << known.name << ": " << known.why; }

constexpr Contact at(double time) { return {time, time}; }
constexpr std::nullopt_t never = std::nullopt;

// clang-format off
const Known known_queries[] = {
  {"FallsThroughFace", vf, {1,1,1, 0,0,0, 4,0,0, 0,4,0,  1,1,-3, 0,0,0, 4,0,0, 0,4,0}, at(0.25), "z = 1 - 4t, inside"},
  {"FallsBesideFace", vf, {3,3,1, 0,0,0, 4,0,0, 0,4,0,  3,3,-3, 0,0,0, 4,0,0, 0,4,0}, never,
   "crosses the plane outside the triangle, inside its box"},
  {"FallsOnSide", vf, {2,2,1, 0,0,0, 4,0,0, 0,4,0,  2,2,-1, 0,0,0, 4,0,0, 0,4,0}, at(0.5), "the triangle is closed"},
  {"FallsOnCorner", vf, {4,0,1, 0,0,0, 4,0,0, 0,4,0,  4,0,-1, 0,0,0, 4,0,0, 0,4,0}, at(0.5), "the triangle is closed"},
  {"TouchesAtTheStartOnly", vf, {1,1,0, 0,0,0, 4,0,0, 0,4,0,  1,1,5, 0,0,0, 4,0,0, 0,4,0}, at(0), "z = 5t"},
  {"TouchesAtTheEndOnly", vf, {1,1,5, 0,0,0, 4,0,0, 0,4,0,  1,1,0, 0,0,0, 4,0,0, 0,4,0}, at(1), "z = 5 - 5t"},
  {"StopsShortOfTheFace", vf, {1,1,5, 0,0,0, 4,0,0, 0,4,0,  1,1,eta, 0,0,0, 4,0,0, 0,4,0}, never, "eta is left at t = 1"},
  {"NeverMovesAndTouches", vf, {1,1,0, 0,0,0, 4,0,0, 0,4,0,  1,1,0, 0,0,0, 4,0,0, 0,4,0}, at(0), "Y = 0 at all times"},
  {"NeverMovesBesideFace", vf, {3,3,0, 0,0,0, 4,0,0, 0,4,0,  3,3,0, 0,0,0, 4,0,0, 0,4,0}, never, "coplanar, outside"},
  {"TimeIsNoDouble", vf, {1,1,1, 0,0,0, 4,0,0, 0,4,0,  1,1,-2, 0,0,0, 4,0,0, 0,4,0},
   Contact{0x1.5555555555555p-2, 0x1.5555555555556p-2}, "z = 1 - 3t: t = 1/3"},
  {"TimeIsIrrational", vf, {1,0,-1, 0,0,0, 4,0,0, 0,4,0,  1,1,-1, 0,0,0, 4,0,0, 0,4,-8},
   Contact{0x1.6a09e667f3bccp-1, 0x1.6a09e667f3bcdp-1}, "z over the face = 2 t^2 - 1"},
  {"StartTouchingPublishedMiss", vf, {-1,1,0, 0,0,1, 1,0,0, -1,1,0,  -1,1,0, -1,-1,-1, 1,1,1, 0,-1,-1}, at(0),
   "v is f2 at t = 0; the published TightCCD says no"},

  // Height over the tilting face: (t - 1/2)^2 + h.
  {"DoubleRoot", vf, {1,0,0.25, 0,0,0, 4,0,0, 0,4,0,  1,1,-0.75, 0,0,0, 4,0,0, 0,4,-4}, at(0.5), "h = 0: touches, no crossing"},
  {"JustAboveADoubleRoot", vf, {1,0,0.25+e50, 0,0,0, 4,0,0, 0,4,0,  1,1,-0.75+e50, 0,0,0, 4,0,0, 0,4,-4}, never, "h = 2^-50"},
  {"JustBelowADoubleRoot", vf, {1,0,0.25-e50, 0,0,0, 4,0,0, 0,4,0,  1,1,-0.75-e50, 0,0,0, 4,0,0, 0,4,-4}, at(0.5-0x1p-25),
   "h = -2^-50: roots at 1/2 -+ 2^-25"},
  // With s = 1 - 2t, v = 0: f0 = (s,1,0), f1 = (0,s,1), f2 a combination; Y = s^3.
  {"TripleRootInside", vf, {0,0,0, 1,1,0, 0,1,1, -1,-2,0,  0,0,0, -1,1,0, 0,-1,1, 1,0,-2}, at(0.5),
   "f0 + f1 + f2 = 0 at s = 0: v is the centre"},
  {"TripleRootOutside", vf, {0,0,0, 1,1,0, 0,1,1, 2,3,2,  0,0,0, -1,1,0, 0,-1,1, -2,1,0}, never,
   "the face is (1,0), (0,1), (2,1) in the plane of v = (0,0) at s = 0"},
  {"FaceShrinksOntoVertex", vf, {0,0,0, 1,0,0, 0,1,0, 0,0,1,  0,0,0, -1,0,0, 0,-1,0, 0,0,-1}, at(0.5),
   "Y = s^3 and n = 0: all four points meet"},
  {"FaceShrinksAwayFromVertex", vf, {1,1,0, 2,0,0, 0,2,0, -2,-2,1,  1,1,0, -2,0,0, 0,-2,0, 2,2,-1}, at(0),
   "v is on a side at t = 0"},
  {"FaceCollapsesElsewhere", vf, {3,3,3, 5,1,0, 1,5,0, 1,1,0,  3,3,3, -5,-1,0, -1,-5,0, -1,-1,6}, never,
   "at t = 1/2 the face is the segment from 0 to (0,0,3), the vertex far from it, though Y = 0 and all weights are 0"},

  {"EntersFaceInItsPlane", vf, {-1,1,0, 0,0,0, 4,0,0, 0,4,0,  3,1,0, 0,0,0, 4,0,0, 0,4,0}, at(0.25), "Y = 0; x = 4t - 1"},
  {"PassesCornerInThePlane", vf, {3,-1,0, 0,0,0, 4,0,0, 0,4,0,  5,1,0, 0,0,0, 4,0,0, 0,4,0}, at(0.5), "Y = 0; only (4, 0)"},
  {"PassesBesideInThePlane", vf, {5,0,0, 0,0,0, 4,0,0, 0,4,0,  0,5,0, 0,0,0, 4,0,0, 0,4,0}, never, "Y = 0; x + y = 5"},
  {"FlatFaceHit", vf, {1,1,1, 0,0,0, 0,0,0, 2,2,0,  1,1,-1, 0,0,0, 0,0,0, 2,2,0}, at(0.5), "the face is a segment; n = 0"},
  {"FlatFaceMissed", vf, {1,0.5,1, 0,0,0, 0,0,0, 2,2,0,  1,0.5,-1, 0,0,0, 0,0,0, 2,2,0}, never, "beside that segment"},
  {"PointFaceHit", vf, {-1,-1,-1, 0,0,0, 0,0,0, 0,0,0,  3,3,3, 0,0,0, 0,0,0, 0,0,0}, at(0.25), "the face is a point"},
  {"PointFaceMissed", vf, {-1,-1,-1, 0,0,0, 0,0,0, 0,0,0,  3,3,3.5, 0,0,0, 0,0,0, 0,0,0}, never, "passes beside it"},
  {"AllOnOneLine", vf, {5,0,0, 0,0,0, 1,0,0, 2,0,0,  -1,0,0, 0,0,0, 1,0,0, 2,0,0}, at(0.5), "v at 5 - 6t reaches 2"},

  {"EdgesCross", ee, {-1,0,0, 1,0,0, 0,-1,1, 0,1,1,  -1,0,0, 1,0,0, 0,-1,-3, 0,1,-3}, at(0.25), "z = 1 - 4t"},
  {"EdgesCrossAtEndPoints", ee, {0,0,0, 1,0,0, 0,0,1, 0,1,1,  0,0,0, 1,0,0, 0,0,-1, 0,1,-1}, at(0.5), "ea0 meets eb0"},
  {"LinesCrossBesideTheEdges", ee, {0,0,0, 3,3,0, 2,1,1, 4,-1,1,  0,0,0, 3,3,0, 2,1,-1, 4,-1,-1}, never,
   "x + y = 3 meets x = y at 1.5, eb starts at x = 2"},
  {"ParallelEdgesMeet", ee, {0,0,0, 2,0,0, 1,1,0, 3,1,0,  0,0,0, 2,0,0, 1,-1,0, 3,-1,0}, at(0.5), "Y = 0; overlap [1, 2]"},
  {"ParallelEdgesMeetAtAPoint", ee, {0,0,0, 2,0,0, 2,1,0, 3,1,0,  0,0,0, 2,0,0, 2,-1,0, 3,-1,0}, at(0.5), "overlap {2}"},
  {"ParallelEdgesAlignWithAGap", ee, {0,0,0, 2,2,0, 1,5,0, 3,7,0,  0,0,0, 2,2,0, 5,1,0, 7,3,0}, never,
   "on one line at t = 1/2, (0,0)-(2,2) and (3,3)-(5,5); n = 0 there"},
  {"CollinearEdgesSlide", ee, {0,0,0, 1,0,0, 3,0,0, 4,0,0,  0,0,0, 1,0,0, -1,0,0, 0,0,0}, at(0.5), "eb0 = 3 - 4t"},
  {"EdgesCrossInThePlane", ee, {0,0,0, 4,0,0, 1,3,0, 2,1,0,  0,0,0, 4,0,0, 1,1,0, 2,-1,0}, at(0.5), "Y = 0; eb1 has y = 1 - 2t"},
  {"EdgesMissInThePlane", ee, {0,0,0, 4,4,0, 5,0,0, 6,1,0,  0,0,0, 4,4,0, 5,4.5,0, 9,5,0}, never, "Y = 0; eb stays right"},
  {"PointEdgeHit", ee, {0,0,0, 0,0,0, -1,0,1, 1,0,1,  0,0,0, 0,0,0, -1,0,-1, 1,0,-1}, at(0.5), "ea is a point"},
  {"PointEdgeMissed", ee, {0.5,-0.5,0, 0.5,-0.5,0, -1,-1,1, 1,1,1,  0.5,-0.5,0, 0.5,-0.5,0, -1,-1,-1, 1,1,-1}, never,
   "eb passes along x = y; n = 0 at all times"},
  {"SecondEdgeIsAPoint", ee, {-1,0,1, 1,0,1, 0,0,0, 0,0,0,  -1,0,-1, 1,0,-1, 0,0,0, 0,0,0}, at(0.5), "eb is a point; Y = 0"},
  {"TwoPointsMeet", ee, {0,0,0, 0,0,0, -1,-1,-1, -1,-1,-1,  0,0,0, 0,0,0, 1,1,1, 1,1,1}, at(0.5), "both edges are points"},
  {"TwoPointsMiss", ee, {0,0,0, 0,0,0, -1,-1,-1, -1,-1,-1,  0,0,0, 0,0,0, 1,1,1.5, 1,1,1.5}, never, "both edges are points"},
  {"EndPassesTheLineOfTheOther", ee, {0,0,0, 1,1,0, 2,2,1, 0,3,1,  0,0,0, 1,1,0, 2,2,-1, 0,3,-1}, never,
   "eb0 crosses the line of ea beyond ea1: n = 0 without contact"},

  {"TimeBelowEveryDouble", vf, {1,1,tiny, 0,0,0, 4,0,0, 0,4,0,  1,1,-huge, 0,0,0, 4,0,0, 0,4,0}, Contact{0, eta},
   "about 2^-2000"},
  {"Subnormal", vf, {eta,eta,eta, 0,0,0, 4*eta,0,0, 0,4*eta,0,  eta,eta,-3*eta, 0,0,0, 4*eta,0,0, 0,4*eta,0}, at(0.25),
   "FallsThroughFace times 2^-1074"},
  {"Enormous", vf, {big,big,big, 0,0,0, 4*big,0,0, 0,4*big,0,  big,big,-3*big, 0,0,0, 4*big,0,0, 0,4*big,0}, at(0.25),
   "FallsThroughFace times 2^1021; differences overflow doubles"},
  {"AllPointsAreZero", ee, {}, at(0), "everything coincides"},
};
// clang-format on

class OracleKnows : public ::testing::TestWithParam<Known> {};

TEST_P(OracleKnows, TheFirstContact) {
  const Known& known = GetParam();
  EXPECT_EQ(oracle::contact(known.kind, known.points), known.first.has_value());
  const std::optional<Contact> found = oracle::first_contact(known.kind, known.points);
  ASSERT_EQ(found.has_value(), known.first.has_value());
  if (!found) return;
  EXPECT_EQ(found->lower, known.first->lower);
  EXPECT_EQ(found->upper, known.first->upper);
}

INSTANTIATE_TEST_SUITE_P(ByHand, OracleKnows, ::testing::ValuesIn(known_queries),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(OracleWithADefect, GetsAKnownQueryWrong) {
  for (const Defect defect :
       {Defect::collapsed_never_touches, Defect::collapsed_always_touches, Defect::coplanar_motion_only_at_ends,
        Defect::open_features, Defect::sign_change_expected}) {
    int wrong = 0;
    for (const Known& known : known_queries) {
      wrong += oracle::contact(known.kind, known.points, defect) != known.first.has_value() ? 1 : 0;
    }
    EXPECT_GE(wrong, 2) << static_cast<int>(defect);
  }
}

}  // namespace
}  // namespace tightrope::ccd
