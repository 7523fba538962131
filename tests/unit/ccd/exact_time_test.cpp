/// The exact stage against the oracle, which shares no code with it: whether there is contact, and the time of the
/// first, to the last bit; in every degenerate family, at every scale, for all four pairs.

#include "ccd/impact/exact_time.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "contacts.h"
#include "oracle/contact_time.h"
#include "oracle/oracle.h"
#include "scenes/scene.h"
#include "tests/stability/query_folder.h"
#include "tests/stability/show_query.h"
#include "tests/unit/oracle/queries.h"

namespace tightrope::ccd {
namespace {

using oracle::Contact;
using test::ContactGenerator;
using test::Query;
using test::Random;

constexpr double least = std::numeric_limits<double>::denorm_min();

/// A query of fewer points as one of four that touches at the same times: the last point of each feature repeated.
Query with_four_points(Pair pair, const Query& points) {
  if (pair == Pair::vertex_face || pair == Pair::edge_edge) return points;
  const std::size_t count = pair == Pair::vertex_edge ? 3 : 2;
  const std::array<std::size_t, 4> from =
      pair == Pair::vertex_edge ? std::array<std::size_t, 4>{0, 1, 2, 2} : std::array<std::size_t, 4>{0, 0, 1, 1};
  Query query;
  for (std::size_t i = 0; i < 24; ++i) query[i] = points[3 * (from[i / 3 % 4] + i / 12 * count) + i % 3];
  return query;
}
Kind kind_of_four_points(Pair pair) {
  return pair == Pair::vertex_vertex || pair == Pair::edge_edge ? Kind::edge_edge : Kind::vertex_face;
}

/// How an answer about times up to 1 contradicts the exact time, if it does.
const char* contradiction(const std::optional<TimeBracket>& found, const std::optional<Contact>& truth,
                          double tolerance) {
  if (found.has_value() != truth.has_value()) return found ? "false contact" : "missed contact";
  if (!found) return nullptr;
  if (found->lower > truth->lower) return "late";
  if (found->upper < truth->upper) return "upper end too early";
  if (found->lower == 0 && truth->lower > 0) return "zero";
  const bool finest = found->lower == truth->lower && found->upper == truth->upper;
  return finest || found->upper - found->lower <= tolerance ? nullptr : "wide";
}

struct Tally {
  int contacts = 0, at_doubles = 0, free = 0;
};

void check(Pair pair, const Query& points, Tally& tally) {
  const std::optional<Contact> truth = oracle::first_contact(kind_of_four_points(pair), with_four_points(pair, points));
  const auto show = [&] { return show_query(points.data()); };
  ASSERT_EQ(exact_contact(pair, points.data()), truth.has_value()) << show();
  for (const double tolerance : {0.0, 1e-12, 1e-6, 0.5, 1.0}) {
    const auto found = exact_first_contact(pair, points.data(), tolerance, 1);
    ASSERT_STREQ(contradiction(found, truth, tolerance), nullptr) << tolerance << '\n' << show();
  }
  ++(truth ? tally.contacts : tally.free);
  if (!truth) return;
  const auto before = [&](double t_max) { return exact_first_contact(pair, points.data(), 0, t_max); };
  const bool exact = truth->lower == truth->upper;
  tally.at_doubles += exact ? 1 : 0;
  ASSERT_STREQ(contradiction(before(truth->upper), truth, 0), nullptr) << show();
  ASSERT_EQ(before(truth->lower).has_value(), exact) << show();
  ASSERT_FALSE(before(std::nextafter(truth->lower, -1))) << show();
}

/// Asked about one crossing that it encloses.
void check_sharpening(Kind kind, const Query& points, const Contact& truth) {
  const double lower = std::max(truth.lower - 1e-9, truth.lower / 2), upper = std::min(truth.upper + 1e-9, 1.0);
  for (const double tolerance : {0.0, 1e-12, 1e-3}) {
    const TimeBracket found = sharpened(kind, points.data(), {lower, upper}, tolerance);
    ASSERT_STREQ(contradiction(found, truth, tolerance), nullptr) << show_query(points.data());
  }
}

TEST(ExactTime, AgreesWithTheOracleOnEveryScene) {
  constexpr std::size_t count = 50;
  for (const SceneInfo& info : scenes()) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      std::vector<double> points(24 * count);
      generate(info.scene, kind, count, 71)->fill(points);
      Tally tally;
      for (std::size_t i = 0; i < count; ++i) {
        Query query;
        std::copy_n(points.data() + 24 * i, 24, query.begin());
        ASSERT_NO_FATAL_FAILURE(check(pair_of(kind), query, tally)) << info.name;
      }
    }
  }
}

