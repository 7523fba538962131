#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <vector>

#include "oracle/oracle.h"
#include "scenes/broad_phase.h"
#include "scenes/random.h"
#include "scenes/scene.h"
#include "scenes/truth.h"

namespace tightrope::ccd {
namespace {

constexpr std::array<Kind, 2> both_kinds = {Kind::vertex_face, Kind::edge_edge};

std::vector<double> queries(Scene scene, Kind kind, std::size_t count, std::uint64_t seed) {
  std::vector<double> points(24 * count);
  generate(scene, kind, count, seed)->fill(points);
  return points;
}

/// FNV-1a of the coordinates' bits.
std::uint64_t fingerprint(const std::vector<double>& points) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const double x : points) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    for (unsigned shift = 0; shift < 64; shift += 8) hash = (hash ^ ((bits >> shift) & 0xff)) * 0x100000001b3u;
  }
  return hash;
}

/// Share of true contacts.
double contacts(Kind kind, const std::vector<double>& points) {
  std::vector<unsigned char> truths(points.size() / 24);
  exact_truths(kind, points, truths);
  return std::accumulate(truths.begin(), truths.end(), 0.0) / static_cast<double>(truths.size());
}

class EveryScene : public testing::TestWithParam<Scene> {};

TEST_P(EveryScene, IsFoundByItsName) {
  EXPECT_EQ(scene_by_name(name(GetParam())), GetParam());
  EXPECT_EQ(scene_by_name("no-such-scene"), std::nullopt);
}

TEST_P(EveryScene, DependsOnSeedAndKindAloneNotOnHowItIsRead) {
  for (const Kind kind : both_kinds) {
    const std::vector<double> whole = queries(GetParam(), kind, 700, 5);
    EXPECT_EQ(queries(GetParam(), kind, 700, 5), whole);
    EXPECT_NE(queries(GetParam(), kind, 700, 6), whole);
    const auto generator = generate(GetParam(), kind, 700, 5);
    std::vector<double> piecewise;
    for (const std::size_t count : {1U, 2U, 97U, 600U}) {
      std::vector<double> piece(24 * count);
      generator->fill(piece);
      piecewise.insert(piecewise.end(), piece.begin(), piece.end());
    }
    EXPECT_EQ(piecewise, whole);
  }
  EXPECT_NE(queries(GetParam(), Kind::vertex_face, 700, 5), queries(GetParam(), Kind::edge_edge, 700, 5));
}

TEST_P(EveryScene, IsFiniteAndHasContactsAndNoContacts) {
  for (const Kind kind : both_kinds) {
    const std::vector<double> points = queries(GetParam(), kind, 1000, 1);
    EXPECT_TRUE(std::all_of(points.begin(), points.end(), [](double x) { return std::isfinite(x); }));
    const double share = contacts(kind, points);
    const bool survives_a_broad_phase = GetParam() == Scene::cloth_fold || GetParam() >= Scene::cloth_obstacle;
    EXPECT_GT(share, survives_a_broad_phase ? 0 : 0.02) << name(kind);
    EXPECT_LT(share, 0.9) << name(kind);
  }
}

std::string scene_test_name(const testing::TestParamInfo<Scene>& info) {
  std::string text(name(info.param));
  std::replace(text.begin(), text.end(), '-', '_');
  return text;
}

std::vector<Scene> every_scene() {
  std::vector<Scene> all;
  for (const SceneInfo& info : scenes()) all.push_back(info.scene);
  return all;
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene, testing::ValuesIn(every_scene()), scene_test_name);

