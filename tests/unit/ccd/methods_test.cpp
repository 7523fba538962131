/// The methods on contacts that are exact by construction: never a false negative, whatever the units, the names of the
/// points or the direction of time.

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

constexpr std::array<Kind, 2> kinds{Kind::vertex_face, Kind::edge_edge};
constexpr std::array<Method, 2> conservative_methods{Method::bsc_safe, Method::tight};

std::string text(Kind kind, Method method, const Query& query) {
  std::string result = std::string(name(kind)) + " " + std::string(name(method));
  for (std::size_t i = 0; i < query.size(); ++i) {
    char number[40];
    std::snprintf(number, sizeof number, "%s%a", i % 3 == 0 ? "\n  " : ", ", query[i]);
    result += number;
  }
  return result;
}

/// Applies `change` to contacts and expects that the answer stays "collides".
template <class Change>
void expect_contacts(std::uint64_t seed, int count, const Change& change) {
  for (const Kind kind : kinds) {
    ContactGenerator generator(seed);
    for (int i = 0; i < count; ++i) {
      Query query = generator.contact(kind);
      change(kind, generator.random(), query);
      for (const Method method : conservative_methods) {
        ASSERT_TRUE(collides(kind, query.data(), method)) << text(kind, method, query);
      }
    }
  }
}

std::array<double*, 2> point(Query& query, std::size_t index) { return {&query[3 * index], &query[12 + 3 * index]}; }

void swap_points(Query& query, std::size_t i, std::size_t j) {
  for (std::size_t end = 0; end < 2; ++end) {
    std::swap_ranges(point(query, i)[end], point(query, i)[end] + 3, point(query, j)[end]);
  }
}

TEST(Methods, ReportEveryContact) {
  expect_contacts(1, 200'000, [](Kind, Random&, Query&) {});
}

TEST(Methods, ReportContactsInAnyUnits) {
  expect_contacts(2, 50'000, [](Kind, Random& random, Query& query) {
    const int exponent = random.whole(-1000, 980);  // coordinates below 2^24 and above 2^-8
    for (double& x : query) x = std::ldexp(x, exponent);
  });
}

TEST(Methods, ReportContactsFarFromTheOrigin) {
  expect_contacts(3, 50'000, [](Kind, Random& random, Query& query) {
    for (std::size_t i = 0; i < query.size(); ++i) query[i] = std::ldexp(query[i], -10);
    const int exponent = random.whole(0, 16);  // exact: no bit below 2^-20, none above 2^17
    for (std::size_t i = 0; i < 3; ++i) {
      const double offset = std::ldexp(random.whole(-1, 1), exponent);
      for (std::size_t point = 0; point < 8; ++point) query[3 * point + i] += offset;
    }
  });
}

TEST(Methods, ReportContactsUnderRenamingAndTimeReversal) {
  expect_contacts(4, 100'000, [](Kind kind, Random& random, Query& query) {
    if (random.chance(50)) std::swap_ranges(query.begin(), query.begin() + 12, query.begin() + 12);
    switch (kind) {
      case Kind::vertex_face:
        if (random.chance(50)) swap_points(query, 1, 2);
        if (random.chance(50)) swap_points(query, 2, 3);
        break;
      case Kind::edge_edge:
        if (random.chance(50)) swap_points(query, 0, 1);
        if (random.chance(50)) swap_points(query, 2, 3);
        if (random.chance(50)) {
          swap_points(query, 0, 2);
          swap_points(query, 1, 3);
        }
        break;
    }
  });
}

