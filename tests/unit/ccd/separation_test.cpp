/// Minimum separation, against exact distances: never late, no promise broken, nothing missed; and a search that trusts
/// unbounded floating point is caught.

#include "ccd/impact/separation.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "ccd/impact/separation_search.h"
#include "contacts.h"
#include "exact_distance.h"
#include "oracle/oracle.h"
#include "scenes/scene.h"
#include "separation.float.double.h"
#include "separation.tight.double.h"

namespace tightrope::ccd {
namespace {

using test::Query;
using test::Random;
using test::square_distance;

constexpr std::array<Pair, 4> pairs{Pair::vertex_vertex, Pair::vertex_edge, Pair::vertex_face, Pair::edge_edge};

std::string show(Pair pair, const double* points, double separation) {
  std::string text = "pair " + std::to_string(static_cast<int>(pair)) + ", separation ";
  char buffer[40];
  const auto append = [&](double x) {
    std::snprintf(buffer, sizeof buffer, "%a ", x);
    text += buffer;
  };
  append(separation);
  for (std::size_t i = 0; i < 6 * number_of_points(pair); ++i) {
    if (i % 3 == 0) text += '\n';
    append(points[i]);
  }
  return text;
}

mpq_class square(const mpq_class& x) { return x * x; }

/// The largest difference between two points in a coordinate, at the ends.
double extent(Pair pair, const double* points) {
  const std::size_t count = number_of_points(pair);
  double largest = 0;
  for (std::size_t i = 0; i < 2 * count; ++i) {
    for (std::size_t j = i / count * count; j < i; ++j) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        largest = std::max(largest, std::fabs(points[3 * i + axis] - points[3 * j + axis]));
      }
    }
  }
  return largest;
}

/// About where the features are nearest to each other: a scan, then narrowed. For moderate coordinates.
double nearest_time(Pair pair, const double* points) {
  const Approach<bound::tight> approach(pair, points, 0);
  const auto distance = [&](double t) { return best_plane(pair, approach.positions_at(t)).distance; };
  double best = 0, step = 0x1p-6;
  for (double t = 0; t <= 1; t += step) best = distance(t) < distance(best) ? t : best;
  for (; step > 0x1p-40; step /= 2) {
    for (const double t : {best - step, best + step}) {
      if (t >= 0 && t <= 1 && distance(t) < distance(best)) best = t;
    }
  }
  return best;
}

/// Checks both promises at exact times: farther than the separation before the time (all the time, if there is none),
/// and near enough at it.
void expect_right(Pair pair, const double* points, double separation) {
  const auto impact = first_approach(pair, points, separation, 0, 1);
  const double end = impact ? impact->time : 1;
  const mpq_class limit = square(mpq_class(separation));
  std::vector<double> times{0, end / 3, end * 0.75, end * 0.99, end};
  if (impact) times.back() = std::nextafter(end, 0.0);
  if (const double size = extent(pair, points); size > 1e-50 && size < 1e50) {
    if (const double t = nearest_time(pair, points); t < times.back()) times.push_back(t);
  }
  for (const double t : times) {
    if (impact && t >= end) continue;
    EXPECT_GT(square_distance(pair, points, t), limit) << "t = " << t << ", end " << end << "\n"
                                                       << show(pair, points, separation);
  }
  if (!impact) return;
  const mpq_class promise = mpq_class(separation) * (1 + mpq_class(separation_slack)) +
                            mpq_class(separation_noise) * mpq_class(extent(pair, points));
  EXPECT_LE(square_distance(pair, points, end), square(promise)) << "time " << end << "\n"
                                                                 << show(pair, points, separation);
}

/// Of a scene's queries, the first points of each feature.
std::vector<double> points_of(Pair pair, const double* query) {
  if (number_of_points(pair) == 4) return {query, query + 24};
  std::vector<double> result(query, query + 3 * number_of_points(pair));
  result.insert(result.end(), query + 12, query + 12 + 3 * number_of_points(pair));
  return result;
}