/// The numbers were made once with g++ 12 on x86-64; other machines and compilers must agree.
TEST(Scenes, ASeedGivesTheSameQueriesOnEveryMachine) {
  struct Expected {
    Scene scene;
    std::uint64_t vertex_face;
    std::uint64_t edge_edge;
  };
  const Expected expected[] = {
      {Scene::random, 0xbba5f70f7d1d8b14, 0x8365d44627fc2523},
      {Scene::grazing, 0x6f40b03385929c80, 0x7b7f25995df80358},
      {Scene::cloth_fold, 0xf4da81c1782b274b, 0xd3198d4884047092},
      {Scene::lattice, 0x1b4a0df2fe6f7985, 0x947db7a4223adda0},
      {Scene::degenerate, 0x4de138bc3c0c7e32, 0x531aec8deba123c5},
      {Scene::static_lattice, 0x6c5601b3d37c3178, 0x9e223be32e12778d},
      {Scene::tangent, 0x6113b51bd4549503, 0x73c140222e623231},
      {Scene::slow, 0x095558a3b8b3b8f8, 0x34ae3c31d26ec386},
      {Scene::near_coplanar, 0xe0ff4b76b13e75b9, 0x227b4eb4eea9d261},
      {Scene::needles, 0x3ab4c6a8688c984c, 0xab1a3f32129575fc},
      {Scene::tiny, 0xf922aa4e73b196a9, 0xe730f657614ed65f},
      {Scene::huge, 0x411cbeaf883a3a2f, 0x57abd6f379dd01e5},
      {Scene::far, 0xf56d0899be162d3d, 0x8ae694089a59b144},
      {Scene::single, 0x2d2beafd87809326, 0x007c912cc49272b9},
      {Scene::coplanar, 0x86be157eff4a779a, 0xe356ea9898dc1545},
      {Scene::sliding, 0x5ed7786234dd09d6, 0xca1fd146ce1faa2b},
      {Scene::through_vertex, 0x8d8fcc586b3b96d8, 0x631db762b8a670b6},
      {Scene::through_edge, 0xfab0c683884e75f1, 0x66083b51986c5a5b},
      {Scene::parallel_edges, 0xe625281d4d23ca11, 0x7d7fb0a6dbcb987f},
      {Scene::zero_area, 0x19f83f0720d71a80, 0xb9b6c6dadd53676e},
      {Scene::zero_length, 0xc432514a2125b7ab, 0xf324063debf2dcdb},
      {Scene::double_root, 0x113c5ebf1c3c13bf, 0x923a6003eb4bc3c9},
      {Scene::triple_root, 0xf5708dc0f274ce29, 0xf247b6e833f38c44},
      {Scene::step_ends, 0x9598c38f4bb387d4, 0x64bff36975cbb966},
      {Scene::rotation, 0xf986e78b2a346b48, 0xb58d6c6e433d480c},
      {Scene::at_rest, 0x385c968b36a759d6, 0x612e43b1c43d7809},
      {Scene::displacements, 0xb83d5480f55f1c01, 0x69042699365b40b3},
      {Scene::offsets, 0xdd2a19299856a247, 0x2ffbdd4b0c3eb68d},
      {Scene::degenerate_families, 0x500b5cec2fe3917a, 0x08126d1df8329f5b},
      {Scene::cloth_obstacle, 0x2e6f1e6cdd35a71b, 0x61facba09012ab39},
      {Scene::cloth_millimetre, 0x8e05c31b25be62a3, 0x698c87fc2a5f9b8c},
      {Scene::terrain, 0x7baf2534dc57a0a1, 0x68c232c187988e0c},
  };
  for (const Expected& e : expected) {
    EXPECT_EQ(fingerprint(queries(e.scene, Kind::vertex_face, 200, 42)), e.vertex_face) << name(e.scene);
    EXPECT_EQ(fingerprint(queries(e.scene, Kind::edge_edge, 200, 42)), e.edge_edge) << name(e.scene);
  }
}

/// A query's points at t = 0, then at t = 1.
using Points = std::array<std::array<std::array<double, 3>, 4>, 2>;
Points points_of(const std::vector<double>& all, std::size_t query) {
  Points points;
  for (std::size_t i = 0; i < 24; ++i) points[i / 12][i / 3 % 4][i % 3] = all[24 * query + i];
  return points;
}

