/// SafeCCD: never a false negative, where the published method has its holes above all; and the pieces that the proof
/// rests on, each against exact arithmetic and with a weakened variant that is noticed.

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "ccd/methods/safe_query.h"
#include "ccd/sign_reader.h"
#include "contacts.h"
#include "edge_edge.safe.double.h"
#include "edge_edge.safe.float.h"
#include "edge_edge.tight.double.h"
#include "edge_edge.tight.float.h"
#include "forgetful_reader.h"
#include "oracle/oracle.h"
#include "safe_cubic.float.double.h"
#include "safe_cubic.float.float.h"
#include "safe_cubic.safe.double.h"
#include "safe_cubic.safe.float.h"
#include "safe_cubic.tight.double.h"
#include "safe_cubic.tight.float.h"
#include "safe_culling.safe.double.h"
#include "safe_culling.safe.float.h"
#include "safe_culling.tight.double.h"
#include "safe_culling.tight.float.h"
#include "safe_inside.float.double.h"
#include "safe_inside.float.float.h"
#include "safe_inside.safe.double.h"
#include "safe_inside.safe.float.h"
#include "safe_inside.tight.double.h"
#include "safe_inside.tight.float.h"
#include "tightrope/contact.h"
#include "vertex_face.safe.double.h"
#include "vertex_face.safe.float.h"
#include "vertex_face.tight.double.h"
#include "vertex_face.tight.float.h"

