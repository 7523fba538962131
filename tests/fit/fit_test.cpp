/// Fits: what they say and write, and above all that they answer as the full queries wherever the queries come from.
/// tests/fit/fitted is a fit of a millimetre scene with faces and edges at rest, as `tightrope-ccd fit` writes it.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>

#include "fit/choice.h"
#include "fit/folder.h"
#include "fit/report.h"
#include "fitted.h"
#include "fitted_edge_edge.static.double.h"
#include "fitted_vertex_face.static.double.h"
#include "scenes/scene.h"
#include "tightrope/fitted.h"

namespace tightrope::ccd {
namespace {

constexpr std::array<Kind, 2> both_kinds = {Kind::vertex_face, Kind::edge_edge};
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double range = 0x1p-6;  // of the committed fit

std::vector<double> queries(Scene scene, Kind kind, std::size_t count, double scale = 1) {
  std::vector<double> points(24 * count);
  generate(scene, kind, count, 3)->fill(points);
  for (double& x : points) x *= scale;
  return points;
}

bool fitted_collides(Kind kind, const double* points) {
  return kind == Kind::vertex_face ? fitted_vertex_face(points) : fitted_edge_edge(points);
}

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

const std::string folder = TIGHTROPE_SOURCE_DIR "/tests/fit/fitted/";

/// As the committed fit was chosen.
std::vector<Choice> committed_choices() {
  std::vector<Choice> choices;
  for (const Kind kind : both_kinds) {
    Choice choice;
    choice.kind = kind;
    choice.look = {.single = false, .range = true, .at_rest = true, .both_ends = false};
    choice.exponent = -6;
    choices.push_back(choice);
  }
  return choices;
}

TEST(FitFolder, TheCommittedFitIsWhatTheWriterWrites) {
  for (const FitFile& file : fit_files("fitted", committed_choices(), true)) {
    if (std::getenv("TIGHTROPE_UPDATE_GOLDEN") != nullptr) std::ofstream(folder + file.name) << file.text;
    EXPECT_EQ(text_of(folder + file.name), file.text) << file.name;
  }
}

TEST(FitFolder, ThePredicatesThatAreMeasuredAreThoseThatAreWritten) {
  const auto committed = [](const std::string& file) {
    const std::string text = text_of(TIGHTROPE_SOURCE_DIR "/ccd/fit/" + file);
    return text.substr(text.find('\n') + 1);
  };
  const auto both = [](const std::string& prefix, std::optional<int> exponent) {
    return predicates(prefix, Kind::vertex_face, exponent) + predicates(prefix, Kind::edge_edge, exponent);
  };
  EXPECT_EQ(committed("look.pred"), both("look", std::nullopt));
  EXPECT_EQ(committed("unit_look.pred"), both("unit_look", 0));
}

TEST(FitFolder, NamesAreIdentifiers) {
  for (const char* name : {"fitted", "a", "Cloth_2"}) EXPECT_TRUE(is_fit_name(name)) << name;
  for (const char* name : {"", "_a", "2a", "a-b", "a b", "a/b", "\xc3\xa4"}) EXPECT_FALSE(is_fit_name(name)) << name;
}

class FittedOnEveryScene : public testing::TestWithParam<Scene> {};

/// At the scene's own size and, where the fit's range holds or breaks, at others.
TEST_P(FittedOnEveryScene, AnswersAsTheFullQueryDoes) {
  constexpr std::size_t count = 150;
  for (const Kind kind : both_kinds) {
    for (const double scale : {1.0, 0x1p-6, 0.00731, 1234.567}) {
      const std::vector<double> points = queries(GetParam(), kind, count, scale);
      std::vector<unsigned char> full(count), fitted(count);
      collides(kind, points.data(), count, full.data(), Method::tightrope);
      if (kind == Kind::vertex_face) {
        fitted_vertex_face(points.data(), count, fitted.data());
      } else {
        fitted_edge_edge(points.data(), count, fitted.data());
      }
      EXPECT_EQ(fitted, full) << name(kind) << " times " << scale;
      for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(fitted_collides(kind, &points[24 * i]), full[i] == 1);
    }
  }
}

/// All sixteen looks, of either precision: what they settle is free of contact.
TEST_P(FittedOnEveryScene, NoLookThatFitMeasuresSettlesAContact) {
  constexpr std::size_t count = 300;
  for (const Kind kind : both_kinds) {
    std::vector<double> points = queries(GetParam(), kind, count);
    std::vector<float> floats;
    for (const double x : points) floats.push_back(static_cast<float>(x));
    std::vector<unsigned char> truths(count), float_truths(count), open(count);
    collides(kind, points.data(), count, truths.data(), Method::tightrope);
    collides(kind, floats.data(), count, float_truths.data(), Method::tightrope);
    for (unsigned bits = 0; bits < 8; ++bits) {
      const Look look{.single = false, .range = (bits & 1) != 0, .at_rest = (bits & 2) != 0, .both_ends = bits > 3};
      unit_open<double>(kind, look)(points.data(), count, open.data());
      for (std::size_t i = 0; i < count; ++i)
        EXPECT_GE(open[i], truths[i]) << in_words(look, kind, "range") << ", query " << i;
      unit_open<float>(kind, look)(floats.data(), count, open.data());
      for (std::size_t i = 0; i < count; ++i)
        EXPECT_GE(open[i], float_truths[i]) << in_words(look, kind, "float") << ", query " << i;
    }
  }
}

std::vector<Scene> every_scene() {
  std::vector<Scene> all;
  for (const SceneInfo& info : scenes()) all.push_back(info.scene);
  return all;
}
std::string scene_test_name(const testing::TestParamInfo<Scene>& info) {
  std::string text(name(info.param));
  for (char& c : text) c = c == '-' ? '_' : c;
  return text;
}
INSTANTIATE_TEST_SUITE_P(Scenes, FittedOnEveryScene, testing::ValuesIn(every_scene()), scene_test_name);

/// The fit without its tests: the models whose range or rest is taken for granted.
struct AnyRange {
  using Real = double;
  using Plane = generated::fitted_plane_of_face<bound::fixed, double>;
  using AtRest = void;
  static constexpr double range = infinity;
  static constexpr bool both_ends = false;
};
bool apart_as_if_at_rest(const double* x) {
  return fitted::one_side<generated::fitted_face_at_rest<bound::fixed, double>>(x, x + 3, x + 6, x + 9, x + 12);
}

/// A millimetre fit on queries of kilometres, a fit for faces at rest on moving ones: without the tests at run time
/// contacts are missed, so the tests above can fail.
TEST(Fitted, WithoutItsTestsAtRunTimeItMissesContacts) {
  std::size_t missed_without_range = 0;
  std::size_t missed_without_rest = 0;
  for (const SceneInfo& info : scenes()) {
    constexpr std::size_t count = 400;
    const std::vector<double> far = queries(info.scene, Kind::vertex_face, count, 1234.567);
    const std::vector<double> near = queries(info.scene, Kind::vertex_face, count, 0x1p-10);
    for (std::size_t i = 0; i < count; ++i) {
      const double* x = &far[24 * i];
      if (collides(Kind::vertex_face, x, Method::tightrope)) {
        missed_without_range += fitted::apart<Kind::vertex_face, AnyRange>(x) ? 1 : 0;
        EXPECT_TRUE(fitted_vertex_face(x)) << info.name;
      }
      const double* y = &near[24 * i];
      if (collides(Kind::vertex_face, y, Method::tightrope)) {
        missed_without_rest += apart_as_if_at_rest(y) ? 1 : 0;
        EXPECT_TRUE(fitted_vertex_face(y)) << info.name;
      }
    }
  }
  EXPECT_GT(missed_without_range, 0U);
  EXPECT_GT(missed_without_rest, 0U);
}

TEST(Fitted, EveryCoordinateIsTestedAgainstTheRange) {
  for (const std::size_t count : {15U, 18U, 24U}) {
    std::array<double, 24> x{};
    x.fill(-range);
    EXPECT_TRUE(fitted::within(x.data(), count, range));
    std::array<float, 24> y{};
    y.fill(0x1p-6f);
    EXPECT_TRUE(fitted::within(y.data(), count, 0x1p-6f));
    for (std::size_t i = 0; i < 24; ++i) {
      for (const double beyond : {std::nextafter(range, 1.0), std::nextafter(-range, -1.0), infinity, -infinity, nan}) {
        auto broken = x;
        broken[i] = beyond;
        EXPECT_EQ(fitted::within(broken.data(), count, range), i >= count) << i << ' ' << beyond;
        auto broken_float = y;
        broken_float[i] = beyond > 0 ? std::nextafter(0x1p-6f, 1.0f) : static_cast<float>(beyond) * 2;
        EXPECT_EQ(fitted::within(broken_float.data(), count, 0x1p-6f), i >= count) << i << ' ' << beyond;
      }
    }
  }
}

TEST(Fitted, EveryCoordinateOfAFeatureAtRestIsCompared) {
  for (const std::size_t count : {6U, 9U}) {
    std::array<double, 24> x{};
    for (std::size_t i = 0; i < 24; ++i) x[i] = static_cast<double>(i % 12);
    x[12] = -0.0;
    EXPECT_TRUE(fitted::at_rest(x.data(), count));
    for (std::size_t i = 0; i < 12; ++i) {
      auto moving = x;
      moving[12 + i] = std::nextafter(moving[12 + i], 20.0);
      EXPECT_EQ(fitted::at_rest(moving.data(), count), i >= count) << i;
      moving[i] = moving[12 + i] = nan;
      EXPECT_EQ(fitted::at_rest(moving.data(), count), i >= count) << i;
    }
  }
}

TEST(Fitted, CoordinatesThatAreNotFiniteCollide) {
  for (const Kind kind : both_kinds) {
    for (std::size_t i = 0; i < 24; ++i) {
      for (const double bad : {nan, infinity, -infinity}) {
        std::vector<double> points = queries(Scene::cloth_obstacle, kind, 1, 0x1p-7);
        points[i] = bad;
        EXPECT_TRUE(fitted_collides(kind, points.data())) << name(kind) << ' ' << i;
      }
    }
  }
}

TEST(Fitted, TimesAreThoseOfTheFullQuery) {
  for (const Scene scene : {Scene::cloth_obstacle, Scene::grazing, Scene::lattice, Scene::at_rest, Scene::huge}) {
    constexpr std::size_t count = 200;
    const std::vector<double> points = queries(scene, Kind::vertex_face, count, 0x1p-8);
    for (std::size_t i = 0; i < count; ++i) {
      for (const double separation : {0.0, 0x1p-9}) {
        const ImpactOptions options{.tolerance = 1e-6, .t_max = 1, .minimum_separation = separation};
        const auto full = first_impact(Pair::vertex_face, &points[24 * i], options);
        const auto fitted = fitted_vertex_face_impact(&points[24 * i], options);
        ASSERT_EQ(fitted.has_value(), full.has_value()) << name(scene) << ' ' << i << ' ' << separation;
        if (full) {
          EXPECT_EQ(fitted->time, full->time);
        }
      }
    }
  }
}

TEST(SceneFigures, TellSizesMotionAndRest) {
  const std::array<double, 24> x = {0.5, 0, 3, 1, 0, 0, 0, 1, 0, 0, 0, 0.25,   // t = 0
                                    0.5, 0, 1, 1, 0, 0, 0, 1, 0, 0, 0, 0.25};  // t = 1: the vertex moves by 2
  SceneFigures f;
  add(f, Kind::vertex_face, x);
  EXPECT_EQ(f.queries, 1U);
  EXPECT_EQ(f.largest, 3);
  EXPECT_EQ(f.smallest, 0.25);
  EXPECT_EQ(f.difference, 3);
  EXPECT_EQ(f.displacement, 2);
  EXPECT_EQ(f.bits, 2);
  EXPECT_EQ(f.floats, 1U);
  EXPECT_EQ(f.first_at_rest, 0U);
  EXPECT_EQ(f.second_at_rest, 1U);
  auto y = x;
  y[4] = 0.1;  // 52 significant bits
  y[1] = infinity;
  add(f, Kind::vertex_face, y);
  EXPECT_EQ(f.not_finite, 1U);
  EXPECT_EQ(f.bits, 2);
  y[1] = 0;
  add(f, Kind::vertex_face, y);
  EXPECT_EQ(f.bits, 52);
  EXPECT_EQ(f.floats, 1U);
  EXPECT_EQ(f.second_at_rest, 1U);
}

TEST(SceneFigures, ASampleIsSpreadOverAllQueries) {
  for (const std::size_t capacity : {7U, 8U}) {
    SceneSample sample(Kind::edge_edge, capacity);
    for (int i = 0; i < 1000; ++i) sample.add(std::vector<double>(24, i));
    EXPECT_EQ(sample.figures().queries, 1000U);
    const std::size_t kept = sample.points().size() / 24;
    EXPECT_LE(kept, capacity);
    EXPECT_GE(kept, capacity / 2);
    const double stride = sample.points()[24];
    for (std::size_t i = 0; i < kept; ++i) EXPECT_EQ(sample.points()[24 * i], stride * static_cast<double>(i));
    EXPECT_GT(stride * static_cast<double>(kept), 999 - stride);
  }
}

TEST(RangeExponent, IsTheLeastPowerOfTwoOrNone) {
  EXPECT_EQ(range_exponent(1, false), 0);
  EXPECT_EQ(range_exponent(std::nextafter(1, 2), false), 1);
  EXPECT_EQ(range_exponent(0.75, false), 0);
  EXPECT_EQ(range_exponent(0.5, true), -1);
  EXPECT_EQ(range_exponent(0, true), 0);
  EXPECT_EQ(range_exponent(1e40, true), std::nullopt);
  EXPECT_EQ(range_exponent(0x1p301, false), std::nullopt);
  EXPECT_EQ(range_exponent(0x1p-301, false), std::nullopt);
  EXPECT_EQ(range_exponent(infinity, false), std::nullopt);
}

/// Choices depend on the machine; that they are among what the scene allows does not.
TEST(Choose, TakesWhatTheSceneAllows) {
  for (const Kind kind : both_kinds) {
    SceneSample still(kind, 200);
    still.add(queries(Scene::cloth_obstacle, kind, 200));
    EXPECT_EQ(choose(still, {}).looks.size(), 8U);  // in double precision: the coordinates are no floats
    SceneSample moving(kind, 200);
    moving.add(queries(Scene::cloth_millimetre, kind, 200));
    const Choice choice = choose(moving, {});
    EXPECT_EQ(choice.looks.size(), 4U);
    EXPECT_FALSE(choice.look.at_rest);
    EXPECT_EQ(choice.method, Method::tightrope);
    EXPECT_EQ(choice.exponent.has_value(), choice.look.range);
    if (choice.exponent) {
      EXPECT_EQ(choice.exponent, -6);
    }
    SceneSample floats(kind, 200);
    floats.add(queries(Scene::single, kind, 200));
    const Choice of_floats = choose(floats, {});
    EXPECT_TRUE(
        std::any_of(of_floats.looks.begin(), of_floats.looks.end(), [](const auto& m) { return m.look.single; }));
  }
}

TEST(Choose, FalsePositivesStayBelowWhatIsAllowed) {
  SceneSample sample(Kind::vertex_face, 400);
  sample.add(queries(Scene::near_coplanar, Kind::vertex_face, 400));
  for (const double allowed : {0.0, 1e-9, 0.01, 1.0}) {
    const Choice choice = choose(sample, {.max_false_positives = allowed, .times = false});
    EXPECT_LE(choice.false_positives, allowed);
    EXPECT_EQ(choice.methods.empty(), allowed == 0);
    const Choice with_times = choose(sample, {.max_false_positives = allowed, .times = true});
    EXPECT_EQ(with_times.method, Method::tightrope);
  }
}

}  // namespace
}  // namespace tightrope::ccd
