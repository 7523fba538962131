/// The public forms of the time of impact: options, Eigen, single precision, features at rest.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "contacts.h"
#include "scenes/scene.h"
#include "scenes/single_precision.h"
#include "tests/stability/show_query.h"
#include "tightrope/impact.h"
#include "tightrope/static_impact.h"

namespace tightrope::ccd {
namespace {

using test::Query;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr std::array all_pairs{Pair::vertex_vertex, Pair::vertex_edge, Pair::vertex_face, Pair::edge_edge};

bool same_bits(const std::optional<Impact>& x, const std::optional<Impact>& y) {
  if (!x || !y) return !x && !y;
  return std::memcmp(&*x, &*y, sizeof(Impact)) == 0;
}

/// A vertex that falls through a face (an edge, a vertex) at rest: at its place at t = 1/4.
const Eigen::Vector3d above(0.25, 0.25, 1), below(0.25, 0.25, -3), a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);

TEST(FirstImpact, TimeAndWeightsOfEveryPair) {
  const ImpactOptions exact{.tolerance = 0};
  const auto face = vertex_face(above, a, b, c, below, a, b, c, exact);
  ASSERT_TRUE(face);
  EXPECT_EQ(face->time, 0.25);
  EXPECT_EQ(face->weights, (std::array{1.0, 0.5, 0.25, 0.25}));

  const Eigen::Vector3d left(-1, 0, 1), right(3, 0, 1), front(0, -1, 0), back(0, 3, 0), down(0, 0, -4);
  const auto edges = edge_edge(left, right, front, back, left + down, right + down, front, back, exact);
  ASSERT_TRUE(edges);
  EXPECT_EQ(edges->time, 0.25);
  EXPECT_EQ(edges->weights, (std::array{0.75, 0.25, 0.75, 0.25}));

  const Eigen::Vector3d from(1, 0, 1), to(1, 0, -3);
  const auto edge = vertex_edge(from, a, Eigen::Vector3d(4, 0, 0), to, a, Eigen::Vector3d(4, 0, 0), exact);
  ASSERT_TRUE(edge);
  EXPECT_EQ(edge->time, 0.25);
  EXPECT_EQ(edge->weights, (std::array{1.0, 0.75, 0.25, 0.0}));

  const Eigen::Vector2d p0(1, 1), p1(1, -3), e0(0, 0), e1(4, 0);
  const auto plane = vertex_edge(p0, e0, e1, p1, e0, e1, exact);
  ASSERT_TRUE(plane);
  EXPECT_EQ(plane->time, 0.25);
  EXPECT_EQ(plane->weights, (std::array{1.0, 0.75, 0.25, 0.0}));
  EXPECT_FALSE(vertex_edge(p0, e0, e1, Eigen::Vector2d(1, 0.5), e0, e1, exact));

  const auto vertices = vertex_vertex(from, a + b, to, a + b, exact);
  ASSERT_TRUE(vertices);
  EXPECT_EQ(vertices->time, 0.25);
  EXPECT_EQ(vertices->weights, (std::array{1.0, 1.0, 0.0, 0.0}));
  EXPECT_FALSE(vertex_vertex(from, a, to, a, exact));

  const Eigen::Vector3d far(4, 0, 0);
  EXPECT_TRUE(vertex_edge_collides(from, a, far, to, a, far));
  EXPECT_FALSE(vertex_edge_collides(from, a, far, from, a, far));
  EXPECT_TRUE(vertex_edge_collides(p0, e0, e1, p1, e0, e1));
  EXPECT_FALSE(vertex_edge_collides(p0, e0, e1, p0, e0, e1));
  EXPECT_TRUE(vertex_vertex_collides(from, b, to, b));
  EXPECT_FALSE(vertex_vertex_collides(from, a, to, a));
}

TEST(FirstImpact, OptionsOutOfRangeAreWhatTheDocumentationSays) {
  // At t = 1/3, which is no double.
  const Eigen::Vector3d end(0.25, 0.25, -2);
  const auto at = [&](const ImpactOptions& options) { return vertex_face(above, a, b, c, end, a, b, c, options); };
  const double floor_of_third = 1.0 / 3;  // rounds down
  for (const double tolerance : {0.0, -0.0, -1.0, -infinity, not_a_number}) {
    ASSERT_TRUE(at({.tolerance = tolerance}));
    EXPECT_EQ(at({.tolerance = tolerance})->time, floor_of_third) << tolerance;
  }
  ASSERT_TRUE(at({.tolerance = infinity}));
  EXPECT_GT(at({.tolerance = infinity})->time, 0) << "contact is not at 0";
  for (const double t_max : {1.0, 2.0, infinity, not_a_number, std::nextafter(floor_of_third, 1.0)}) {
    EXPECT_TRUE(at({.t_max = t_max})) << t_max;
  }
  for (const double t_max : {floor_of_third, 0.0, -0.0, -1.0, -infinity}) EXPECT_FALSE(at({.t_max = t_max})) << t_max;
  const auto touching = [&](double t_max) {
    return vertex_face(a, a, b, c, below, a, b, c, {.t_max = t_max}).has_value();
  };
  EXPECT_TRUE(touching(0));
  EXPECT_TRUE(touching(-0.0));
  EXPECT_FALSE(touching(-std::numeric_limits<double>::denorm_min()));
}

TEST(FirstImpact, SeparationOfEveryPair) {
  const Eigen::Vector3d over(1, 1, 3), near(1, 1, 1), x(4, 0, 0), y(0, 4, 0), two(1, 1, 0);
  const Eigen::Vector3d up(0, 0, 3), down(0, 0, -2);
  for (const double separation : {0.5, 1.5, 2.0, 3.0, 4.0}) {  // the distance is 3 - 2t
    const ImpactOptions options{.minimum_separation = separation};
    const auto face = vertex_face(over, a, x, y, near, a, x, y, options);
    const auto at_rest = vertex_static_face(over, near, a, x, y, options);
    const auto vertices = vertex_vertex(over, two, near, two, options);
    const auto edge = vertex_edge(over, two - b, two + b, near, two - b, two + b, options);
    const Eigen::Vector3d a0 = two - c + up, a1 = two + c + up;
    const auto edges = edge_edge(a0, a1, two - b, two + b, a0 + down, a1 + down, two - b, two + b, options);
    const auto rest = edge_static_edge(a0, a1, a0 + down, a1 + down, two - b, two + b, options);
    const Eigen::Vector2d p0(1, 3), p1(1, 1), e0(0, 0), e1(4, 0);
    const auto plane = vertex_edge(p0, e0, e1, p1, e0, e1, options);
    const double expected = std::max(0.0, (3 - separation) / 2);
    for (const auto& impact : {face, at_rest, vertices, edge, edges, rest, plane}) {
      ASSERT_EQ(impact.has_value(), separation >= 1);
      if (!impact) continue;
      EXPECT_LE(impact->time, expected);
      EXPECT_GE(impact->time, expected - 2e-6);
    }
  }
  for (const double separation : {-1.0, -infinity, 0.0, -0.0}) {
    EXPECT_FALSE(vertex_face(over, a, x, y, near, a, x, y, {.minimum_separation = separation}));
  }
  for (const double separation : {infinity, not_a_number}) {
    const auto impact = vertex_face(over, a, x, y, near, a, x, y, {.minimum_separation = separation});
    ASSERT_TRUE(impact);
    EXPECT_EQ(impact->time, 0);
    const auto at_rest = vertex_static_face(over, near, a, x, y, {.minimum_separation = separation});
    ASSERT_TRUE(at_rest);
    EXPECT_EQ(at_rest->time, 0);
  }
}

/// Options act together, and in every form of the query: what is asked for later than t_max is not found, and no
/// tolerance but the given one is used.
TEST(FirstImpact, OptionsActTogether) {
  const Eigen::Vector3d over(1, 1, 3), near(1, 1, 1), x(4, 0, 0), y(0, 4, 0);  // the distance is 3 - 2t
  const auto face = [&](const ImpactOptions& options) { return vertex_face(over, a, x, y, near, a, x, y, options); };
  EXPECT_FALSE(face({.t_max = 0.4375, .minimum_separation = 2}));
  ASSERT_TRUE(face({.t_max = 0.5625, .minimum_separation = 2}));
  const auto coarse = face({.tolerance = 0.25, .minimum_separation = 1.25});
  const auto fine = face({.tolerance = 1e-12, .minimum_separation = 1.25});
  ASSERT_TRUE(coarse && fine);
  EXPECT_GE(coarse->time, 0.875 - 0.2500011);
  EXPECT_NEAR(fine->time, 0.875, 1.5e-6) << "but for the slack of the separation";
  const Eigen::Vector2d p0(1, 1), p1(1, -1), e0(0, 0), e1(4, 0);  // crosses at 1/2
  EXPECT_FALSE(vertex_edge(p0, e0, e1, p1, e0, e1, {.t_max = 0.4375}));
  EXPECT_TRUE(vertex_edge(p0, e0, e1, p1, e0, e1, {.t_max = 0.5}));
}

/// 0 means contact at 0, whatever the tolerance.
TEST(FirstImpact, NoContactAtZeroNoTimeZero) {
  for (const double height : {1e-17, 1e-30, 1e-300}) {
    const Eigen::Vector3d start(0.25, 0.25, height), end(0.25, 0.25, -1);
    const auto face = vertex_face(start, a, b, c, end, a, b, c);
    const Eigen::Vector3d up(0, 0, height), down(0, 0, -1), x0(-1, 0.25, 0), x1(1, 0.25, 0), y0(0.25, -1, 0),
        y1(0.25, 1, 0);
    const auto edges = edge_edge(x0 + up, x1 + up, y0, y1, x0 + down, x1 + down, y0, y1);
    for (const auto& impact : {face, edges}) {
      ASSERT_TRUE(impact);
      EXPECT_GT(impact->time, 0);
      EXPECT_LE(impact->time, height);
    }
  }
}

TEST(FirstImpact, CoordinatesThatAreNotFiniteGiveContactAtZero) {
  test::Random random(5);
  const Query query = test::miss(Kind::vertex_face, random);
  for (const Pair pair : all_pairs) {
    const std::size_t numbers = pair == Pair::vertex_vertex ? 12 : pair == Pair::vertex_edge ? 18 : 24;
    for (const double x : {infinity, -infinity, not_a_number}) {
      for (std::size_t i = 0; i < numbers; ++i) {
        Query broken = query;
        broken[i] = x;
        const auto impact = first_impact(pair, broken.data());
        ASSERT_TRUE(impact) << i;
        EXPECT_EQ(impact->time, 0);
        EXPECT_FALSE(first_impact(pair, broken.data(), {.t_max = -1}));
        EXPECT_TRUE(collides(pair, broken.data()));
      }
    }
  }
}

/// Queries of every scene, rounded to single precision, as floats and as the doubles of the same numbers.
template <class Check>
void for_each_single_query(std::size_t each, const Check& check) {
  for (const SceneInfo& info : scenes()) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      QueryBlock block{kind, std::vector<double>(24 * each), {}};
      generate(info.scene, kind, each, 77)->fill(block.points);
      const SingleBlock single = in_single_precision(block, false);
      for (std::size_t i = 0; i < single.points.size(); i += 24) {
        Query query;
        std::copy_n(&single.points[i], 24, query.begin());
        check(kind, &single.points[i], query);
      }
    }
  }
}

