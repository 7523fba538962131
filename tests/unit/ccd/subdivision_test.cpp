/// The filter of method `tightrope`: each of its verdicts is a proof, whatever signs bounds leave uncertain; the oracle
/// judges.

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "edge_edge.safe.double.h"
#include "edge_edge.tight.double.h"
#include "separating_plane.safe.double.h"
#include "separating_plane.safe.float.h"
#include "subdivision.float.double.h"
#include "subdivision.tight.double.h"
#include "vertex_face.safe.double.h"
#include "vertex_face.tight.double.h"

// After the generated headers:
#include "ccd/impact/filter.h"
#include "contacts.h"
#include "forgetful_reader.h"
#include "oracle/oracle.h"
#include "scenes/scene.h"
#include "tests/stability/show_query.h"

namespace tightrope::ccd {
namespace {

using test::ContactGenerator;
using test::ForgetfulReader;
using test::Query;
using test::Random;

constexpr std::array<Kind, 2> kinds{Kind::vertex_face, Kind::edge_edge};

/// Believes bounds to be smaller than they are.
struct CarelessReader {
  double factor;
  template <class Real>
  Sign operator()(const Bounded<Real>& x) const {
    return sign(Bounded<Real>{x.value, static_cast<Real>(factor * x.bound)});
  }
};

/// Queries of every scene and of constructed contacts.
std::vector<Query> queries_of(Kind kind, std::size_t each) {
  std::vector<Query> queries;
  for (const SceneInfo& info : scenes()) {
    std::vector<double> points(24 * each);
    generate(info.scene, kind, each, 77)->fill(points);
    for (std::size_t i = 0; i < each; ++i) std::copy_n(points.data() + 24 * i, 24, queries.emplace_back().begin());
  }
  ContactGenerator contacts(78);
  for (std::size_t i = 0; i < 4 * each; ++i) queries.push_back(contacts.contact(kind));
  return queries;
}

struct Judgement {
  int no_contact = 0, contact = 0, open = 0, wrong = 0;
};

/// Is the verdict true? `t_max` = 1.
bool holds(const Finding& finding, Question question, const std::optional<oracle::Contact>& truth) {
  switch (finding.verdict) {
    case Verdict::no_contact:
      return !truth;
    case Verdict::contact:
      return truth && (question == Question::whether ||
                       (finding.time.lower <= truth->lower && truth->upper <= finding.time.upper));
    case Verdict::open:
      return true;
  }
  return false;
}

template <class Signs>
void judge(Kind kind, const Query& query, Question question, const std::optional<oracle::Contact>& truth, Signs signs,
           Judgement& judgement) {
  const Finding finding = filtered(kind, query.data(), question, 1, signs).finding;
  judgement.no_contact += finding.verdict == Verdict::no_contact ? 1 : 0;
  judgement.contact += finding.verdict == Verdict::contact ? 1 : 0;
  judgement.open += finding.verdict == Verdict::open ? 1 : 0;
  judgement.wrong += holds(finding, question, truth) ? 0 : 1;
}

class Filter : public testing::TestWithParam<Kind> {
 protected:
  /// Judges every query with the reader that `reader(i)` gives for query i.
  template <class Reader>
  Judgement judge_all(Question question, const Reader& reader) {
    Judgement judgement;
    for (std::size_t i = 0; i < queries().size(); ++i) {
      judge(GetParam(), queries()[i], question, truths()[i], reader(i), judgement);
      if (judgement.wrong == 1 && !shown_) {
        shown_ = true;
        first_wrong_ = show_query(queries()[i].data());
      }
    }
    return judgement;
  }
  const std::vector<Query>& queries() {
    static const std::array<std::vector<Query>, 2> all{queries_of(kinds[0], 250), queries_of(kinds[1], 250)};
    return all[GetParam() == Kind::vertex_face ? 0 : 1];
  }
  const std::vector<std::optional<oracle::Contact>>& truths() {
    static std::array<std::vector<std::optional<oracle::Contact>>, 2> all;
    auto& mine = all[GetParam() == Kind::vertex_face ? 0 : 1];
    if (mine.empty()) {
      for (const Query& query : queries()) mine.push_back(oracle::first_contact(GetParam(), query));
    }
    return mine;
  }
  std::string first_wrong_;

