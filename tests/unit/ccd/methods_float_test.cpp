/// The methods in single precision on contacts that are exact by construction: as sound as in double, over the whole
/// range of exponents, although the classification's polynomials are of degree 24.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "contacts.h"
#include "tightrope/ccd.h"

namespace tightrope::ccd {
namespace {

using test::ContactGenerator;
using test::Query;
using test::Random;

using FloatQuery = std::array<float, 24>;
constexpr std::array<Kind, 2> kinds{Kind::vertex_face, Kind::edge_edge};

/// Applies `change` to contacts, and where the result is exact in single precision expects the answer "collides".
template <class Change>
void expect_contacts(std::uint64_t seed, int count, const Change& change) {
  for (const Kind kind : kinds) {
    ContactGenerator generator(seed);
    int tried = 0;
    for (int i = 0; i < count; ++i) {
      Query query = generator.contact(kind);
      change(generator.random(), query);
      FloatQuery points;
      if (!test::represent(query, points)) continue;
      ++tried;
      for (const MethodInfo& info : methods()) {
        if (info.conservative && !info.exact) {  // bsc_exact_test.cpp has those
          ASSERT_TRUE(collides(kind, points.data(), info.method)) << info.name << ' ' << name(kind) << ' ' << i;
        }
      }
    }
    EXPECT_GT(tried, count / 4);
  }
}

TEST(MethodsInFloat, ReportEveryContact) {
  expect_contacts(41, 200'000, [](Random&, Query&) {});
}

TEST(MethodsInFloat, ReportContactsInAnyUnits) {
  expect_contacts(42, 100'000, [](Random& random, Query& query) {
    const int exponent = random.whole(-150, 100);  // coordinates below 2^27, whole multiples of 2^-7 and more
    for (double& x : query) x = std::ldexp(x, exponent);
  });
}

TEST(MethodsInFloat, ReportContactsFarFromTheOrigin) {
  expect_contacts(43, 100'000, [](Random& random, Query& query) {
    const int exponent = random.whole(0, 22);
    for (std::size_t i = 0; i < 3; ++i) {
      const double offset = std::ldexp(random.whole(-1, 1), exponent);
      for (std::size_t point = 0; point < 8; ++point) query[3 * point + i] += offset;
    }
  });
}

TEST(MethodsInFloat, ReportContactsOfPointsWithTinyAndHugeCoordinates) {
  expect_contacts(44, 100'000, [](Random& random, Query& query) {
    std::array<int, 3> exponents{};
    for (int& exponent : exponents) exponent = random.chance(50) ? random.whole(-140, -100) : random.whole(70, 100);
    for (std::size_t i = 0; i < query.size(); ++i) query[i] = std::ldexp(query[i], exponents[i % 3]);
  });
}

TEST(MethodsInFloat, PlainFloatingPointMissesContacts) {
  for (const Kind kind : kinds) {
    ContactGenerator generator(45);
    int missed = 0;
    for (int i = 0; i < 20'000; ++i) {
      FloatQuery points;
      if (test::represent(generator.contact(kind), points)) missed += !collides(kind, points.data(), Method::bsc_float);
    }
    EXPECT_GT(missed, 0) << name(kind);
  }
}

TEST(MethodsInFloat, AnswersDependLittleOnUnits) {  // only by the bounds' growth of 2^-10 where points are normalised
  for (const Kind kind : kinds) {
    Random random(46);
    int answers = 0, different = 0;
    for (int i = 0; i < 3'000; ++i) {
      FloatQuery query;
      for (float& x : query) x = static_cast<float>(random.whole(-(1 << 20), 1 << 20));
      for (const MethodInfo& info : methods()) {
        const bool answer = collides(kind, query.data(), info.method);
        for (int exponent = -140; exponent <= 100; exponent += 20) {
          FloatQuery scaled = query;
          for (float& x : scaled) x = std::ldexp(x, exponent);
          answers += 1;
          different += collides(kind, scaled.data(), info.method) != answer;
        }
      }
    }
    EXPECT_LE(different, answers / 2000) << name(kind);
  }
}

TEST(MethodsInFloat, CoordinatesThatAreNotFiniteCollide) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (const Kind kind : kinds) {
    Random random(47);
    for (const MethodInfo& info : methods()) {
      for (const float bad : {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity}) {
        for (std::size_t i = 0; i < 24; ++i) {
          const Query apart = test::miss(kind, random);
          FloatQuery query;
          for (std::size_t j = 0; j < 24; ++j) query[j] = static_cast<float>(apart[j]);
          query[i] = bad;
          EXPECT_TRUE(collides(kind, query.data(), info.method)) << info.name << ' ' << i;
        }
      }
    }
  }
}

TEST(MethodsInFloat, LargestAndSmallestCoordinatesAreDecided) {
  for (const Kind kind : kinds) {
    Random random(48);
    for (const MethodInfo& info : methods()) {
      for (const float size : {std::numeric_limits<float>::max() / 4, 0x1p-120F}) {
        int reported = 0;
        for (int i = 0; i < 1000; ++i) {
          const Query apart = test::miss(kind, random);
          FloatQuery query;
          for (std::size_t j = 0; j < 24; ++j) query[j] = static_cast<float>(apart[j]) * size;
          reported += collides(kind, query.data(), info.method);
        }
        EXPECT_LE(reported, 10) << name(kind) << ' ' << info.name << ' ' << size;
      }
    }
  }
}

TEST(MethodsInFloat, FourPointsInOnePlaceCollide) {
  for (const Kind kind : kinds) {
    for (const float x : {0.0F, 1.0F, 1e38F, 1e-45F, -3e-30F}) {
      FloatQuery query;
      query.fill(x);
      for (const MethodInfo& info : methods()) EXPECT_TRUE(collides(kind, query.data(), info.method)) << x;
    }
  }
}

}  // namespace
}  // namespace tightrope::ccd