TEST(SinglePrecision, AnswersAreThoseOfDoubleToTheLastBit) {
  int contacts = 0;
  for_each_single_query(60, [&](Kind kind, const float* points, const Query& query) {
    ASSERT_EQ(collides(kind, points), collides(kind, query.data())) << show_query(query.data());
    for (const Pair pair : all_pairs) {
      if (pair == Pair::vertex_face && kind != Kind::vertex_face) continue;
      if (pair == Pair::edge_edge && kind != Kind::edge_edge) continue;
      for (const double tolerance : {1e-6, 0.0}) {
        const auto impact = first_impact(pair, points, {.tolerance = tolerance});
        ASSERT_TRUE(same_bits(impact, first_impact(pair, query.data(), {.tolerance = tolerance})))
            << show_query(query.data());
        contacts += impact ? 1 : 0;
      }
      ASSERT_EQ(collides(pair, points), collides(pair, query.data())) << show_query(query.data());
    }
  });
  EXPECT_GT(contacts, 1000);
}

/// Where the points of a query with a feature at rest are in the general query (static_impact.h).
struct AtRest {
  StaticPair pair;
  Pair general;
  std::vector<std::size_t> points;
};
const std::array<AtRest, 3> at_rest{{{StaticPair::vertex_static_face, Pair::vertex_face, {0, 4, 1, 2, 3}},
                                     {StaticPair::static_vertex_face, Pair::vertex_face, {1, 2, 3, 5, 6, 7, 0}},
                                     {StaticPair::edge_static_edge, Pair::edge_edge, {0, 1, 4, 5, 2, 3}}}};