 private:
  bool shown_ = false;
};

TEST_P(Filter, VerdictsAreProofs) {
  for (const Question question : {Question::whether, Question::when}) {
    const Judgement judgement = judge_all(question, [](std::size_t) { return SignReader(); });
    EXPECT_EQ(judgement.wrong, 0) << first_wrong_;
    EXPECT_GT(judgement.no_contact, 2000);
    EXPECT_GT(judgement.contact, 800);
    EXPECT_GT(judgement.open, 100) << "too easy a set";
  }
}

/// A sign that is not known must never be taken for one that is (MATH 6.4).
TEST_P(Filter, VerdictsAreProofsWhateverSignsAreForgotten) {
  for (const Question question : {Question::whether, Question::when}) {
    for (const int percent : {2, 10, 40}) {
      const Judgement judgement = judge_all(question, [&](std::size_t i) { return ForgetfulReader(i, percent); });
      EXPECT_EQ(judgement.wrong, 0) << first_wrong_;
      EXPECT_GT(judgement.no_contact, 500);
    }
  }
}

/// What the tests above are worth: too small a bound is noticed.
TEST_P(Filter, SmallerBoundsWouldBeNoticed) {
  for (const Question question : {Question::whether, Question::when}) {
    EXPECT_GT(judge_all(question, [](std::size_t) { return CarelessReader{0}; }).wrong, 10);
    EXPECT_GT(judge_all(question, [](std::size_t) { return CarelessReader{1.0 / 32}; }).wrong, 0);
  }
}

TEST_P(Filter, LaterContactsDoNotCount) {
  int dropped = 0, kept = 0;
  for (std::size_t i = 0; i < queries().size(); ++i) {
    if (!truths()[i] || truths()[i]->lower == 0) continue;
    SignReader signs;
    const double t_max = i % 2 == 0 ? truths()[i]->lower / 2 : std::min(1.0, truths()[i]->upper * 1.5);
    const Finding finding = filtered(GetParam(), queries()[i].data(), Question::when, t_max, signs).finding;
    const bool counts = truths()[i]->upper <= t_max;
    dropped += finding.verdict == Verdict::no_contact ? 1 : 0;
    kept += finding.verdict == Verdict::contact ? 1 : 0;
    EXPECT_NE(finding.verdict, counts ? Verdict::no_contact : Verdict::contact) << show_query(queries()[i].data());
  }
  EXPECT_GT(dropped, 400);
  EXPECT_GT(kept, 400);
}

/// Infinite coordinates have signs, too; they prove nothing.
TEST_P(Filter, IsOpenWhereACoordinateIsNotFinite) {
  Random random(79);
  for (const double bad : {HUGE_VAL, -HUGE_VAL, std::nan("")}) {
    for (std::size_t i = 0; i < 24; ++i) {
      Query query = test::miss(GetParam(), random);
      query[i] = bad;
      SignReader signs;
      EXPECT_EQ(filtered(GetParam(), query.data(), Question::whether, 1, signs).stage, Stage::exact);
      std::array<float, 24> single;
      for (std::size_t j = 0; j < 24; ++j) single[j] = static_cast<float>(query[j]);
      EXPECT_EQ(filtered(GetParam(), single.data(), Question::when, 1, signs).stage, Stage::exact);
    }
  }
}

/// Powers of two change nothing, as long as no coordinate is lost; the verdicts at both ends of the exponents' range
/// are proofs, too.
TEST_P(Filter, VerdictsAreProofsAtEveryScale) {
  Judgement judgement;
  for (std::size_t i = 0; i < queries().size(); i += 7) {
    for (const int exponent : {-1074, -1030, -700, -340, -110, 110, 340, 700, 1000}) {
      Query scaled = queries()[i];
      bool exact = true;
      for (double& x : scaled) {
        const double y = std::ldexp(x, exponent);
        exact = exact && std::ldexp(y, -exponent) == x && std::isfinite(y);
        x = y;
      }
      if (!std::all_of(scaled.begin(), scaled.end(), [](double x) { return std::isfinite(x); })) continue;
      const auto truth = exact ? truths()[i] : oracle::first_contact(GetParam(), scaled);
      judge(GetParam(), scaled, Question::when, truth, SignReader(), judgement);
      ASSERT_EQ(judgement.wrong, 0) << exponent << '\n' << show_query(scaled.data());
    }
  }
  EXPECT_GT(judgement.no_contact, 2000);
  EXPECT_GT(judgement.contact, 800);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Filter, testing::ValuesIn(kinds), [](const auto& kind) {
  return std::string(kind.param == Kind::vertex_face ? "vertex_face" : "edge_edge");
});

/// The exact value at t of the cubic with Bernstein coefficients y.
mpq_class value(const Cubic& y, double t) {
  const mpq_class x(t), w = 1 - x;
  return w * w * w * y[0].value + 3 * x * w * w * y[1].value + 3 * x * x * w * y[2].value + x * x * x * y[3].value;
}

TEST(Isolation, BracketHoldsTheOnlyRoot) {
  Random random(5);
  int found = 0, narrow = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double size = std::ldexp(1.0, random.whole(-60, 60));
    Cubic y;
    for (auto& k : y) k = {size * (2 * random.unit() - 1), 0};
    if (random.chance(30)) y[1] = y[0];  // flat at an end
    if (random.chance(20)) y[2].value = -y[1].value;
    SignReader signs;
    std::array<Sign, 4> k;
    for (std::size_t j = 0; j < 4; ++j) k[j] = sign(y[j]);
    const Sign direction = crossing_direction(y, k, signs);
    if (direction == Sign::uncertain || common(k) != Sign::uncertain) continue;
    const auto bracket = isolated_crossing(y, k, direction, signs);
    if (!bracket) continue;
    ++found;
    narrow += bracket->r - bracket->l < 0x1p-40 ? 1 : 0;
    const int s = static_cast<int>(direction);
    EXPECT_LE(0, bracket->l);
    EXPECT_LE(bracket->r, 1);
    if (bracket->l > 0) {
      EXPECT_EQ(sgn(value(y, bracket->l)), -s);
    }
    if (bracket->r < 1) {
      EXPECT_EQ(sgn(value(y, bracket->r)), s);
    }
    EXPECT_EQ(bracket->crossed, sgn(value(y, bracket->l)) == -s && sgn(value(y, bracket->r)) == s);
  }
  EXPECT_GT(found, 5000);
  EXPECT_GT(narrow, found * 95 / 100);
}

/// Times on a part of the step are rounded outwards by the least that is possible.
TEST(Isolation, TimesOfPartsAreRoundedOutwards) {
  Random random(6);
  int inexact = 0;
  for (int i = 0; i < 20'000; ++i) {
    const int depth = random.whole(0, 16);
    const double w = std::ldexp(1.0, -depth), lo = w * random.whole(0, (1 << depth) - 1);
    const double x = random.chance(20) ? std::ldexp(random.unit(), -random.whole(0, 900)) : random.unit();
    const mpq_class exact = mpq_class(lo) + mpq_class(w) * mpq_class(x);
    const double below = time_below(lo, w, x), above = time_above(lo, w, x);
    EXPECT_LE(mpq_class(below), exact);
    EXPECT_GE(mpq_class(above), exact);
    EXPECT_GT(mpq_class(std::nextafter(below, 2.0)), exact);
    if (above > 0) {
      EXPECT_LT(mpq_class(std::nextafter(above, 0.0)), exact);
    }
    inexact += below < above ? 1 : 0;
  }
  EXPECT_GT(inexact, 5000);
}

}  // namespace
}  // namespace tightrope::ccd
