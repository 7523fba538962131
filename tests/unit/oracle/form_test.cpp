/// Binary forms: values, hulls, halves, divisors.

#include "ccd/oracle/form.h"

#include <gtest/gtest.h>

#include <array>
#include <initializer_list>
#include <random>

namespace tightrope::ccd::oracle {
namespace {

Form form_of(std::initializer_list<long> coefficients) {
  Form form(static_cast<int>(coefficients.size()) - 1);
  int j = 0;
  for (const long c : coefficients) form[j++] = c;
  return form;
}

Form product(const Form& a, const Form& b) {
  Form r(a.degree() + b.degree());
  add_product(r, a, b);
  return r;
}

bool proportional(const Form& a, const Form& b) {
  if (a.degree() != b.degree()) return false;
  for (int i = 0; i <= a.degree(); ++i) {
    for (int j = 0; j < i; ++j) {
      if (a[i] * b[j] != a[j] * b[i]) return false;
    }
  }
  return !a.is_zero() && !b.is_zero();
}

/// The exact value at t, from the definition.
mpq_class value(const Form& form, const mpq_class& t) {
  mpq_class sum;
  for (int j = 0; j <= form.degree(); ++j) {
    mpq_class term = form[j];
    for (int i = 0; i < form.degree(); ++i) term *= i < j ? t : mpq_class(1 - t);
    sum += term;
  }
  return sum;
}

class RandomForms {
 public:
  explicit RandomForms(unsigned seed) : engine_(seed) {}
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  Form form(int degree, int size) {
    Form r(degree);
    for (int j = 0; j <= degree; ++j) r[j] = integer(-size, size);
    return r;
  }

 private:
  std::mt19937 engine_;
};

mpq_class rational(const DyadicTime& time) {
  mpq_class t(time.numerator);
  t >>= time.exponent;
  return t;
}

TEST(Form, ArithmeticIsThatOfPolynomials) {
  RandomForms random(1);
  const mpq_class t(3, 7);
  for (int i = 0; i < 500; ++i) {
    const Form a = random.form(2, 9), b = random.form(2, 9);
    EXPECT_EQ(value(a + b, t), value(a, t) + value(b, t));
    EXPECT_EQ(value(a - b, t), value(a, t) - value(b, t));
    EXPECT_EQ(value(product(a, b), t), value(a, t) * value(b, t));
    Form difference = product(a, a);
    subtract_product(difference, a, b);
    EXPECT_EQ(value(difference, t), value(a, t) * (value(a, t) - value(b, t)));
  }
}

TEST(Form, SignAtAgreesWithTheValue) {
  RandomForms random(2);
  for (int i = 0; i < 2000; ++i) {
    const Form form = random.form(random.integer(0, 4), 4);
    const DyadicTime time = {random.integer(0, 8), 3};
    EXPECT_EQ(sign_at(form, time), sgn(value(form, rational(time))));
  }
}

TEST(Form, HullSignBoundsEveryValue) {
  RandomForms random(3);
  int definite = 0;
  for (int i = 0; i < 2000; ++i) {
    const Form form = random.form(3, 3);
    const int sign = hull_sign(form);
    if (sign == 0) continue;
    ++definite;
    for (int k = 0; k <= 16; ++k) EXPECT_EQ(sign_at(form, {k, 4}), sign);
  }
  EXPECT_GT(definite, 100);
  EXPECT_EQ(hull_sign(form_of({0, 1, 1})), 0);  // a zero at the end is no strict sign
  EXPECT_EQ(hull_sign(form_of({0, 0})), 0);
}

TEST(Form, SignVariationsSkipZeros) {
  EXPECT_EQ(sign_variations(form_of({1, 0, -1, 0})), 1);
  EXPECT_EQ(sign_variations(form_of({1, -1, 1, -1})), 3);
  EXPECT_EQ(sign_variations(form_of({0, 0, 0})), 0);
}

TEST(Form, RestrictionAndHalvesKeepTheSigns) {
  RandomForms random(4);
  for (int i = 0; i < 500; ++i) {
    const Form form = random.form(random.integer(0, 4), 9);
    const DyadicTime lower = {random.integer(0, 7), 3};
    const Form part = restricted(form, lower), left = left_half(form), right = right_half(form);
    for (int k = 0; k <= 8; ++k) {
      EXPECT_EQ(sign_at(part, {k, 3}), sign_at(form, {8 * lower.numerator + k, 6}));
      EXPECT_EQ(sign_at(left, {k, 3}), sign_at(form, {k, 4}));
      EXPECT_EQ(sign_at(right, {k, 3}), sign_at(form, {8 + k, 4}));
    }
  }
}

TEST(Form, RestrictionIsTheSameByHalves) {
  RandomForms random(5);
  for (int i = 0; i < 200; ++i) {
    Form form = random.form(4, 9);
    if (form.is_zero()) continue;
    const Form whole = form;
    DyadicTime lower;
    for (int level = 0; level < 40; ++level) {
      const bool right = random.integer(0, 1) != 0;
      form = right ? right_half(form) : left_half(form);
      lower = {2 * lower.numerator + (right ? 1 : 0), lower.exponent + 1};
    }
    EXPECT_TRUE(proportional(form, restricted(whole, lower)));
  }
}

TEST(Form, RootsAtTheEndsAreDividedOut) {
  EXPECT_TRUE(proportional(without_roots_at_0(form_of({0, 0, 3, 1})), form_of({3, 1})));
  EXPECT_TRUE(proportional(without_roots_at_1(form_of({3, 1, 0, 0})), form_of({3, 1})));
  EXPECT_TRUE(proportional(without_roots_at_1(form_of({3, 1})), form_of({3, 1})));
}

TEST(Form, CommonDivisorOfProductsIsTheSharedFactor) {
  RandomForms random(6);
  int checked = 0;
  for (int i = 0; i < 2000; ++i) {
    Form shared = random.form(random.integer(0, 2), 5);
    const Form f = random.form(2, 3), g = random.form(2, 3);
    if (sgn(shared[0]) == 0 || sgn(shared[shared.degree()]) == 0 || f.is_zero() || g.is_zero()) continue;
    const Form rest = common_divisor(f, g);
    const Form divisor = common_divisor(product(shared, f), product(shared, g));
    EXPECT_TRUE(proportional(divisor, product(shared, rest)));
    checked += rest.degree() > 0 ? 1 : 0;
  }
  EXPECT_GT(checked, 20);  // f and g had a factor of their own in common
  EXPECT_TRUE(proportional(common_divisor(form_of({0, 0}), form_of({2, 4})), form_of({1, 2})));
  EXPECT_EQ(common_divisor(form_of({1, 1}), form_of({1, 2})).degree(), 0);
}

TEST(Form, SquareFreeKeepsEveryRootOnce) {
  const Form third = form_of({-1, 2}), half = form_of({-1, 1}), twice = product(half, half);
  EXPECT_TRUE(proportional(square_free(product(twice, third)), product(half, third)));
  EXPECT_TRUE(proportional(square_free(product(twice, half)), half));
  EXPECT_TRUE(proportional(square_free(product(twice, product(third, third))), product(half, third)));
  EXPECT_TRUE(proportional(square_free(product(half, third)), product(half, third)));
}

}  // namespace
}  // namespace tightrope::ccd::oracle