template <class Real>
std::vector<Real> gather(const AtRest& rest, const Real* query) {
  std::vector<Real> points;
  for (const std::size_t i : rest.points) points.insert(points.end(), query + 3 * i, query + 3 * i + 3);
  return points;
}

/// The general query with the same points: what rests is at t = 1 where it is at t = 0.
template <class Real>
std::array<Real, 24> freeze(const AtRest& rest, const Real* query) {
  std::array<Real, 24> frozen;
  std::copy_n(query, 24, frozen.begin());
  for (std::size_t i = 4; i < 8; ++i) {
    if (std::find(rest.points.begin(), rest.points.end(), i) != rest.points.end()) continue;
    std::copy_n(query + 3 * (i - 4), 3, frozen.begin() + 3 * i);
  }
  return frozen;
}

template <class Real>
int expect_same_answers(const AtRest& rest, const Real* query) {
  const std::array<Real, 24> frozen = freeze(rest, query);
  const std::vector<Real> points = gather(rest, query);
  const bool contact = collides(rest.general, frozen.data());
  EXPECT_EQ(collides(rest.pair, points.data()), contact);
  for (const ImpactOptions options : {ImpactOptions{}, ImpactOptions{.tolerance = 0, .t_max = 0.5}}) {
    EXPECT_TRUE(
        same_bits(first_impact(rest.pair, points.data(), options), first_impact(rest.general, frozen.data(), options)));
  }
  return contact ? 1 : 0;
}