namespace tightrope::ccd {
namespace {

using test::ContactGenerator;
using test::ForgetfulReader;
using test::Query;
using test::Random;
using FloatQuery = std::array<float, 24>;

constexpr std::array<Kind, 2> kinds{Kind::vertex_face, Kind::edge_edge};
constexpr std::array<Method, 2> safe_methods{Method::safe, Method::safe_tight};

// --- The holes of the published method ---------------------------------------------------------------------------

struct Hole {
  const char* what;
  Kind kind;
  Query points;
};

/// Contacts for which its gates skip the test that would find them: |N| < tau leaves the query to vertex-edge, which
/// asks |x_ji|^2 > lambda^2, and vertex-vertex looks at (0, 1) and at t = 1 with thresholds that vanish or overflow.
const std::vector<Hole>& holes() {
  static const std::vector<Hole> all{
      {"vertex meets a vertex of a triangle collapsed to a segment",
       Kind::vertex_face,
       {2, 0, 0, 0, 0, 0, 1, 0, 0, 0.5, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0.5, 0, 0}},
      {"vertex meets the inside of a collapsed triangle, moving along its line",
       Kind::vertex_face,
       {2, 2, 2, -1, -1, -1, 0, 0, 0, 1, 1, 1, 0.5, 0.5, 0.5, -1, -1, -1, 0, 0, 0, 1, 1, 1}},
      {"vertex meets a triangle collapsed to a point", Kind::vertex_face, {-1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                                                                           1,  0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}},
      {"vertex touches a collapsed triangle at t = 0 only",
       Kind::vertex_face,
       {0.25, 0, 0, 0, 0, 0, 1, 0, 0, 0.5, 0, 0, 0.25, 1, 0, 0, 0, 0, 1, 0, 0, 0.5, 0, 0}},
      {"triangle collapses to a segment as the vertex meets it",
       Kind::vertex_face,
       {0, 0, 1, -1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, -1, -1, 0, 0, 1, 0, 0, 0, -1, 0}},
      {"points of zero-length edges meet", Kind::edge_edge, {-1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 0, 0,
                                                             1,  0, 0, 1,  0, 0, 0, 0, 0, 0, 0, 0}},
      {"zero-length edge meets an edge's inside", Kind::edge_edge, {0.5, 0, 1,  0.5, 0, 1,  0, 0, 0, 1, 0, 0,
                                                                    0.5, 0, -1, 0.5, 0, -1, 0, 0, 0, 1, 0, 0}},
      {"collinear edges meet end to end, moving along their line",
       Kind::edge_edge,
       {2, 2, 2, 3, 3, 3, 0, 0, 0, 1, 1, 1, 1, 1, 1, 2, 2, 2, 0, 0, 0, 1, 1, 1}},
      {"parallel edges meet sideways", Kind::edge_edge, {0.5, 1,  0, 1.5, 1,  0, 0, 0, 0, 1, 0, 0,
                                                         0.5, -1, 0, 1.5, -1, 0, 0, 0, 0, 1, 0, 0}},
      {"overlapping edges part at once", Kind::edge_edge, {0.5, 0, 0, 1.5, 0, 0, 0, 0, 0, 1, 0, 0,
                                                           0.5, 1, 0, 1.5, 1, 0, 0, 0, 0, 1, 0, 0}},
      {"edges share an end all the time", Kind::edge_edge, {0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0,
                                                            1, 1, 1, 2, 1, 1, 1, 1, 1, 1, 2, 1}},
  };
  return all;
}

TEST(SafeHoles, AreContactsAndClosed) {
  for (const Hole& hole : holes()) {
    EXPECT_TRUE(oracle::contact(hole.kind, hole.points)) << hole.what;
    for (const Method method : safe_methods) {
      for (int exponent = -900; exponent <= 900; exponent += 60) {
        Query scaled;
        for (std::size_t i = 0; i < 24; ++i) scaled[i] = std::ldexp(hole.points[i], exponent);
        EXPECT_TRUE(collides(hole.kind, scaled.data(), method))
            << name(method) << ": " << hole.what << " * 2^" << exponent;
      }
      for (int exponent = -140; exponent <= 120; exponent += 20) {
        FloatQuery scaled;
        for (std::size_t i = 0; i < 24; ++i) scaled[i] = std::ldexp(static_cast<float>(hole.points[i]), exponent);
        EXPECT_TRUE(collides(hole.kind, scaled.data(), method))
            << name(method) << ": " << hole.what << " * 2^" << exponent;
      }
    }
  }
}

/// The same situations a quarter beside each other in z are free, and said to be: closing the holes by answering `true`
/// whenever something degenerates would be easy.
TEST(SafeHoles, AreNotClosedByAnsweringTrue) {
  for (const Hole& hole : holes()) {
    Query moved = hole.points;
    const std::size_t first = hole.kind == Kind::vertex_face ? 1 : 2;
    for (std::size_t end = 0; end < 2; ++end) {
      for (std::size_t i = 0; i < first; ++i) {
        moved[12 * end + 3 * i] -= 0.125;
        moved[12 * end + 3 * i + 1] += 4;
      }
    }
    ASSERT_FALSE(oracle::contact(hole.kind, moved)) << hole.what;
    for (const Method method : safe_methods) EXPECT_FALSE(collides(hole.kind, moved.data(), method)) << hole.what;
  }
}

// --- Contacts that are exact by construction ---------------------------------------------------------------------

TEST(Safe, ReportsEveryContact) {
  for (const Kind kind : kinds) {
    ContactGenerator generator(31);
    for (int i = 0; i < 40'000; ++i) {
      const Query query = generator.contact(kind);
      for (const Method method : safe_methods) ASSERT_TRUE(collides(kind, query.data(), method)) << name(method) << i;
    }
  }
}

TEST(Safe, ReportsContactsInAnyUnitsAndFarFromTheOrigin) {
  for (const Kind kind : kinds) {
    ContactGenerator generator(32);
    for (int i = 0; i < 20'000; ++i) {
      Query query = generator.contact(kind);
      const double offset = generator.random().whole(-1, 1) * 0x1p22;  // exact: no bit below 2^-10
      const int exponent = generator.random().whole(-1000, 980);
      for (double& x : query) x = std::ldexp(x + offset, exponent);
      for (const Method method : safe_methods) ASSERT_TRUE(collides(kind, query.data(), method)) << name(method) << i;
    }
  }
}

// --- The decision with signs forgotten or invented ---------------------------------------------------------------

/// Believes a bound that is a given factor too small.
struct Boastful {
  double factor;
  template <class Real>
  Sign operator()(const Bounded<Real>& x) const {
    return sign(Bounded<Real>{x.value, static_cast<Real>(x.bound * factor)});
  }
};

template <class Bound, class Real, class Reader>
int missed(std::uint64_t seed, int count, Reader& reader) {
  int result = 0;
  for (const Kind kind : kinds) {
    ContactGenerator generator(seed);
    for (int i = 0; i < count; ++i) {
      const Query query = generator.contact(kind);
      std::array<Real, 24> points;
      if constexpr (sizeof(Real) == 8) {
        points = query;
      } else if (!test::represent(query, points)) {
        continue;
      }
      result += !safe::collides<Bound>(kind, points.data(), reader);
    }
  }
  return result;
}

TEST(SafeErosion, ForgottenSignsRejectNoContact) {
  for (const int percent : {2, 10, 40, 90}) {
    ForgetfulReader reader(33, percent);
    EXPECT_EQ((missed<bound::safe, double>(34, 4'000, reader)), 0) << percent;
    EXPECT_EQ((missed<bound::tight, double>(35, 4'000, reader)), 0) << percent;
    EXPECT_EQ((missed<bound::safe, float>(36, 4'000, reader)), 0) << percent;
    EXPECT_EQ((missed<bound::tight, float>(37, 4'000, reader)), 0) << percent;
  }
}

TEST(SafeErosion, TooSmallBoundsAreNoticed) {
  Boastful honest{1}, none{0};
  EXPECT_EQ((missed<bound::safe, double>(38, 10'000, honest)), 0);
  EXPECT_GT((missed<bound::safe, double>(38, 10'000, none)), 0);
  EXPECT_GT((missed<bound::tight, double>(38, 10'000, none)), 0);
  EXPECT_GT((missed<bound::tight, float>(38, 10'000, none)), 0);
}

// --- Quadratic solver [Wang 2014, Appendix A] ---------------------------------------------------------------------

TEST(SafeQuadratic, KeepsTheErrorsOfAppendixA) {
  Random random(41);
  constexpr double eps = 0x1p-52;
  for (int i = 0; i < 100'000; ++i) {
    // a (t - r) (t - s) with exact dyadic roots, the double root among them; Bernstein coefficients are exact.
    const int bits = random.whole(2, 20);
    const double r = random.whole(1, (1 << bits) - 1) / std::ldexp(1.0, bits);
    const double s = random.chance(30) ? r : random.whole(1, (1 << bits) - 1) / std::ldexp(1.0, bits);
    const double a = random.chance(50) ? 1 : -1;
    const std::array<double, 3> q{a * r * s, a * (r * s - (r + s) / 2), a * (1 - r) * (1 - s)};
    const auto roots = safe::quadratic_roots(q);
    ASSERT_EQ(roots.count, 2U);
    EXPECT_NEAR(roots.t[0], std::min(r, s), 2 * std::sqrt(eps) + 8 * eps);
    EXPECT_NEAR(roots.t[1], std::max(r, s), 2 * std::sqrt(eps) + 8 * eps);
    for (const double t : roots.t) {
      const double residual = (t - r) * (t - s);
      EXPECT_LE(std::fabs(residual), 16 * 2 * eps);  // 16 B eps, the power coefficients being at most B = 2
    }
  }
}

TEST(SafeQuadratic, ClampsTheDiscriminantAndSurvivesDegenerateCoefficients) {
  const auto extremum = safe::quadratic_roots<double>({1, 0.5, 1});  // discriminant below 0: the extremum
  ASSERT_EQ(extremum.count, 1U);
  EXPECT_EQ(extremum.t[0], 0.5);
  const auto line = safe::quadratic_roots<double>({-1, 0, 1});  // a = 0
  ASSERT_EQ(line.count, 1U);
  EXPECT_EQ(line.t[0], 0.5);
  EXPECT_EQ(safe::quadratic_roots<double>({0, 0, 0}).count, 0U);
  EXPECT_EQ(safe::quadratic_roots<double>({1, 1, 1}).count, 0U);
}

// --- Cubic solver: Lemmas S1 and S2 ------------------------------------------------------------------------------

using Coefficients = std::array<Bounded<double>, 4>;

mpq_class exact_value(const Coefficients& k, double at) {
  const mpq_class t(at), s = 1 - t;
  return mpq_class(k[0].value) * s * s * s + 3 * mpq_class(k[1].value) * s * s * t +
         3 * mpq_class(k[2].value) * s * t * t + mpq_class(k[3].value) * t * t * t;
}

Coefficients random_cubic(Random& random) {
  Coefficients k;
  for (Bounded<double>& x : k) x = {2 * random.unit() - 1, 0};
  return k;
}

template <class Bound>
double largest_error_to_bound(double factor) {
  Random random(43);
  double largest = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Coefficients k = random_cubic(random);
    const double t = random.unit();
    const Bounded<double> y = safe::Cubic<Bound, double>(k)(t);
    const mpq_class error = abs(exact_value(k, t) - mpq_class(y.value));
    largest = std::max(largest, error.get_d() / (factor * y.bound));
  }
  return largest;
}

TEST(SafeCubic, BoundsOfValuesHold) {
  EXPECT_LE(largest_error_to_bound<bound::safe>(1), 1);
  EXPECT_LE(largest_error_to_bound<bound::tight>(1), 1);
  EXPECT_GT(largest_error_to_bound<bound::safe>(1.0 / 32), 1);  // a bound of a thirty-second part is noticed
  EXPECT_GT(largest_error_to_bound<bound::tight>(1.0 / 8), 1);
}

/// A cubic with the roots r, in float precision so that its Bernstein coefficients are exact in double.
Coefficients cubic_with_roots(const std::array<double, 3>& r) {
  const auto symmetric = [&](double x, double y, double z) { return x * y * z; };
  const double a = r[0], b = r[1], c = r[2], A = 1 - a, B = 1 - b, C = 1 - c;
  const double k1 = symmetric(A, -b, -c) + symmetric(-a, B, -c) + symmetric(-a, -b, C);
  const double k2 = symmetric(A, B, -c) + symmetric(A, -b, C) + symmetric(-a, B, C);
  // three times the Bernstein coefficients, divided by 4: below 1
  return {{{-0.75 * a * b * c, 0}, {0.25 * k1, 0}, {0.25 * k2, 0}, {0.75 * A * B * C, 0}}};
}

template <class Bound, class Reader>
int lost_roots(Reader& reader) {
  Random random(44);
  int lost = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::array<double, 3> r;
    const double scale = std::ldexp(1.0, -random.whole(2, 16));
    for (double& x : r) x = std::floor(random.unit() / scale) * scale;
    if (random.chance(40)) r[1] = r[0];
    if (random.chance(20)) r[2] = r[1];
    Coefficients k = cubic_with_roots(r);
    for (Bounded<double>& x : k) x.bound = 0x1p-60;
    const safe::Cubic<Bound, double> f(k);
    const auto found = safe::roots(f, reader);
    for (const double root : r) {
      bool held = false;
      for (std::size_t j = 0; j < found.count; ++j) held |= found.at[j].l <= root && root <= found.at[j].r;
      lost += !held;
    }
  }
  return lost;
}

TEST(SafeCubic, IntervalsHoldEveryRoot) {
  SignReader reader;
  EXPECT_EQ(lost_roots<bound::safe>(reader), 0);
  EXPECT_EQ(lost_roots<bound::tight>(reader), 0);
  ForgetfulReader eroding(45, 20);
  EXPECT_EQ(lost_roots<bound::tight>(eroding), 0);
  Boastful none{0};  // bounds and the slack of S1 dropped
  EXPECT_GT(lost_roots<bound::tight>(none), 0);
}

TEST(SafeCubic, IntervalsOfSimpleRootsAreNarrow) {
  SignReader reader;
  Random random(46);
  for (int i = 0; i < 10'000; ++i) {
    std::array<double, 3> r{0.1, 0.5, 0.9};
    for (double& x : r) x = std::floor((x + 0.2 * (random.unit() - 0.5)) * 0x1p16) * 0x1p-16;
    const auto found = safe::roots(safe::Cubic<bound::safe, double>(cubic_with_roots(r)), reader);
    ASSERT_EQ(found.count, 3U);
    for (const auto& at : found.at) EXPECT_LT(at.r - at.l, 0x1p-40);
  }
}

// --- One B for a scene --------------------------------------------------------------------------------------------

TEST(SafeScene, BoundIsSoundAndAnswersDoNotDependOnIt) {
  for (const Kind kind : kinds) {
    for (const double largest : {0.5, 2.0, 0x1p21, 0x1p60, std::nan("")}) {  // too small for some, enough, too large
      const SceneBound<double> scene(largest);
      ContactGenerator generator(47);
      for (int i = 0; i < 4'000; ++i) ASSERT_TRUE(collides(kind, generator.contact(kind).data(), scene)) << largest;
      const SceneBound<float> single(static_cast<float>(largest));
      FloatQuery points;
      for (int i = 0; i < 4'000; ++i) {
        if (!test::represent(generator.contact(kind), points)) continue;
        ASSERT_TRUE(collides(kind, points.data(), single));
      }
    }
    Random random(48);
    const SceneBound<double> scene(4.5);
    int settled = 0;
    for (int i = 0; i < 2'000; ++i) {
      const Query query = test::miss(kind, random);
      EXPECT_EQ(collides(kind, query.data(), scene), collides(kind, query.data(), Method::safe));
      settled += scene.never_coplanar(kind, query.data());
    }
    EXPECT_GT(settled, 100);
  }
}

// --- Time and weights ---------------------------------------------------------------------------------------------

void expect_weights(Kind kind, const std::array<double, 4>& w, const std::string& what) {
  for (const double x : w) EXPECT_TRUE(x >= 0 && x <= 1) << what;
  if (kind == Kind::vertex_face) {
    EXPECT_EQ(w[0], 1) << what;
    EXPECT_NEAR(w[1] + w[2] + w[3], 1, 1e-14) << what;
  } else {
    EXPECT_NEAR(w[0] + w[1], 1, 1e-14) << what;
    EXPECT_NEAR(w[2] + w[3], 1, 1e-14) << what;
  }
}

// At the contact the triangle is just opening, and its normal is all rounding.
TEST(SafeContact, WeightsOfNormalsThatAreRoundingErrors) {
  const Query opening{0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0, 2, 2, 0};
  const Query sheared{-1, -2, -3, 1, -1, 1, -1, -2, -3, 1, -1, 1, 1, -1, 1, -1, -1, -4, -1, 1, 0, -1, -1, -2};
  for (const Query& query : {opening, sheared}) {
    for (const Method method : safe_methods) {
      const auto contact = first_contact(Kind::vertex_face, query.data(), method);
      ASSERT_TRUE(contact.has_value());
      expect_weights(Kind::vertex_face, contact->weights, std::string(name(method)));
    }
  }
}

TEST(SafeContact, TimeIsNeverLateAndAnswersAgree) {
  for (const Kind kind : kinds) {
    ContactGenerator generator(51);
    int close = 0;
    constexpr int count = 3000;
    for (int i = 0; i < count; ++i) {
      const Query query = generator.contact(kind);
      const auto exact = oracle::first_contact(kind, query);
      ASSERT_TRUE(exact.has_value());
      for (const Method method : safe_methods) {
        const auto contact = first_contact(kind, query.data(), method);
        ASSERT_TRUE(contact.has_value());
        EXPECT_LE(contact->earliest, exact->upper) << name(method);
        EXPECT_LE(contact->earliest, contact->latest);
        close += contact->earliest >= exact->lower - 1e-6;
        expect_weights(kind, contact->weights, std::string(name(method)));
      }
    }
    EXPECT_GT(close, 2 * count * 9 / 10);
    Random random(52);
    for (int i = 0; i < 1000; ++i) EXPECT_FALSE(first_contact(kind, test::miss(kind, random).data()).has_value());
  }
}

TEST(SafeContact, WeightsArePointsOfTheFeatures) {
  const Query face{0.25, 0.25, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0.25, 0.25, -1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
  const auto on_face = first_contact(Kind::vertex_face, face.data());
  ASSERT_TRUE(on_face.has_value());
  EXPECT_NEAR(on_face->earliest, 0.5, 1e-12);
  EXPECT_NEAR(on_face->latest, 0.5, 1e-12);
  EXPECT_EQ(on_face->weights[0], 1);
  EXPECT_NEAR(on_face->weights[1], 0.5, 1e-12);
  EXPECT_NEAR(on_face->weights[2], 0.25, 1e-12);
  EXPECT_NEAR(on_face->weights[3], 0.25, 1e-12);

  const Query edges{0, 0, 1, 1, 0, 1, 0.75, -1, 0, 0.75, 3, 0, 0, 0, -1, 1, 0, -1, 0.75, -1, 0, 0.75, 3, 0};
  const auto crossing = first_contact(Kind::edge_edge, edges.data());
  ASSERT_TRUE(crossing.has_value());
  EXPECT_NEAR(crossing->weights[0], 0.25, 1e-12);
  EXPECT_NEAR(crossing->weights[1], 0.75, 1e-12);
  EXPECT_NEAR(crossing->weights[2], 0.75, 1e-12);
  EXPECT_NEAR(crossing->weights[3], 0.25, 1e-12);

  for (const Hole& hole : holes()) {  // the normal vanishes: still weights, with the right sums
    const auto contact = first_contact(hole.kind, hole.points.data());
    ASSERT_TRUE(contact.has_value()) << hole.what;
    expect_weights(hole.kind, contact->weights, hole.what);
  }
}

}  // namespace
}  // namespace tightrope::ccd
