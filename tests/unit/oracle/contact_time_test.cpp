/// The exact time of first contact: known values, agreement with linear programming at that very time, and with proofs
/// that nothing happens before it.

#include "ccd/oracle/contact_time.h"

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <random>

#include "ccd/oracle/decision.h"
#include "ccd/oracle/root.h"
#include "queries.h"
#include "static_contact.h"

namespace tightrope::ccd {
namespace {

using oracle::Contact;
using oracle::Defect;
using oracle::first_contact;
using oracle::TimeInterval;
using test::Points;
using test::QueryMaker;
using test::text;
using test::touching_at;

constexpr Kind vf = Kind::vertex_face, ee = Kind::edge_edge;

mpq_class power_of_two(int exponent) {
  mpq_class one(1);
  return exponent < 0 ? mpq_class(one >> static_cast<mp_bitcnt_t>(-exponent))
                      : mpq_class(one << static_cast<mp_bitcnt_t>(exponent));
}

mpq_class ratio(long p, long q) {
  mpq_class r(p, q);
  r.canonicalize();
  return r;
}

/// A vertex that falls from height `from` to `to` on a resting triangle, which it meets inside.
Points falling(double from, double to) {
  return {1, 1, from, 0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, to, 0, 0, 0, 4, 0, 0, 0, 4, 0};
}

TEST(ContactTime, RationalTimesAreGivenExactlyAtAnyWidth) {
  std::mt19937_64 engine(1);
  const auto integer = [&](long low, long high) { return std::uniform_int_distribution<long>(low, high)(engine); };
  for (int i = 0; i < 2000; ++i) {
    const long above = integer(0, 1L << (i % 50)), below = integer(0, 1L << (i / 7 % 50));
    if (above == 0 && below == 0) continue;
    const auto found = first_contact(vf, falling(static_cast<double>(above), -static_cast<double>(below)), 1);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->lower, ratio(above, above + below));
    EXPECT_EQ(found->upper, found->lower);
  }
}

TEST(ContactTime, AtScalesFarApart) {
  const auto found = first_contact(vf, falling(0x1p-1000, -0x1p1000), 1);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->lower, 1 / (1 + power_of_two(2000)));
  EXPECT_EQ(found->upper, found->lower);
}

TEST(ContactTime, IrrationalTimesAreEnclosedToTheWidth) {
  // Height over the tilting face: 2 t^2 - 1.
  const Points points = {1, 0, -1, 0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, -1, 0, 0, 0, 4, 0, 0, 0, 4, -8};
  for (const int exponent : {2, 0, -1, -3, -53, -200, -3000}) {
    const mpq_class width = power_of_two(exponent) / 3;
    const auto found = first_contact(vf, points, width);
    ASSERT_TRUE(found);
    EXPECT_LT(2 * found->lower * found->lower, 1);
    EXPECT_GT(2 * found->upper * found->upper, 1);
    EXPECT_GE(found->lower, 0);
    EXPECT_LE(found->upper, 1);
    EXPECT_LE(found->upper - found->lower, width);
  }
}

TEST(ContactTime, OfMotionInAPlaneIsThatOfTheFirstEntry) {
  // A small triangle beside the path y = 0, x = 3t - 1 of the vertex: in at x = 0, out at x = 1.
  const Points entering = {-1, 0, 0, 0, 1, 0, 0, -1, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 0, -1, 0, 1, 0, 0};
  const auto entry = first_contact(vf, entering, 1);
  ASSERT_TRUE(entry);
  EXPECT_EQ(entry->lower, ratio(1, 3));
  EXPECT_EQ(entry->upper, ratio(1, 3));
  // Collinear edges [0, 1] and [3, 4] -> [-4, -3]: eb0 = 3 - 7t.
  const Points sliding = {0, 0, 0, 1, 0, 0, 3, 0, 0, 4, 0, 0, 0, 0, 0, 1, 0, 0, -4, 0, 0, -3, 0, 0};
  const auto meeting = first_contact(ee, sliding, 1);
  ASSERT_TRUE(meeting);
  EXPECT_EQ(meeting->lower, ratio(2, 7));
}