TEST(Methods, PlainFloatingPointMissesContacts) {  // the contacts are hard: without bounds they are not all seen
  for (const Kind kind : kinds) {
    ContactGenerator generator(5);
    int missed = 0;
    for (int i = 0; i < 20'000; ++i) missed += !collides(kind, generator.contact(kind).data(), Method::bsc_float);
    EXPECT_GT(missed, 0) << name(kind);
  }
}

TEST(Methods, RejectPointsThatAreApart) {
  for (const Kind kind : kinds) {
    Random random(6);
    for (const MethodInfo& info : methods()) {
      int reported = 0;
      for (int i = 0; i < 20'000; ++i) reported += collides(kind, test::miss(kind, random).data(), info.method);
      EXPECT_LE(reported, 2) << info.name << ' ' << name(kind);
    }
  }
}

TEST(Methods, AnswersDoNotDependOnUnits) {
  for (const Kind kind : kinds) {
    Random random(7);
    for (int i = 0; i < 3'000; ++i) {
      Query query;
      for (double& x : query) x = 2 * random.unit() - 1;
      for (const MethodInfo& info : methods()) {
        const bool answer = collides(kind, query.data(), info.method);
        for (int exponent = -900; exponent <= 900; exponent += 100) {
          Query scaled = query;
          for (double& x : scaled) x = std::ldexp(x, exponent);
          ASSERT_EQ(collides(kind, scaled.data(), info.method), answer)
              << exponent << ' ' << text(kind, info.method, query);
        }
      }
    }
  }
}

TEST(Methods, AnswersOfCertainQueriesDoNotDependOnTheDirectionOfTime) {
  for (const Kind kind : kinds) {
    Random random(8);
    for (int i = 0; i < 20'000; ++i) {
      Query query;
      for (double& x : query) x = 2 * random.unit() - 1;
      Query reversed = query;
      std::swap_ranges(reversed.begin(), reversed.begin() + 12, reversed.begin() + 12);
      ASSERT_EQ(collides(kind, query.data()), collides(kind, reversed.data())) << text(kind, Method::tight, query);
    }
  }
}

TEST(Methods, CoordinatesThatAreNotFiniteCollide) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const Kind kind : kinds) {
    Random random(9);
    for (const MethodInfo& info : methods()) {
      for (const double bad : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity}) {
        for (std::size_t i = 0; i < 24; ++i) {
          Query query = test::miss(kind, random);
          query[i] = bad;
          EXPECT_TRUE(collides(kind, query.data(), info.method)) << text(kind, info.method, query);
        }
      }
    }
  }
}

TEST(Methods, LargestAndSmallestCoordinatesAreDecided) {
  for (const Kind kind : kinds) {
    Random random(10);
    for (const Method method : conservative_methods) {
      for (const double size : {std::numeric_limits<double>::max() / 4, 0x1p-1020, 0x1p-1060}) {
        int reported = 0;
        for (int i = 0; i < 1000; ++i) {
          Query query = test::miss(kind, random);
          for (double& x : query) x *= size;
          reported += collides(kind, query.data(), method);
        }
        EXPECT_LE(reported, size < 0x1p-1022 ? 100 : 1) << name(kind) << ' ' << name(method) << ' ' << size;
      }
    }
  }
}

// Coordinates 2^2000 apart in size: scaling them to one another's size loses the small ones, which the bounds must
// know.
TEST(Methods, ReportContactsOfPointsWithTinyAndHugeCoordinates) {
  expect_contacts(11, 50'000, [](Kind, Random& random, Query& query) {
    std::array<int, 3> exponents{};
    for (int& exponent : exponents) exponent = random.chance(50) ? random.whole(-1040, -950) : random.whole(900, 980);
    for (std::size_t i = 0; i < query.size(); ++i) query[i] = std::ldexp(query[i], exponents[i % 3]);
  });
}

TEST(Methods, FourPointsInOnePlaceCollide) {
  for (const Kind kind : kinds) {
    for (const double x : {0.0, 1.0, 1e300, 5e-324, -3e-200}) {
      Query query;
      query.fill(x);
      for (const MethodInfo& info : methods()) EXPECT_TRUE(collides(kind, query.data(), info.method)) << x;
    }
  }
}

}  // namespace
}  // namespace tightrope::ccd
