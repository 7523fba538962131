/// Vertex against edge, in space and in the plane, and vertex against vertex: the exact answer and time, by the
/// oracle's degenerate triangles and edges.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "contacts.h"
#include "oracle/oracle.h"
#include "vertex_edge.float.double.h"
#include "vertex_edge.safe.double.h"
#include "vertex_edge.tight.double.h"

// After the generated headers:
#include "ccd/impact/vertex_edge.h"
#include "ccd/impact/vertex_edge_search.h"
#include "ccd/impact/vertex_vertex.h"

namespace tightrope::ccd {
namespace {

using test::Query;
using test::Random;

/// A pair of features that the tests treat alike.
struct Case {
  const char* name;
  std::size_t count, dimension;
  std::optional<Impact> (*impact)(const double*, double, double);
  bool (*collides)(const double*);
  std::size_t numbers() const { return 2 * count * dimension; }
};
const std::array<Case, 3> cases{{{"vertex-edge", 3, 3, vertex_edge_impact, vertex_edge_collides},
                                 {"vertex-edge in the plane", 3, 2, vertex_edge_impact_2d, vertex_edge_collides_2d},
                                 {"vertex-vertex", 2, 3, vertex_vertex_impact, vertex_vertex_collides}}};

/// The same as a vertex against a triangle of which two or three vertices are one.
Query as_face(const Case& c, const std::vector<double>& points) {
  Query query{};
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t i = 0; i < 4; ++i) {
      const double* const x = points.data() + c.dimension * (c.count * end + std::min(i, c.count - 1));
      std::copy_n(x, c.dimension, query.data() + 12 * end + 3 * i);
    }
  }
  return query;
}

std::string show(const Case& c, const std::vector<double>& points) {
  std::string text = c.name;
  char buffer[40];
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::snprintf(buffer, sizeof buffer, "%s%a", i % c.dimension == 0 ? "\n" : " ", points[i]);
    text += buffer;
  }
  return text;
}

/// Decision and time against the oracle. `ulps`: how many doubles the time may be early with tolerance 0.
void expect_exact(const Case& c, const std::vector<double>& points, int ulps = 0) {
  const auto exact = oracle::first_contact(Kind::vertex_face, as_face(c, points));
  EXPECT_EQ(c.collides(points.data()), exact.has_value()) << show(c, points);
  const auto impact = c.impact(points.data(), 1e-6, 1);
  ASSERT_EQ(impact.has_value(), exact.has_value()) << show(c, points);
  const auto floor = c.impact(points.data(), 0, std::nan(""));
  ASSERT_EQ(floor.has_value(), exact.has_value()) << show(c, points);
  if (!exact) return;
  EXPECT_LE(floor->time, exact->lower) << show(c, points);
  EXPECT_GE(floor->time, ulps == 0 ? exact->lower : std::nextafter(exact->lower, 0.0)) << show(c, points);
  EXPECT_LE(impact->time, exact->lower) << show(c, points);
  EXPECT_GE(impact->time, exact->upper - 1e-6) << show(c, points);
  EXPECT_EQ(impact->time == 0, exact->lower == 0) << show(c, points);
  EXPECT_TRUE(c.impact(points.data(), 1e-6, exact->upper).has_value()) << show(c, points);
  if (exact->lower > 0) {
    EXPECT_FALSE(c.impact(points.data(), 1e-6, std::nextafter(exact->lower, 0.0)).has_value()) << show(c, points);
  }
}

std::vector<double> numbers(const Case& c, const std::function<double()>& next) {
  std::vector<double> points(c.numbers());
  for (double& x : points) x = next();
  return points;
}

TEST(VertexEdge, RandomMotionIsDecidedAsTheOracleDecides) {
  Random random(71);
  for (const Case& c : cases) {
    for (int i = 0; i < 1000; ++i) expect_exact(c, numbers(c, [&] { return 2 * random.unit() - 1; }));
  }
}

/// Small whole numbers: collinear and coincident points, edges of length 0, motion along the edge, contact at the ends
/// of the step and at rest.
TEST(VertexEdge, LatticeMotionIsDecidedAsTheOracleDecides) {
  Random random(72);
  for (const Case& c : cases) {
    int contacts = 0;
    for (int i = 0; i < 3000; ++i) {
      const int size = random.whole(1, 3);
      std::vector<double> points = numbers(c, [&] { return random.whole(-size, size); });
      if (random.chance(30)) {  // on one line
        for (std::size_t j = 0; j < points.size(); ++j) points[j] = points[j / c.dimension * c.dimension];
      }
      if (random.chance(20)) std::copy_n(points.begin() + 3, c.dimension, points.begin());
      expect_exact(c, points);
      contacts += c.collides(points.data());
    }
    EXPECT_GT(contacts, 100) << c.name;
  }
}