TEST(ExactTime, AgreesWithTheOracleOnHardContacts) {
  Tally tally;
  for (const QueryBlock& block : queries_below(TIGHTROPE_SOURCE_DIR "/tests/data/hard")) {
    for (std::size_t i = 0; i < block.size(); ++i) {
      Query query;
      std::copy_n(block.points.data() + 24 * i, 24, query.begin());
      ASSERT_NO_FATAL_FAILURE(check(pair_of(block.kind), query, tally));
    }
  }
  EXPECT_EQ(tally.contacts, 166);
}

TEST(ExactTime, AgreesWithTheOracleOnContactsAndOneUlpBeside) {
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    ContactGenerator generator(72);
    Tally tally;
    for (int i = 0; i < 1'000; ++i) {
      Query query = generator.contact(kind);
      ASSERT_NO_FATAL_FAILURE(check(pair_of(kind), query, tally));
      double& x = query[static_cast<std::size_t>(generator.random().whole(0, 23))];
      x = std::nextafter(x, generator.random().chance(50) ? 1e9 : -1e9);
      ASSERT_NO_FATAL_FAILURE(check(pair_of(kind), query, tally));
    }
    EXPECT_GT(tally.contacts, 1'000);
    EXPECT_GT(tally.at_doubles, 300);
    EXPECT_GT(tally.free, 50);
  }
}

/// Coplanar and collinear motion, coincident points, parallel edges: families of small integers.
TEST(ExactTime, AgreesWithTheOracleOnLattices) {
  test::QueryMaker random(73);
  for (int i = 0; i < 3'000; ++i) {
    const Query query = random.make(i % test::QueryMaker::families);
    Tally tally;
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      ASSERT_NO_FATAL_FAILURE(check(pair_of(kind), query, tally)) << i % test::QueryMaker::families;
    }
  }
}

/// Scaled by a power of two nothing changes; only what is below the smallest number is lost.
TEST(ExactTime, IsTheSameAtEveryScale) {
  ContactGenerator generator(74);
  for (int i = 0; i < 300; ++i) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      const Query query = generator.contact(kind);
      const auto time = exact_first_contact(pair_of(kind), query.data(), 0, 1);
      ASSERT_TRUE(time);
      for (const int exponent : {-900, -300, 300, 900}) {
        Query scaled = query;
        for (double& x : scaled) x = std::ldexp(x, exponent);
        const auto found = exact_first_contact(pair_of(kind), scaled.data(), 0, 1);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->lower, time->lower);
        EXPECT_EQ(found->upper, time->upper);
      }
    }
  }
}

TEST(ExactTime, AgreesWithTheOracleAtTheEndsOfTheRange) {
  Tally tally;
  test::QueryMaker random(75);
  Random choice(75);
  for (int i = 0; i < 400; ++i) {
    Query query = random.make(i % test::QueryMaker::families);
    const int family = i / 9 % 4;
    for (double& x : query) {
      if (family == 0) x *= least;                                    // subnormal
      if (family == 1) x *= 0x1p1020;                                 // differences overflow
      if (family == 2) x = std::ldexp(x, choice.whole(-2, 2) * 500);  // both
      if (family == 3) x += choice.chance(30) ? choice.whole(-3, 3) * least : 0;
    }
    ASSERT_NO_FATAL_FAILURE(check(Pair::vertex_face, query, tally));
    ASSERT_NO_FATAL_FAILURE(check(Pair::edge_edge, query, tally));
  }
  EXPECT_GT(tally.contacts, 200);
  EXPECT_GT(tally.free, 100);
}

/// A vertex that falls from height `from` to `to` on a resting triangle, which it meets inside.
Query falling(double from, double to) {
  return {1, 1, from, 0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, to, 0, 0, 0, 4, 0, 0, 0, 4, 0};
}

TEST(ExactTime, TinyTimesAreNotZero) {
  Tally tally;
  for (const double height : {1e-300, 1e-308, 0x1p-1073, least, 3 * least, 1e-17, 1e-100}) {
    for (const double depth : {1.0, 3.0, 1e-10, 1e10, 1e300}) {
      const Query query = falling(height, -depth);
      ASSERT_NO_FATAL_FAILURE(check(Pair::vertex_face, query, tally));
      const auto truth = oracle::first_contact(Kind::vertex_face, query);
      ASSERT_NO_FATAL_FAILURE(check_sharpening(Kind::vertex_face, query, *truth));
    }
  }
}