TEST(StaticImpact, AnswersAreThoseOfTheGeneralQuery) {
  for (const AtRest& rest : at_rest) {
    int contacts = 0, queries = 0;
    const Kind kind = rest.general == Pair::vertex_face ? Kind::vertex_face : Kind::edge_edge;
    for_each_single_query(40, [&](Kind of, const float* single, const Query& query) {
      if (of != kind) return;
      contacts += expect_same_answers(rest, query.data());
      expect_same_answers(rest, single);
      ASSERT_FALSE(testing::Test::HasFailure()) << show_query(query.data());
      ++queries;
    });
    for (const SceneInfo& info : scenes()) {
      std::vector<double> points(24 * 60);
      generate(info.scene, kind, 60, 78)->fill(points);
      for (std::size_t i = 0; i < points.size(); i += 24) contacts += expect_same_answers(rest, &points[i]);
      ASSERT_FALSE(testing::Test::HasFailure()) << info.name;
    }
    EXPECT_GT(contacts, 300);
    EXPECT_GT(queries, 300);
  }
}

TEST(StaticImpact, CoordinatesThatAreNotFiniteGiveContactAtZero) {
  test::Random random(6);
  for (const AtRest& rest : at_rest) {
    const Kind kind = rest.general == Pair::vertex_face ? Kind::vertex_face : Kind::edge_edge;
    const Query query = test::miss(kind, random);
    std::vector<double> points = gather(rest, query.data());
    EXPECT_FALSE(collides(rest.pair, points.data()));
    for (double& coordinate : points) {
      const double finite = coordinate;
      for (const double x : {infinity, -infinity, not_a_number}) {
        coordinate = x;
        EXPECT_TRUE(collides(rest.pair, points.data()));
        ASSERT_TRUE(first_impact(rest.pair, points.data()));
        EXPECT_EQ(first_impact(rest.pair, points.data())->time, 0);
      }
      coordinate = finite;
    }
  }
}