using Vector = std::array<long double, 3>;
Vector difference(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  Vector d;
  for (std::size_t k = 0; k < 3; ++k) d[k] = static_cast<long double>(a[k]) - static_cast<long double>(b[k]);
  return d;
}
long double determinant(const Vector& a, const Vector& b, const Vector& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// Do the four Bernstein coefficients of det(A, B, C)(t) have one sign? They are means of the determinant over the
/// choices of i of the three vectors at t = 1. Extended precision: good enough to count.
bool ends_at_hull(const Points& points) {
  std::array<long double, 4> coefficients{};
  for (unsigned choice = 0; choice < 8; ++choice) {
    const auto side = [&](unsigned vector) { return points[choice >> vector & 1U]; };
    const auto at = [&](unsigned vector) { return difference(side(vector)[vector + 1], side(vector)[0]); };
    coefficients[static_cast<std::size_t>(std::popcount(choice))] += determinant(at(0), at(1), at(2));
  }
  const auto positive = std::count_if(coefficients.begin(), coefficients.end(), [](long double c) { return c > 0; });
  const auto negative = std::count_if(coefficients.begin(), coefficients.end(), [](long double c) { return c < 0; });
  return positive == 4 || negative == 4;
}

/// [low, high] of a feature's swept box in one coordinate.
std::pair<double, double> swept(const Points& points, std::size_t first, std::size_t last, std::size_t k) {
  std::pair<double, double> range{HUGE_VAL, -HUGE_VAL};
  for (const auto& side : points) {
    for (std::size_t i = first; i <= last; ++i) {
      range = {std::min(range.first, side[i][k]), std::max(range.second, side[i][k])};
    }
  }
  return range;
}

TEST(ClothFold, PairsSurviveABroadPhaseAndShareNoVertex) {
  for (const Kind kind : both_kinds) {
    const std::vector<double> all = queries(Scene::cloth_fold, kind, 5000, 3);
    const std::size_t split = kind == Kind::vertex_face ? 1 : 2;
    for (std::size_t i = 0; i < 5000; ++i) {
      const Points points = points_of(all, i);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto first = swept(points, 0, split - 1, k);
        const auto second = swept(points, split, 3, k);
        EXPECT_TRUE(first.first <= second.second && second.first <= first.second);
      }
      for (std::size_t a = 0; a < 4; ++a) {
        for (std::size_t b = a + 1; b < 4; ++b) EXPECT_NE(points[0][a], points[0][b]);
      }
    }
  }
}

TEST(ClothFold, EndsAtTheCoplanarityHullAsOftenAsInASimulation) {
  for (const Kind kind : both_kinds) {
    for (const std::uint64_t seed : {1U, 2U}) {
      constexpr std::size_t count = 10000;
      const std::vector<double> all = queries(Scene::cloth_fold, kind, count, seed);
      std::size_t ended = 0;
      for (std::size_t i = 0; i < count; ++i) ended += ends_at_hull(points_of(all, i)) ? 1 : 0;
      EXPECT_GT(ended, 9700U) << name(kind) << " seed " << seed;
      EXPECT_LT(ended, 9950U) << name(kind) << " seed " << seed;
      const double share = contacts(kind, all);
      EXPECT_GT(share, 0.002) << name(kind) << " seed " << seed;
      EXPECT_LT(share, 0.02) << name(kind) << " seed " << seed;
    }
  }
}

double rounded_to_float(double x) {
  volatile float rounded = static_cast<float>(x);
  return rounded;
}

TEST(Scenes, LatticesAreIntegersAndFloatsAreFloats) {
  for (const Kind kind : both_kinds) {
    for (const Scene scene : {Scene::lattice, Scene::static_lattice}) {
      for (const double x : queries(scene, kind, 1000, 1)) EXPECT_TRUE(x == std::floor(x) && std::abs(x) <= 4) << x;
    }
    for (const double x : queries(Scene::single, kind, 1000, 1)) EXPECT_EQ(x, rounded_to_float(x));
  }
}