/// A contact in dyadic numbers of few bits: exact.
std::vector<double> contact(const Case& c, Random& random) {
  const int bits = random.chance(50) ? 2 : 10;
  const double time = 1.0 / (1 << random.whole(0, 3)), weight = random.whole(0, 8) / 8.0;
  const auto coordinate = [&] { return static_cast<double>(random.whole(-(1 << bits), 1 << bits)); };
  std::vector<double> points(c.numbers());
  for (std::size_t axis = 0; axis < c.dimension; ++axis) {
    const auto at = [&](std::size_t end, std::size_t i) -> double& {
      return points[c.dimension * (c.count * end + i) + axis];
    };
    double target = 0;
    for (std::size_t i = 1; i < c.count; ++i) {
      at(0, i) = coordinate();
      at(1, i) = random.chance(20) ? at(0, i) : coordinate();
      const double there = at(0, i) + time * (at(1, i) - at(0, i));
      target = i == 1 ? there : target + weight * (there - target);
    }
    at(0, 0) = coordinate();
    at(1, 0) = at(0, 0) + (target - at(0, 0)) / time;
  }
  if (random.chance(50)) std::rotate(points.begin(), points.begin() + c.numbers() / 2, points.end());
  return points;
}

TEST(VertexEdge, ContactsAreFoundInAnyUnitsAndFarFromTheOrigin) {
  Random random(73);
  for (const Case& c : cases) {
    for (int i = 0; i < 1000; ++i) {
      std::vector<double> points = contact(c, random);
      expect_exact(c, points);
      const bool decided = c.collides(points.data());
      ASSERT_TRUE(decided);
      const auto time = c.impact(points.data(), 0, 1);
      const double offset = random.whole(-1, 1) * 0x1p22;
      const int exponent = random.whole(-1050, 990);
      for (double& x : points) x = std::ldexp(x + offset, exponent);
      EXPECT_TRUE(c.collides(points.data())) << show(c, points);
      const auto same = c.impact(points.data(), 0, 1);
      ASSERT_TRUE(same.has_value()) << show(c, points);
      if (exponent > -1040) {
        EXPECT_EQ(same->time, time->time) << show(c, points);
      }
    }
  }
}

/// Moved by an ulp somewhere, many are contacts no longer.
TEST(VertexEdge, NearContactsAreDecidedAsTheOracleDecides) {
  Random random(74);
  for (const Case& c : cases) {
    for (int i = 0; i < 1000; ++i) {
      std::vector<double> points = contact(c, random);
      double& x = points[static_cast<std::size_t>(random.whole(0, static_cast<int>(points.size()) - 1))];
      x = random.chance(50) ? std::nextafter(x, 1e9) : x + std::ldexp(random.unit() - 0.5, -random.whole(1, 40));
      expect_exact(c, points);
    }
  }
}

TEST(VertexEdge, AnswersDoNotDependOnNames) {
  Random random(75);
  for (const Case& c : cases) {
    for (int i = 0; i < 600; ++i) {
      std::vector<double> points = contact(c, random);
      if (random.chance(50)) points[0] += std::ldexp(random.unit(), -random.whole(1, 50));
      const auto impact = c.impact(points.data(), 0, 1);
      std::vector<double> renamed = points;
      for (std::size_t j = 0; j < points.size(); j += c.dimension) {  // axes: the first last
        std::rotate_copy(&points[j], &points[j] + 1, &points[j] + c.dimension, &renamed[j]);
      }
      for (std::size_t end = 0; end < 2 && c.count == 3; ++end) {  // the edge reversed
        double* const a = &renamed[c.dimension * (3 * end + 1)];
        std::swap_ranges(a, a + c.dimension, a + c.dimension);
      }
      const auto same = c.impact(renamed.data(), 0, 1);
      ASSERT_EQ(impact.has_value(), same.has_value()) << show(c, points);
      if (impact) {
        EXPECT_EQ(impact->time, same->time) << show(c, points);
      }
    }
  }
}

TEST(VertexEdge, SubnormalCoordinatesAndHugeOnes) {
  Random random(76);
  for (const Case& c : cases) {
    for (const int exponent : {-1074, -1070, 1016}) {
      for (int i = 0; i < 150; ++i) {
        expect_exact(c, numbers(c, [&] { return std::ldexp(random.whole(-3, 3), exponent); }));
        expect_exact(c, numbers(c, [&] { return std::ldexp(random.whole(-60, 60), exponent); }));
        // Beside 1, differences of 2^-1074: times that differ by less than doubles do.
        expect_exact(c, numbers(c, [&] { return random.chance(50) ? random.whole(-3, 3) : std::ldexp(1, exponent); }),
                     1);
      }
    }
  }
}