/// Face and vertex move at random, the vertex from above to below; Y falls all the time.
TEST(ExactTime, OfSharpenedCrossings) {
  Random random(76);
  int crossings = 0;
  for (int i = 0; i < 300; ++i) {
    Query query = falling(1, -random.unit());
    for (double& x : query) x += (random.unit() - 0.5) / 4;
    const auto truth = oracle::first_contact(Kind::vertex_face, query);
    if (!truth) continue;
    ++crossings;
    ASSERT_NO_FATAL_FAILURE(check_sharpening(Kind::vertex_face, query, *truth));
  }
  EXPECT_GT(crossings, 200);
}

/// The vertex is (3 t - 1)^2 - e above the plane of a face that tilts, and `from` to `to` beside the face's side y = 0.
Query dipping(double e, double from, double to) {
  return {0, from, 1 - e, 0, 0, 0, 4, 0, 24, 0, 4, 0, 1, to, 1 - e, 0, 0, 0, 4, 0, -12, 0, 4, 0};
}
/// The same by 1 lower, so that every e is exact.
Query dipping_exactly(double e, double from, double to) {
  Query query = dipping(0, from, to);
  for (std::size_t i = 2; i < 24; i += 3) query[i] -= 1;
  query[2] = query[14] = -e;
  return query;
}

/// Two roots at 1/3 -+ sqrt(e) / 3, between two neighbouring doubles if e is small; the vertex may enter the face
/// between them.
TEST(ExactTime, RootsCloserTogetherThanDoublesAreToldApart) {
  Tally tally;
  for (const double e : {0.0, 0x1p-50, 0x1p-100, 0x1p-120, 0x1p-300, 0x1p-900, 0x1p-1074, -0x1p-100, -0x1p-300}) {
    for (const double size : {1.0, 0x1p-100, 0x1p-1000}) {
      for (const auto& [from, to] : {std::array{1.0, 1.0}, {0.0, 0.0}, {-1.0, -1.0}, {-1.0, 2.0}, {1.0, -2.0}}) {
        const Query query = dipping_exactly(e, from * size, to * size);
        ASSERT_NO_FATAL_FAILURE(check(Pair::vertex_face, query, tally)) << e << ' ' << from << ' ' << to;
      }
    }
  }
  EXPECT_GT(tally.contacts, 70);
  EXPECT_GT(tally.free, 40);
}

/// One root of Y a short number, another a few units in the last place away: an enclosure of the one may end at the
/// other. Three such queries once had a wrong answer: a miss, a contact that is none, a time too early.
TEST(ExactTime, RootsBesideShortNumbersAreToldApart) {
  const double e = 5 * 0x1p51;
  const Query defects[] = {
      {-1,
       0,
       0,
       -1,
       -0x1p21,
       -5,
       0x1.ffffep19,
       0x1p21,
       0,
       -0x1.4p53,
       0x1.ffff5cp20,
       5,
       0,
       0,
       0,
       0,
       -0x1p20,
       3,
       0x1p20,
       0x1p20,
       0,
       0x1.8000000000001p52,
       0x1.fffeb8p19,
       -3},
      {e - 30, 1, -5, -15, 0, 0, -e, 1, 0, -15, 2, 0, -3 * 0x1p51 - 15, 1, 3, 0, 0, 0, 3 * 0x1p51 + 15, 1, 0, 0, 2, 0},
      {-15, 1, -5, -15, 0, 0, -e, 1, 0, -15, 2, 0, 0, 1, 3, 0, 0, 0, 3 * 0x1p51 + 15, 1, 0, 0, 2, 0}};
  Tally tally;
  for (const Query& query : defects) ASSERT_NO_FATAL_FAILURE(check(Pair::vertex_face, query, tally));
  EXPECT_EQ(tally.contacts, 2);
  Random random(9);
  for (int i = 0; i < 6000; ++i) {
    const int bits = random.whole(1, 4);
    const double root = random.whole(1, (1 << bits) - 1), rest = (1 << bits) - root, large = std::ldexp(1.0, 54 - bits);
    Query query;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t point = 0; point < 4; ++point) {
        double &from = query[3 * point + axis], &to = query[12 + 3 * point + axis];
        switch (random.whole(0, 3)) {
          case 0:
            from = random.whole(-3, 3);
            to = random.chance(50) ? from : random.whole(-3, 3);
            break;
          case 1: {  // zero at the root, about, from far away
            const double sign = random.chance(50) ? 1 : -1;
            from = -sign * root * large + (random.chance(50) ? 0 : random.whole(-30, 30));
            to = sign * rest * large + (random.chance(50) ? 0 : random.whole(-30, 30));
            break;
          }
          case 2: {  // zero at the root
            const int factor = random.whole(-3, 3);
            from = -factor * root;
            to = factor * rest;
            break;
          }
          case 3:
            from = random.whole(-20, 20);
            to = random.chance(50) ? from : random.whole(-20, 20);
            break;
        }
      }
    }
    const Pair pair = i % 2 == 0 ? Pair::vertex_face : Pair::edge_edge;
    ASSERT_NO_FATAL_FAILURE(check(pair, query, tally)) << i;
  }
  EXPECT_GT(tally.contacts, 300);
}