TEST(Separation, TimesAndProofsAreRightAtExactTimes) {
  for (const Scene scene : {Scene::random, Scene::grazing, Scene::cloth_fold, Scene::lattice, Scene::degenerate,
                            Scene::near_coplanar, Scene::needles, Scene::far, Scene::sliding, Scene::rotation,
                            Scene::parallel_edges, Scene::zero_area, Scene::zero_length, Scene::slow}) {
    for (const Pair pair : pairs) {
      constexpr std::size_t count = 12;
      std::vector<double> queries(24 * count);
      generate(scene, pair == Pair::edge_edge ? Kind::edge_edge : Kind::vertex_face, count, 7)->fill(queries);
      for (std::size_t i = 0; i < count; ++i) {
        const std::vector<double> points = points_of(pair, queries.data() + 24 * i);
        const double size = extent(pair, points.data());
        for (const double relative : {0x1p-3, 0x1p-10, 0x1p-30, 0x1p-50})
          expect_right(pair, points.data(), relative * size);
      }
    }
  }
}

/// Contact is approach, whatever the separation, and not later.
TEST(Separation, ContactsAreApproaches) {
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    test::ContactGenerator generator(61);
    const Pair pair = kind == Kind::vertex_face ? Pair::vertex_face : Pair::edge_edge;
    for (int i = 0; i < 1500; ++i) {
      const Query query = generator.contact(kind);
      const auto contact = oracle::first_contact(kind, query);
      ASSERT_TRUE(contact.has_value());
      for (const double separation : {0.0, 0x1p-1074, 1e-300, 1e-15, 1e-3, 1.0, 1e100}) {
        const auto impact = first_approach(pair, query.data(), separation, 1e-6, 1);
        ASSERT_TRUE(impact.has_value()) << show(pair, query.data(), separation);
        EXPECT_LE(impact->time, contact->upper) << show(pair, query.data(), separation);
        if (contact->upper < 1) {  // t_max just after the contact still finds it, long before does not
          EXPECT_TRUE(first_approach(pair, query.data(), separation, 1e-6, contact->upper).has_value());
        }
      }
      if (contact->lower > 0.25) {
        EXPECT_FALSE(first_approach(pair, query.data(), 0x1p-40, 1e-6, 0).has_value());
      }
    }
  }
}

// --- Grazing ------------------------------------------------------------------------------------------------------

/// Passes by at the distance h: p moves along x, over a vertex, an edge or a face through the origin; two edges cross.
std::vector<double> passing(Pair pair, double h, bool with_edge) {
  const double far = with_edge ? 8 : 2;
  switch (pair) {
    case Pair::vertex_vertex:
      return {-1, h, 0, 0, 0, 0, 1, h, 0, 0, 0, 0};
    case Pair::vertex_edge:
      return {-1, h, 0, 0, 0, -far, 0, 0, far, 1, h, 0, 0, 0, -far, 0, 0, far};
    case Pair::vertex_face:
      return {-1, h, 0, 0, 0, -far, 0, 0, far, 0, -far, 0, 1, h, 0, 0, 0, -far, 0, 0, far, 0, -far, 0};
    case Pair::edge_edge:
      return {-1, h, 0, -1, h + far, 0, 0, 0, -far, 0, 0, far, 1, h, 0, 1, h + far, 0, 0, 0, -far, 0, 0, far};
  }
  return {};
}

TEST(Separation, GrazingIsDecidedToTheSlack) {
  for (const Pair pair : pairs) {
    for (const bool with_edge : {false, true}) {
      for (const double h : {0.5, 0x1p-10, 0.1, 0x1p-20}) {
        const std::vector<double> points = passing(pair, h, with_edge);
        for (const double separation : {h, h * (1 + 1e-12), std::nextafter(h, 1.0)}) {
          const auto impact = first_approach(pair, points.data(), separation, 0, 1);
          ASSERT_TRUE(impact.has_value()) << show(pair, points.data(), separation);
          EXPECT_LE(impact->time, 0.5);
          EXPECT_GT(impact->time, 0.4);
          expect_right(pair, points.data(), separation);
        }
        const double less = h * (1 - 2 * separation_slack) - 4 * separation_noise * 16;
        EXPECT_FALSE(first_approach(pair, points.data(), less, 0, 1).has_value()) << show(pair, points.data(), less);
        expect_right(pair, points.data(), h * (1 - 1e-12));
      }
    }
  }
}

/// A vertex that glides along a face, at a distance h all the time.
TEST(Separation, ParallelSlidingIsDecidedToTheSlack) {
  const double h = 0.125;
  const Query points{-1, h, -0.5, -2, 0, -2, 4, 0, -2, 0, 0, 4, 1, h, 0.5, -2, 0, -2, 4, 0, -2, 0, 0, 4};
  EXPECT_FALSE(first_approach(Pair::vertex_face, points.data(), h * (1 - 2 * separation_slack), 0, 1).has_value());
  for (const double separation : {h, std::nextafter(h, 1.0), 2 * h}) {
    const auto impact = first_approach(Pair::vertex_face, points.data(), separation, 0, 1);
    ASSERT_TRUE(impact.has_value());
    EXPECT_EQ(impact->time, 0);
  }
}

