/// Roots of forms: all of them, apart from each other, with exact signs and tight enclosures.

#include "ccd/oracle/root.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace tightrope::ccd::oracle {
namespace {

/// Vanishes at p / q, positive before.
Form root_at(const mpq_class& t) {
  Form form(1);  // q ((p/q) (1 - t) - (1 - p/q) t) = p - q t
  form[0] = t.get_num();
  form[1] = t.get_num() - t.get_den();
  return form;
}

Form product(const std::vector<Form>& factors) {
  Form r(0);
  r[0] = 1;
  for (const Form& factor : factors) {
    Form next(r.degree() + factor.degree());
    add_product(next, r, factor);
    r = std::move(next);
  }
  return r;
}

mpq_class power_of_two(int exponent) {
  mpq_class r(1);
  if (exponent < 0) {
    r >>= static_cast<mp_bitcnt_t>(-exponent);
  } else {
    r <<= static_cast<mp_bitcnt_t>(exponent);
  }
  return r;
}

void expect_encloses(const Contact& found, const mpq_class& time) {
  if (found.lower == found.upper) {
    EXPECT_EQ(mpq_class(found.lower), time);
  } else {
    EXPECT_LT(mpq_class(found.lower), time);
    EXPECT_GT(mpq_class(found.upper), time);
    EXPECT_EQ(std::nextafter(found.lower, 2.0), found.upper);
  }
}

TEST(Roots, AreFoundOnceEachAscending) {
  std::mt19937 engine(1);
  const auto integer = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine); };
  for (int i = 0; i < 3000; ++i) {
    std::set<mpq_class> inside;
    std::vector<Form> factors;
    for (int j = integer(1, 4); j > 0; --j) {  // roots inside, at the ends, outside, repeated
      mpq_class t(integer(-4, 16), integer(1, 12));
      t.canonicalize();
      factors.push_back(root_at(t));
      if (t >= 0 && t <= 1) inside.insert(t);
    }
    const std::vector<Root> found = roots(product(factors));
    ASSERT_EQ(found.size(), inside.size());
    std::size_t j = 0;
    for (const mpq_class& t : inside) expect_encloses(found[j++].enclosure(), t);
  }
}

TEST(Roots, CloseRootsAreSeparated) {
  const mpq_class third(1, 3);
  for (const int exponent : {-10, -100, -900}) {
    const mpq_class near = third + power_of_two(exponent);
    std::vector<Root> found = roots(product({root_at(third), root_at(near), root_at(near)}));
    ASSERT_EQ(found.size(), 2U) << exponent;
    EXPECT_EQ(found[0].sign(root_at(near)), 1);  // still before the other
    EXPECT_EQ(found[1].sign(root_at(third)), -1);
    EXPECT_EQ(found[0].sign(root_at(third)), 0);
    EXPECT_EQ(found[1].sign(root_at(near)), 0);
  }
}

TEST(Roots, ThousandsOfLevelsDoNotExhaustTheStack) {
  const mpq_class first = power_of_two(-6000) / 3;
  const mpq_class second = power_of_two(-6000) / 5;
  std::vector<Root> found = roots(product({root_at(first), root_at(second)}));
  ASSERT_EQ(found.size(), 2U);
  for (const Root& root : found) {
    EXPECT_EQ(root.enclosure().lower, 0.0);
    EXPECT_EQ(root.enclosure().upper, std::numeric_limits<double>::denorm_min());
  }
}

TEST(Roots, OfAFormWithoutAnyInTheUnitInterval) {
  EXPECT_TRUE(roots(product({root_at(mpq_class(3, 2)), root_at(-2)})).empty());
  Form always_positive(2);  // (1-t)^2 - (1-t) t + t^2: two sign variations, no root
  always_positive[0] = always_positive[2] = 1;
  always_positive[1] = -1;
  EXPECT_TRUE(roots(always_positive).empty());
}

TEST(Root, SignIsExactAtIrrationalTimes) {
  // 2 t^2 = 1 at 1/sqrt(2): with x = 1 - t, y = t: x^2 + 2 x y - y^2.
  Form square(2);
  square[0] = 1;
  square[1] = 2;
  square[2] = -1;
  std::vector<Root> found = roots(square);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].sign(square), 0);
  EXPECT_EQ(found[0].sign(product({square, square})), 0);
  EXPECT_EQ(found[0].sign(product({square, root_at(mpq_class(1, 3))})), 0);
  EXPECT_EQ(found[0].sign(Form(4)), 0);
  // Convergents of sqrt(1/2) lie on alternating sides: p/q with 2 p^2 - q^2 = -1, +1, ...
  mpz_class p = 1, q = 1;
  for (int i = 0; i < 200; ++i) {
    const mpq_class t(p, q);
    EXPECT_EQ(found[0].sign(root_at(t)), 2 * p * p > q * q ? 1 : -1) << i;
    const mpz_class next = p + q;
    q = 2 * p + q;
    p = next;
  }
}

TEST(Root, SignAtFirstSightIsNeverWrong) {
  std::mt19937 engine(2);
  const auto integer = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine); };
  int seen = 0;
  for (int i = 0; i < 1000; ++i) {
    Form f(3), g(2);
    for (int j = 0; j <= 3; ++j) f[j] = integer(-9, 9);
    for (int j = 0; j <= 2; ++j) g[j] = integer(-9, 9);
    if (f.is_zero()) continue;
    for (Root& root : roots(f)) {
      const int sight = root.sign_at_first_sight(g);
      if (sight == 0) continue;
      ++seen;
      EXPECT_EQ(root.sign(g), sight);
    }
  }
  EXPECT_GT(seen, 100);
}

TEST(Root, ExactTimesAreEnclosedExactlyIfTheyAreDoubles) {
  for (const double time : {0.0, 1.0, 0.5, 0x1p-1074, 0x1.fffffffffffffp-1, 0x1.23456789abcdep-700, 0.1}) {
    const std::vector<Root> found = roots(product({root_at(mpq_class(time)), root_at(7)}));
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].enclosure().lower, time);
    EXPECT_EQ(found[0].enclosure().upper, time);
  }
  const mpq_class between = mpq_class(0.1) + power_of_two(-58);  // dyadic, one bit too long for a double
  const std::vector<Root> found = roots(root_at(between));
  ASSERT_EQ(found.size(), 1U);
  expect_encloses(found[0].enclosure(), between);
  EXPECT_EQ(found[0].enclosure().lower, 0.1);
  expect_encloses(Root::exactly({1, 2000}).enclosure(), power_of_two(-2000));
}

}  // namespace
}  // namespace tightrope::ccd::oracle
