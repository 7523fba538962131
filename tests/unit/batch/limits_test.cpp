/// The conditions of the vector tests: beyond 2^32 (2^53), and where the points are closer than 2^-20 (2^-100), the
/// function for one query widens its bounds. Answers show that only where a value is within a thousandth of its bound.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "ccd/geometry.h"
#include "tightrope/batch.h"

namespace tightrope::ccd {
namespace {

constexpr std::size_t numbers = 24;
using Vector = std::array<double, 3>;

Vector sum(const Vector& a, double factor, const Vector& b) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}

/// Features that overlap when seen along their normal, about as far apart at t = 0 as rounding can tell, farther later.
std::array<float, numbers> departing(Kind kind, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto any = [&] { return Vector{uniform(random), uniform(random), uniform(random)}; };
  const Vector middle = any(), u = any(), v = any();
  const Vector n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const double apart =
      (1 + uniform(random)) * (random() % 2 == 0 ? 0x1p-20 : 0x1p-15);  // bounds: TightBound, SafeBound
  std::array<Vector, 4> points;
  std::size_t moving;
  if (kind == Kind::vertex_face) {
    points = {middle, sum(middle, 1, u), sum(middle, 1, v), sum(sum(middle, -1, u), -1, v)};
    moving = 1;
  } else {
    points = {sum(middle, -1, u), sum(middle, 1, u), sum(middle, -1, v), sum(middle, 1, v)};
    moving = 2;
  }
  std::array<float, numbers> query;
  float* next = query.data();
  for (const double distance : {apart, 1.0}) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (const double x : sum(points[i], i < moving ? distance : 0, n)) *next++ = static_cast<float>(x);
    }
  }
  return query;
}

/// Scaled by the power of two that takes `size` into (limit / 2, limit].
void scale(std::span<float, numbers> query, float size, float limit) {
  int exponent = 0;
  const float mantissa = std::frexp(limit / size, &exponent);
  if (mantissa < 0.5F) return;
  for (float& x : query) x = std::ldexp(x, exponent - 1);
}

float largest(std::span<const float, numbers> query) {
  float result = 0;
  for (const float x : query) result = std::max(result, std::fabs(x));
  return result;
}

void expect_same(Kind kind, const std::vector<float>& points) {
  const std::size_t count = points.size() / numbers;
  const Queries<float> queries{kind, count, points.data()};
  std::vector<unsigned char> expected(count), answers(count);
  for (const Method method : {Method::bsc_float, Method::bsc_safe, Method::tight, Method::safe, Method::safe_tight}) {
    collides(kind, points.data(), count, expected.data(), method);
    const auto contacts = std::count(expected.begin(), expected.end(), 1);
    EXPECT_GT(contacts, 100) << name(method);
    EXPECT_LT(contacts, static_cast<std::ptrdiff_t>(count) - 100) << name(method);
    for (const InstructionSet instructions : instruction_sets()) {
      ASSERT_EQ(collides(queries, answers.data(), {.method = method, .instructions = instructions}), BatchStatus::done);
      EXPECT_EQ(answers, expected) << name(method) << ' ' << name(instructions);
    }
  }
}

constexpr std::size_t count = 30'000;

TEST(BatchLimits, LargeCoordinatesAreLeftToTheFunctionForOneQuery) {
  std::mt19937_64 random(21);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    std::vector<float> points;
    for (std::size_t i = 0; i < count; ++i) {
      auto query = departing(kind, random);
      scale(query, largest(query), 0x1p33F);
      ASSERT_FALSE(has_moderate_coordinates(query.data()) && largest(query) < 0x1p32F);
      points.insert(points.end(), query.begin(), query.end());
    }
    expect_same(kind, points);
  }
}

TEST(BatchLimits, BoundsAreThoseOfTheSameNamesOfPoints) {
  std::mt19937_64 random(20);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    std::vector<float> points;
    for (std::size_t i = 0; i < count; ++i) {
      const auto query = departing(kind, random);
      points.insert(points.end(), query.begin(), query.end());
    }
    expect_same(kind, points);
  }
}

TEST(BatchLimits, PointsCloseTogetherAreLeftToTheFunctionForOneQuery) {
  std::mt19937_64 random(22);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    std::vector<float> points;
    for (std::size_t i = 0; i < count; ++i) {
      auto query = departing(kind, random);
      scale(query, spread(query.data()), least_spread<float>);
      ASSERT_LE(spread(query.data()), least_spread<float>);
      points.insert(points.end(), query.begin(), query.end());
    }
    expect_same(kind, points);
  }
}

}  // namespace
}  // namespace tightrope::ccd