/// The face turns by a radian while the vertex stays near it: a plane that does not turn with it proves next to
/// nothing.
TEST(Separation, ThinGapsOfTurningFeaturesAreProved) {
  const Query points{10485760, 0, 0.0078125, -16777216, 0, 0, 54525952,  20971520, -50331648, 20971520, 0, 0,
                     -8388608, 0, 0.0078125, -16777216, 0, 0, -41943040, 25165824, 33554432,  20971520, 0, 0};
  EXPECT_FALSE(first_approach(Pair::vertex_face, points.data(), 1e-3, 1e-6, 1).has_value());
}

// --- The proof with its bounds dropped ----------------------------------------------------------------------------

/// A vertex at rest, all but on its face, the separation being their distance rounded up: whoever finds them farther
/// apart is wrong.
template <class Bound>
int wrong_proofs(int count) {
  Random random(62);
  int wrong = 0;
  for (int i = 0; i < count; ++i) {
    Query points;
    for (std::size_t j = 3; j < 12; ++j) points[j] = 2 * random.unit() - 1;
    const double r = random.unit(), s = (1 - r) * random.unit();
    for (std::size_t j = 0; j < 3; ++j) points[j] = (1 - r - s) * points[3 + j] + r * points[6 + j] + s * points[9 + j];
    std::copy_n(points.begin(), 12, points.begin() + 12);
    const mpq_class exact = square_distance(Pair::vertex_face, points.data(), 0);
    double separation = std::sqrt(exact.get_d());
    while (square(mpq_class(separation)) < exact) separation = std::nextafter(separation, 1.0);
    wrong += !Approach<Bound>(Pair::vertex_face, points.data(), separation).first_time(0, 1).has_value();
  }
  return wrong;
}

TEST(Separation, BoundsAreNeeded) {
  EXPECT_EQ(wrong_proofs<bound::tight>(1000), 0);
  EXPECT_GT(wrong_proofs<bound::none>(1000), 20);
}

// --- Units, places, and what is no number -------------------------------------------------------------------------

TEST(Separation, AnswersDoNotDependOnUnitsOrExactTranslations) {
  Random random(63);
  for (const Pair pair : pairs) {
    for (int i = 0; i < 40; ++i) {
      std::vector<double> points(6 * number_of_points(pair));
      for (double& x : points) x = random.whole(-64, 64) / 16.0;
      const double separation = 1 / 16.0;
      const auto impact = first_approach(pair, points.data(), separation, 0, 1);
      for (const int exponent : {-1000, -500, -120, -3, 40, 300, 900, 1010}) {
        std::vector<double> scaled = points;
        for (double& x : scaled) x = std::ldexp(x + (i % 4 == 0 ? 1024.0 : 0.0), exponent);
        const auto same = first_approach(pair, scaled.data(), std::ldexp(separation, exponent), 0, 1);
        ASSERT_EQ(impact.has_value(), same.has_value()) << exponent << show(pair, points.data(), separation);
        if (impact) {
          EXPECT_EQ(impact->time, same->time) << exponent << show(pair, points.data(), separation);
        }
      }
    }
  }
}

TEST(Separation, SubnormalCoordinatesAndHugeOnes) {
  Random random(64);
  for (const Pair pair : pairs) {
    for (int i = 0; i < 100; ++i) {
      std::vector<double> points(6 * number_of_points(pair));
      for (double& x : points) x = std::ldexp(random.whole(-40, 40), -1074);
      expect_right(pair, points.data(), std::ldexp(random.whole(1, 4), -1074));
      for (double& x : points) x = std::ldexp(x, 1074 + 1016);
      expect_right(pair, points.data(), std::ldexp(random.whole(1, 4), 1016));
    }
  }
}