TEST(Scenes, TinyHugeAndFarReachTheirScales) {
  for (const Kind kind : both_kinds) {
    const auto largest = [&](Scene scene) {
      std::vector<double> sizes;
      const std::vector<double> all = queries(scene, kind, 2000, 1);
      for (std::size_t i = 0; i < 2000; ++i) {
        double size = 0;
        for (std::size_t j = 0; j < 24; ++j) size = std::max(size, std::abs(all[24 * i + j]));
        if (size > 0) sizes.push_back(size);
      }
      return std::pair(*std::min_element(sizes.begin(), sizes.end()), *std::max_element(sizes.begin(), sizes.end()));
    };
    EXPECT_LT(largest(Scene::tiny).first, 0x1p-330);
    EXPECT_LT(largest(Scene::tiny).second, 0x1p-10);
    EXPECT_GT(largest(Scene::huge).second, 0x1p990);
    EXPECT_GT(largest(Scene::huge).first, 0x1p15);
    EXPECT_GT(largest(Scene::far).second, 5e11);
    EXPECT_GT(largest(Scene::far).first, 100);
  }
}

TEST(Random, IntegersCoverTheirRangeAndUniformItsInterval) {
  Random random(7);
  std::array<int, 5> counts{};
  double sum = 0;
  for (int i = 0; i < 50000; ++i) {
    ++counts[static_cast<std::size_t>(random.integer(-2, 2) + 2)];
    const double x = random.uniform();
    EXPECT_TRUE(x >= 0 && x < 1);
    sum += x;
    const double m = std::abs(random.magnitude(-3, -2));
    EXPECT_TRUE(m >= 0.125 && m < 0.5) << m;
  }
  for (const int count : counts) EXPECT_NEAR(count, 10000, 500);
  EXPECT_NEAR(sum / 50000, 0.5, 0.01);
}

TEST(BroadPhase, FindsExactlyTheOverlappingPairs) {
  Random random(11);
  for (int round = 0; round < 200; ++round) {
    const auto boxes = [&](int count) {
      std::vector<Box> result;
      for (int i = 0; i < count; ++i) {
        Box box;  // on a small lattice: many touch
        for (auto coordinate : {&Point::x, &Point::y, &Point::z}) {
          box.low.*coordinate = random.integer(0, 6);
          box.high.*coordinate = box.low.*coordinate + random.integer(0, 3);
        }
        result.push_back(box);
      }
      return result;
    };
    const std::vector<Box> first = boxes(random.integer(0, 20));
    const std::vector<Box> second = boxes(random.integer(0, 20));
    auto pairs = overlapping_pairs(first, second);
    std::sort(pairs.begin(), pairs.end());
    std::vector<std::pair<std::uint32_t, std::uint32_t>> expected;
    for (std::uint32_t i = 0; i < first.size(); ++i) {
      for (std::uint32_t j = 0; j < second.size(); ++j) {
        bool overlap = true;
        for (auto k : {&Point::x, &Point::y, &Point::z}) {
          overlap = overlap && first[i].low.*k <= second[j].high.*k && second[j].low.*k <= first[i].high.*k;
        }
        if (overlap) expected.emplace_back(i, j);
      }
    }
    EXPECT_EQ(pairs, expected);
  }
}

TEST(ExactTruths, AreTheOraclesInOrder) {
  for (const Kind kind : both_kinds) {
    const std::vector<double> all = queries(Scene::degenerate, kind, 3000, 9);
    std::vector<unsigned char> truths(3000, 2);
    exact_truths(kind, all, truths);
    for (std::size_t i = 0; i < 3000; ++i) {
      EXPECT_EQ(truths[i] != 0, oracle::contact(kind, std::span(all).subspan(24 * i).first<24>())) << i;
    }
  }
  exact_truths(Kind::vertex_face, {}, {});
}

}  // namespace
}  // namespace tightrope::ccd