TEST(StaticImpact, EigenAndBatchAsPlainMemory) {
  const ImpactOptions exact{.tolerance = 0};
  const auto face = vertex_static_face(above, below, a, b, c, exact);
  ASSERT_TRUE(face);
  EXPECT_EQ(face->time, 0.25);
  EXPECT_EQ(face->weights, (std::array{1.0, 0.5, 0.25, 0.25}));
  EXPECT_TRUE(vertex_static_face_collides(above, below, a, b, c));
  EXPECT_FALSE(vertex_static_face_collides(above, above, a, b, c));

  const Eigen::Vector3d up(0, 0, 4);
  const auto vertex = static_vertex_face(above, a, b, c, a + up, b + up, c + up, exact);
  ASSERT_TRUE(vertex);
  EXPECT_EQ(vertex->time, 0.25);
  EXPECT_TRUE(static_vertex_face_collides(above, a, b, c, a + up, b + up, c + up));
  EXPECT_FALSE(static_vertex_face_collides(above, a, b, c, a - up, b - up, c - up));

  const Eigen::Vector3d left(-1, 0, 1), right(3, 0, 1), front(0, -1, 0), back(0, 3, 0);
  const auto edges = edge_static_edge(left, right, left - up, right - up, front, back, exact);
  ASSERT_TRUE(edges);
  EXPECT_EQ(edges->time, 0.25);
  EXPECT_EQ(edges->weights, (std::array{0.75, 0.25, 0.75, 0.25}));
  EXPECT_TRUE(edge_static_edge_collides(left, right, left - up, right - up, front, back));
  EXPECT_FALSE(edge_static_edge_collides(left, right, left + up, right + up, front, back));
  const Eigen::Vector3f l = left.cast<float>(), r = right.cast<float>(), u = up.cast<float>();
  EXPECT_TRUE(edge_static_edge_collides(l, r, l - u, r - u, front.cast<float>(), back.cast<float>()));

  test::ContactGenerator contacts(9);
  for (const AtRest& rest : at_rest) {
    const Kind kind = rest.general == Pair::vertex_face ? Kind::vertex_face : Kind::edge_edge;
    std::vector<double> points;
    std::vector<unsigned char> expected;
    for (int i = 0; i < 100; ++i) {
      const Query query = i % 2 == 0 ? contacts.contact(kind) : test::miss(kind, contacts.random());
      const std::vector<double> one = gather(rest, query.data());
      points.insert(points.end(), one.begin(), one.end());
      expected.push_back(collides(rest.pair, one.data()) ? 1 : 0);
    }
    std::vector<unsigned char> results(101, 7);
    collides(rest.pair, points.data(), 100, results.data());
    expected.push_back(7);
    EXPECT_EQ(results, expected);
  }
}

}  // namespace
}  // namespace tightrope::ccd