/// A separation far below what floating point sees at the size of the query, and edges that just graze at the slack:
/// these once took more than 100,000 steps.
TEST(Separation, EndsWhereItCanTellNoMore) {
  const std::vector<double> tiny{0,      0x1p-193, 0, -0x1p-235, 0, 0, 0, 0, -0x1p-257, 0, 0, 0,
                                 0x1p23, 0,        0, 0,         0, 0, 0, 0, 0,         0, 0, 0};
  const auto impact = first_approach(Pair::edge_edge, tiny.data(), 0x1p-242, 1e-6, 1);
  ASSERT_TRUE(impact.has_value());
  EXPECT_EQ(impact->time, 0);
  const std::vector<double> grazing{
      -0x1.11a5e5fe7da0bp-1, -0x1.114d8df695e97p-2, -0x1.558ba71f39ddep-1, -0x1.96cc932a78acfp-3, -0x1.965db14f6fe9fp-4,
      -0x1.fbd641bed1f54p-3, -0x1.2087c8e6ae78dp-3, -0x1.202a999f37f5p-4,  -0x1.6824dd1cfd1aap-3, -0x1.26b89d629af2p-1,
      -0x1.265b5709e2a8ep-2, -0x1.6fd96a253da63p-1, -0x1.034bc93063cdep-1, -0x1.114d9dafc4be9p-2, -0x1.5835b2c66fedbp-1,
      -0x1.96b23937bfee3p-3, -0x1.965dd010f415cp-4, -0x1.fbc94931bc40dp-3, -0x1.160a4b78a029bp-3, -0x1.202ba0914b55ep-4,
      -0x1.6824dd7f5a84ap-3, -0x1.26b8962b47861p-1, -0x1.26552ef5aa37fp-2, -0x1.71820a58ba28cp-1};
  const double distance = 0x1.b8a24267acc14p-19;
  for (const double less : {0.0, 0x1p-28, 0x1p-24, 0x1p-21, 0x1p-20, 0x1p-19, 0x1p-18}) {
    expect_right(Pair::edge_edge, grazing.data(), distance * (1 - less));
  }
}

TEST(Separation, WhatIsNoNumberCountsAsContact) {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::nan("");
  const Query apart{0, 0, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 5, 0, 0, 0, 1, 0, 0, 0, 1, 0};
  EXPECT_FALSE(first_approach(Pair::vertex_face, apart.data(), 4, 1e-6, 1).has_value());
  EXPECT_FALSE(first_approach(Pair::vertex_face, apart.data(), -4, 1e-6, 1).has_value());
  EXPECT_FALSE(first_approach(Pair::vertex_face, apart.data(), infinity, 1e-6, -1).has_value());
  const auto at_end = first_approach(Pair::vertex_face, apart.data(), 5, 0, nan);
  ASSERT_TRUE(at_end.has_value());
  EXPECT_NEAR(at_end->time, 1, 2e-6);
  for (const double separation : {infinity, nan}) {
    const auto impact = first_approach(Pair::vertex_face, apart.data(), separation, 1e-6, 1);
    ASSERT_TRUE(impact.has_value());
    EXPECT_EQ(impact->time, 0);
  }
  for (std::size_t i = 0; i < 24; ++i) {
    for (const double strange : {infinity, -infinity, nan}) {
      Query query = apart;
      query[i] = strange;
      const auto impact = first_approach(Pair::vertex_face, query.data(), 1e-3, 1e-6, 1);
      ASSERT_TRUE(impact.has_value()) << i;
      EXPECT_EQ(impact->time, 0);
    }
  }
  const Query one_point{};
  EXPECT_TRUE(first_approach(Pair::edge_edge, one_point.data(), 1e-300, 1e-6, 1).has_value());
}

TEST(Separation, WeightsAreOfTheNearestPoints) {
  const Query face{0.25, 0.25, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0.25, 0.25, -1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
  const auto over_face = first_approach(Pair::vertex_face, face.data(), 0.5, 0, 1);
  ASSERT_TRUE(over_face.has_value());
  EXPECT_NEAR(over_face->time, 0.25, 2e-6);
  const std::array<double, 4> on_face{1, 0.5, 0.25, 0.25};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(over_face->weights[i], on_face[i], 1e-12);

  const Query edges{0, 0, 1, 1, 0, 1, 0.75, -1, 0, 0.75, 3, 0, 0, 0, -1, 1, 0, -1, 0.75, -1, 0, 0.75, 3, 0};
  const auto crossing = first_approach(Pair::edge_edge, edges.data(), 0.5, 0, 1);
  ASSERT_TRUE(crossing.has_value());
  const std::array<double, 4> on_edges{0.25, 0.75, 0.75, 0.25};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(crossing->weights[i], on_edges[i], 1e-12);
}

}  // namespace
}  // namespace tightrope::ccd