/// What the tests above would notice: rounding to nearest, a later root, a tolerance counted upwards.
TEST(ExactTime, DefectsAreNoticed) {
  ContactGenerator generator(78);
  int nearest = 0, last = 0, upwards = 0;
  for (int i = 0; i < 500; ++i) {
    const Query query = generator.contact(Kind::edge_edge);
    Query reversed;
    std::copy_n(query.begin(), 12, std::copy_n(query.begin() + 12, 12, reversed.begin()));
    const auto truth = oracle::first_contact(Kind::edge_edge, query);
    const auto exact = oracle::first_contact(Kind::edge_edge, query, mpq_class(1, mpz_class(1) << 200));
    const mpq_class lower(truth->lower), upper(truth->upper);
    const double rounded = exact->lower - lower < upper - exact->lower ? truth->lower : truth->upper;
    nearest += contradiction(TimeBracket{rounded, truth->upper}, truth, 0) != nullptr ? 1 : 0;
    const auto later = exact_first_contact(Pair::edge_edge, reversed.data(), 0, 1);
    last += contradiction(TimeBracket{1 - later->upper, 1 - later->lower}, truth, 1e-6) != nullptr ? 1 : 0;
    upwards += contradiction(TimeBracket{truth->lower + 1e-6, truth->upper + 1e-6}, truth, 1e-6) != nullptr ? 1 : 0;
  }
  EXPECT_GT(nearest, 10);
  EXPECT_GT(last, 100);
  EXPECT_EQ(upwards, 500);
}

/// Vertex-edge: against a triangle without area; vertex-vertex: against edges without length. Lattices have all
/// coincidences; moved by an ulp they are near contacts.
TEST(ExactTime, OfVertexEdgeAndVertexVertexAgreesWithTheOracle) {
  for (const Pair pair : {Pair::vertex_edge, Pair::vertex_vertex}) {
    Random random(77);
    Tally tally;
    for (int i = 0; i < 8'000; ++i) {
      Query points{};
      const std::size_t count = pair == Pair::vertex_edge ? 18 : 12;
      const int size = random.whole(1, 3), flat = random.whole(0, 4);
      for (std::size_t j = 0; j < count; ++j) {
        points[j] = random.whole(-size, size);
        if (flat >= 2 && j % 3 == 2) points[j] = 1;
        if (flat == 4 && j % 3 == 1) points[j] = points[j - 1];
      }
      if (i % 4 == 0) points[static_cast<std::size_t>(random.whole(0, 11))] *= 1 + 0x1p-52;
      if (i % 16 == 1) points[static_cast<std::size_t>(random.whole(0, 11))] += least;
      ASSERT_NO_FATAL_FAILURE(check(pair, points, tally)) << i;
    }
    EXPECT_GT(tally.contacts, 500);
    EXPECT_GT(tally.free, 500);
    EXPECT_LT(tally.at_doubles, tally.contacts);
  }
}

TEST(ExactTime, TimesOutsideTheStepCount) {
  const Query query = falling(1, -1);
  EXPECT_FALSE(exact_first_contact(Pair::vertex_face, query.data(), 0, -1));
  EXPECT_FALSE(exact_first_contact(Pair::vertex_face, query.data(), 0, 0));
  EXPECT_TRUE(exact_first_contact(Pair::vertex_face, query.data(), 0, 2));
  EXPECT_TRUE(exact_first_contact(Pair::vertex_face, query.data(), 0, std::nan("")));
  EXPECT_TRUE(exact_first_contact(Pair::vertex_face, falling(0, -1).data(), 0, 0));
}

}  // namespace
}  // namespace tightrope::ccd