/// Roots as those of a form that vanishes at `roots` (each in (0, 1)).
std::vector<oracle::Root> roots_at(const std::vector<mpq_class>& times) {
  oracle::Form form(0);
  form[0] = 1;
  for (const mpq_class& t : times) {
    oracle::Form next(form.degree() + 1);
    add_product(next, form, oracle::Form::linear(t.get_num(), t.get_num() - t.get_den()));
    form = std::move(next);
  }
  return oracle::roots(form);
}

TEST(RootOrder, IsThatOfTheNumbers) {
  const std::vector<mpq_class> times = {0,           ratio(1, 5), ratio(1, 3), ratio(1, 3) + power_of_two(-400),
                                        ratio(1, 2), ratio(3, 4), ratio(6, 7), 1};
  for (std::size_t i = 0; i < times.size(); ++i) {
    for (std::size_t j = 0; j < times.size(); ++j) {
      for (const mpq_class& other : {ratio(2, 3), ratio(1, 9)}) {  // a second root, so that the forms differ
        auto first = roots_at({times[i]}), second = roots_at({times[j], other});
        oracle::Root& root = second[other < times[j] ? 1 : 0];
        EXPECT_EQ(first[0].compare(root), times[i] < times[j] ? -1 : times[i] > times[j] ? 1 : 0);
        EXPECT_EQ(root.rational(), times[j]);
      }
    }
  }
}

/// How an exact time contradicts linear programming, if it does.
std::optional<const char*> contradiction(Kind kind, const Points& points, const std::optional<TimeInterval>& found,
                                         const std::optional<Contact>& enclosure) {
  if (found.has_value() != enclosure.has_value()) return "contact";
  const mpq_class end = found ? found->lower : mpq_class(2);
  for (const auto& [p, q] : std::array<std::array<long, 2>, 11>{
           {{0, 1}, {1, 1}, {1, 2}, {1, 3}, {2, 3}, {1, 4}, {3, 4}, {1, 5}, {2, 5}, {3, 5}, {5, 7}}}) {
    if (ratio(p, q) < end && touching_at(kind, points, ratio(p, q))) return "late";
  }
  if (!found) return std::nullopt;
  if (found->lower == found->upper) {
    if (!touching_at(kind, points, found->lower)) return "false";
    return found->lower < mpq_class(enclosure->lower) || found->lower > mpq_class(enclosure->upper)
               ? std::optional("enclosure")
               : std::nullopt;
  }
  if (touching_at(kind, points, found->lower)) return "late";
  const bool overlap = found->lower < mpq_class(enclosure->upper) && found->upper > mpq_class(enclosure->lower);
  return overlap && enclosure->lower < enclosure->upper ? std::nullopt : std::optional("enclosure");
}

struct Tally {
  int wrong = 0;
  int rational = 0;
  int irrational = 0;
};

Tally tally(Defect defect, int queries, std::uint64_t seed) {
  QueryMaker random(seed);
  Tally sum;
  for (int i = 0; i < queries; ++i) {
    const Points points = random.make(i % QueryMaker::families);
    for (const Kind kind : {vf, ee}) {
      const auto found = first_contact(kind, points, power_of_two(-60), defect);
      const auto wrong = contradiction(kind, points, found, oracle::first_contact(kind, points));
      if (wrong && defect == Defect::none)
        ADD_FAILURE() << *wrong << ' ' << text(kind) << ' ' << testing::PrintToString(points);
      sum.wrong += wrong ? 1 : 0;
      if (found) ++(found->lower == found->upper ? sum.rational : sum.irrational);
    }
  }
  return sum;
}

TEST(ContactTime, AgreesWithLinearProgrammingInEveryFamily) {
  const Tally sum = tally(Defect::none, 1600, 51);
  EXPECT_EQ(sum.wrong, 0);
  EXPECT_GT(sum.rational, 400);
  EXPECT_GT(sum.irrational, 100);
}

TEST(ContactTimeWithADefect, Disagrees) {
  for (const Defect defect : {Defect::collapsed_never_touches, Defect::collapsed_always_touches,
                              Defect::coplanar_motion_only_at_ends, Defect::open_features}) {
    EXPECT_GT(tally(defect, 240, 51).wrong, 0) << static_cast<int>(defect);
  }
}

}  // namespace
}  // namespace tightrope::ccd