TEST(VertexEdge, WeightsAndWhatIsNoNumber) {
  const std::vector<double> falling{0.25, 1, 0, 0, 1, 0, 0.25, -1, 0, 0, 1, 0};
  const auto impact = vertex_edge_impact_2d(falling.data(), 1e-6, 1);
  ASSERT_TRUE(impact.has_value());
  EXPECT_NEAR(impact->time, 0.5, 1e-6);
  EXPECT_EQ(impact->weights[0], 1);
  EXPECT_NEAR(impact->weights[1], 0.75, 1e-9);
  EXPECT_NEAR(impact->weights[2], 0.25, 1e-9);
  EXPECT_FALSE(vertex_edge_impact_2d(falling.data(), 1e-6, -1).has_value());
  Random random(77);
  for (const Case& c : cases) {
    for (std::size_t i = 0; i < c.numbers(); ++i) {
      for (const double strange : {std::nan(""), std::numeric_limits<double>::infinity(), -HUGE_VAL}) {
        std::vector<double> points = numbers(c, [&] { return random.unit(); });
        points[i] = strange;
        EXPECT_TRUE(c.collides(points.data()));
        const auto at_once = c.impact(points.data(), 1e-6, 1);
        ASSERT_TRUE(at_once.has_value());
        EXPECT_EQ(at_once->time, 0);
      }
    }
    const std::vector<double> one_point(c.numbers(), 0.5);
    EXPECT_TRUE(c.collides(one_point.data()));
    EXPECT_EQ(c.impact(one_point.data(), 0, 1)->time, 0);
  }
}

// --- The filter alone, and with its bounds dropped ----------------------------------------------------------------

/// In the plane: the vertex touches the edge's line and turns back, or meets an end of the edge; but for rounding.
std::vector<double> grazing(Random& random) {
  for (;;) {
    std::vector<double> x(12);
    for (double& coordinate : x) coordinate = random.whole(-4, 4);
    const auto moment = [&](std::size_t p, std::size_t q) {  // of the edge's start at one end, of its end at another
      return (x[p + 2] - x[p]) * (x[q + 5] - x[q + 1]) - (x[p + 3] - x[p + 1]) * (x[q + 4] - x[q]);
    };
    const double first = moment(0, 0), middle = (moment(0, 6) + moment(6, 0)) / 2, last = moment(6, 6);
    if (middle * middle != first * last || first * middle >= 0) continue;
    const double factor = 1 + random.unit();
    for (double& coordinate : x) coordinate *= factor;
    return x;
  }
}

/// How many answers of the filter are wrong.
template <class Bound>
int wrong_answers(int count, int& open) {
  Random random(78);
  const Case& c = cases[1];
  int wrong = 0;
  for (int i = 0; i < count; ++i) {
    const std::vector<double> points = grazing(random);
    const bool truth = oracle::contact(Kind::vertex_face, as_face(c, points));
    const auto finding = vertex_edge_query::Search<Bound, 2>(points.data(), false).first_contact(1);
    open += finding.answer == vertex_edge_query::Answer::open;
    wrong += finding.answer != vertex_edge_query::Answer::open &&
             (finding.answer == vertex_edge_query::Answer::touches) != truth;
  }
  return wrong;
}

TEST(VertexEdgeFilter, IsNeverWrongButWithoutItsBounds) {
  int open = 0;
  EXPECT_EQ(wrong_answers<bound::tight>(1000, open), 0);
  EXPECT_GT(wrong_answers<bound::none>(1000, open), 20);
}

TEST(VertexEdgeFilter, DecidesRandomMotion) {
  Random random(79);
  int open = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto points = numbers(cases[1], [&] { return 2 * random.unit() - 1; });
    open += vertex_edge_query::Search<bound::tight, 2>(points.data(), false).first_contact(1).answer ==
            vertex_edge_query::Answer::open;
    const auto in_space = numbers(cases[0], [&] { return 2 * random.unit() - 1; });
    open += vertex_edge_query::Search<bound::tight, 3>(in_space.data(), false).first_contact(1).answer ==
            vertex_edge_query::Answer::open;
  }
  EXPECT_LE(open, 3);
}

}  // namespace
}  // namespace tightrope::ccd
