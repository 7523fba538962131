/// Sign erosion (MATH 6.4): the classification must not reject a contact, whichever signs it is not told. And the other
/// way round: a classification that takes uncertain signs for definite ones must be noticed by the same contacts.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "classification.exact.double.h"
#include "classification.safe.double.h"
#include "classification.safe.float.h"
#include "classification.tight.double.h"
#include "classification.tight.float.h"
#include "contacts.h"
#include "edge_edge.safe.double.h"
#include "edge_edge.safe.float.h"
#include "edge_edge.tight.double.h"
#include "edge_edge.tight.float.h"
#include "forgetful_reader.h"
#include "vertex_face.safe.double.h"
#include "vertex_face.safe.float.h"
#include "vertex_face.tight.double.h"
#include "vertex_face.tight.float.h"

// After the generated headers:
#include "ccd/classification.h"
#include "ccd/methods/exact_arithmetic.h"
#include "ccd/methods/exact_search.h"

namespace tightrope::ccd {
namespace {

using test::ContactGenerator;
using test::ForgetfulReader;
using test::Query;
using test::Random;

constexpr std::array<Kind, 2> kinds{Kind::vertex_face, Kind::edge_edge};

/// Believes values whatever their bounds are, and takes 0 for positive.
struct GullibleReader {
  template <class Real>
  Sign operator()(const Bounded<Real>& x) const {
    return x.value < 0 ? Sign::negative : Sign::positive;
  }
};

/// Believes a bound that is a given factor too small.
struct BoastfulReader {
  double factor;
  template <class Real>
  Sign operator()(const Bounded<Real>& x) const {
    return sign(Bounded<Real>{x.value, x.bound * static_cast<Real>(factor)});
  }
};

/// Contacts that the reader makes the classification reject; in single precision of those with few enough bits.
template <class Bound, class Real, class Reader>
int missed_contacts(std::uint64_t seed, int count, Reader& reader) {
  int missed = 0, tried = 0;
  for (const Kind kind : kinds) {
    ContactGenerator generator(seed);
    for (int i = 0; i < count; ++i) {
      std::array<Real, 24> points;
      if (!test::represent(generator.contact(kind), points)) continue;
      ++tried;
      missed += !collides<Bound>(kind, points.data(), reader);
    }
  }
  EXPECT_GT(tried, count);  // half of them and more
  return missed;
}

template <class Real>
class ClassificationIn : public testing::Test {};
using Reals = testing::Types<double, float>;
TYPED_TEST_SUITE(ClassificationIn, Reals);

TYPED_TEST(ClassificationIn, ErosionOfSignsRejectsNoContact) {
  for (const int percent : {2, 5, 20, 50, 90}) {
    ForgetfulReader tight(1, percent), safe(2, percent);
    EXPECT_EQ((missed_contacts<bound::tight, TypeParam>(21, 40'000, tight)), 0) << percent;
    EXPECT_EQ((missed_contacts<bound::safe, TypeParam>(22, 20'000, safe)), 0) << percent;
  }
}

TYPED_TEST(ClassificationIn, WithoutErosionNoContactIsRejected) {
  SignReader reader;
  EXPECT_EQ((missed_contacts<bound::tight, TypeParam>(23, 50'000, reader)), 0);
  EXPECT_EQ((missed_contacts<bound::safe, TypeParam>(23, 50'000, reader)), 0);
}

TYPED_TEST(ClassificationIn, TooSmallBoundsAreNoticed) {
  GullibleReader gullible;
  EXPECT_GT((missed_contacts<bound::tight, TypeParam>(24, 20'000, gullible)), 0);
  BoastfulReader zero{0};
  EXPECT_GT((missed_contacts<bound::tight, TypeParam>(24, 20'000, zero)), 0);
}

TEST(Classification, MoreErosionNeverDecidesLess) {  // rejections only get fewer, on queries that do not touch
  for (const Kind kind : kinds) {
    Random random(25);
    int last = 0;
    std::vector<Query> queries(3000);
    for (Query& query : queries) query = test::miss(kind, random);
    for (const int percent : {0, 10, 50, 100}) {
      ForgetfulReader reader(3, percent);
      int reported = 0;
      for (const Query& query : queries) reported += collides<bound::tight>(kind, query.data(), reader);
      EXPECT_GE(reported, last);
      last = reported;
    }
    EXPECT_EQ(last, 3000);  // no sign, no proof
  }
}

/// Contacts that the filter of `bsc-exact` denies, reading signs with `reader`.
template <class Reader>
int denied_contacts(std::uint64_t seed, int count, Reader reader) {
  int denied = 0;
  for (const Kind kind : kinds) {
    ContactGenerator generator(seed);
    for (int i = 0; i < count; ++i) {
      const Query query = generator.contact(kind);
      exact::FilterArithmetic<Reader> arithmetic(reader);
      const bool contact =
          with_polynomials<bound::tight>(kind, query.data(), false, [&](const auto& k, const auto& compute_quadratics) {
            const auto z = compute_quadratics();
            return exact::Search(arithmetic, z).contact(exact::values(k));
          });
      denied += !contact && !arithmetic.gave_up();
    }
  }
  return denied;
}

TEST(Classification, TheFilterOfExactSignsDeniesNoContactUnlessItsBoundsAreTooSmall) {
  EXPECT_EQ(denied_contacts(30, 20'000, SignReader{}), 0);
  EXPECT_GT(denied_contacts(30, 20'000, BoastfulReader{0}), 0);
  EXPECT_GT(denied_contacts(30, 20'000, GullibleReader{}), 0);
}

TEST(Classification, AnAxisSeparatesOnlyWhatStaysOnOneSideOfIt) {
  SignReader reader;
  for (const Kind kind : kinds) {
    Random random(28);
    for (int i = 0; i < 1000; ++i) {
      Query query = test::miss(kind, random);
      EXPECT_TRUE(separated(kind, query.data(), reader));
      for (const std::size_t axis : {0U, 1U, 2U}) {  // where it touches: at one point of the boundary, at one time
        const std::size_t end = 12 * static_cast<std::size_t>(random.whole(0, 1));
        query[end + axis] = query[end + 9 + axis];
      }
      EXPECT_FALSE(separated(kind, query.data(), reader));
    }
    ContactGenerator generator(29);
    for (int i = 0; i < 50'000; ++i) ASSERT_FALSE(separated(kind, generator.contact(kind).data(), reader));
  }
}

template <class Real>
class RescalingIn : public testing::Test {
 protected:
  static Real power(int exponent) { return std::ldexp(Real{1}, exponent); }
  static constexpr int largest_exponent = std::numeric_limits<Real>::max_exponent;
};
TYPED_TEST_SUITE(RescalingIn, Reals);

TYPED_TEST(RescalingIn, IsExactAndKeepsSigns) {
  using Real = TypeParam;
  constexpr int spread = sizeof(Real) == 8 ? 400 : 40;
  Random random(26);
  for (int i = 0; i < 100'000; ++i) {
    std::array<Bounded<Real>, 3> tuple, scaled;
    for (Bounded<Real>& x : tuple) {
      x.value = static_cast<Real>(std::ldexp(2 * random.unit() - 1, random.whole(-spread, spread)));
      x.bound = random.chance(20) ? 0 : static_cast<Real>(std::ldexp(random.unit(), random.whole(-spread, spread)));
    }
    scaled = tuple;
    ASSERT_TRUE(rescale(scaled));
    Real largest = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      largest = std::max({largest, std::fabs(scaled[j].value), scaled[j].bound});
      const int exponent = std::ilogb(tuple[j].value == 0 ? 1 : scaled[j].value / tuple[j].value);
      EXPECT_EQ(scaled[j].value, std::ldexp(tuple[j].value, exponent));
      EXPECT_GE(scaled[j].bound, std::ldexp(tuple[j].bound, exponent));
      EXPECT_EQ(sign(scaled[j]), sign(tuple[j]));
    }
    EXPECT_GE(largest, 0.5);
    EXPECT_LE(largest, 1);
  }
}

TYPED_TEST(RescalingIn, CoversWhatUnderflowLoses) {
  using Real = TypeParam;
  constexpr int up = sizeof(Real) == 8 ? 800 : 100, down = sizeof(Real) == 8 ? -270 : -45;
  std::array<Bounded<Real>, 2> tuple{{{this->power(up), 0}, {Real{1.5} * this->power(down), 0}}};
  ASSERT_TRUE(rescale(tuple));
  EXPECT_GT(tuple[1].bound, 0);
  EXPECT_LT(std::fabs(tuple[1].value - Real{1.5} * this->power(down - up - 1)), tuple[1].bound);
  EXPECT_EQ(sign(tuple[1]), Sign::uncertain);
}

TYPED_TEST(RescalingIn, RefusesWhatIsNotFiniteOrTooLarge) {
  using Real = TypeParam;
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  for (const Real bad : {infinity, -infinity, std::numeric_limits<Real>::quiet_NaN(), rescaling_limit<Real>}) {
    std::array<Bounded<Real>, 2> value{{{1, 0}, {bad, 0}}}, bound{{{1, 0}, {1, std::fabs(bad)}}};
    EXPECT_FALSE(rescale(value));
    EXPECT_FALSE(rescale(bound));
  }
  std::array<Bounded<Real>, 2> zero{{{0, 0}, {0, 0}}};
  EXPECT_TRUE(rescale(zero));
  EXPECT_EQ(zero[0].value, 0);
}

TYPED_TEST(RescalingIn, ScaleToOneTakesEveryBinadeThere) {
  using Real = TypeParam;
  for (int exponent = std::numeric_limits<Real>::min_exponent; exponent <= this->largest_exponent - 2; ++exponent) {
    for (const Real x : {this->power(exponent - 1), std::nextafter(this->power(exponent), Real{0})}) {
      EXPECT_GE(x * scale_to_one(x), 0.5) << x;
      EXPECT_LT(x * scale_to_one(x), 1) << x;
    }
  }
  EXPECT_LT(std::numeric_limits<Real>::denorm_min() * scale_to_one(std::numeric_limits<Real>::denorm_min()), 1);
  EXPECT_GT(scale_to_one(std::numeric_limits<Real>::denorm_min()), 0);
}

TYPED_TEST(RescalingIn, NormalizationIsAnExactScalingToASpreadNearOne) {
  using Real = TypeParam;
  constexpr int digits = std::numeric_limits<Real>::digits;
  constexpr int scale = sizeof(Real) == 8 ? 1000 : 90;
  Random random(27);
  for (int i = 0; i < 20'000; ++i) {
    std::array<Real, 24> query;
    const int exponent = random.whole(-scale, scale), offset = random.whole(0, digits - 13);
    for (Real& x : query) {
      x = static_cast<Real>(std::ldexp(random.whole(-1000, 1000) + std::ldexp(1, offset), exponent - 20));
    }
    if (random.chance(30)) {
      for (std::size_t point = 0; point < 4; ++point) query[3 * point] = static_cast<Real>(std::ldexp(1.25, exponent));
    }
    const auto normalized = normalize(query.data());
    ASSERT_EQ(normalized.kind, NormalizedQuery<Real>::Kind::scaled);
    const Real size = spread(normalized.points.data());
    EXPECT_GE(size, 0.5);
    EXPECT_LT(size, 1);
    const Real factor = size / spread(query.data());
    for (std::size_t j = 0; j < 24; ++j) {
      EXPECT_LE(std::fabs(normalized.points[j]), this->power(digits + 1));
      if (normalized.points[j] != 0) {
        EXPECT_EQ(normalized.points[j], query[j] * factor);
      }
    }
  }
}

TEST(Geometry, GuessOfTheExtremumIsOneForValleysAndHills) {
  for (int q0 = 1; q0 <= 5; ++q0) {
    for (int q1 = -5; q1 <= 5; ++q1) {
      for (int q2 = 1; q2 <= 5; ++q2) {
        for (const int up : {1, -1}) {
          const auto exact = [](int x) { return Bounded<double>{static_cast<double>(x), 0}; };
          const double t = guess_extremum<double>({exact(-up * q0), exact(up * q1), exact(up * q2)});
          EXPECT_NEAR(-q0 * (1 - t) * (1 - t) + 2 * q1 * t * (1 - t) + q2 * t * t, 0, 1e-14);
        }
      }
    }
  }
}

}  // namespace
}  // namespace tightrope::ccd
