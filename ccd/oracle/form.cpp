#include "ccd/oracle/form.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace tightrope::ccd::oracle {
namespace {

/// p(z) becomes p(z + 1): n (n + 1) / 2 additions.
void shift_by_one(Form& form) {
  const int n = form.degree();
  for (int i = 0; i < n; ++i) {
    for (int j = n - 1; j >= i; --j) form[j] += form[j + 1];
  }
}

/// p(z) becomes p(2 z).
void double_argument(Form& form) {
  for (int j = 1; j <= form.degree(); ++j) form[j] <<= static_cast<mp_bitcnt_t>(j);
}

void reverse(Form& form) {
  for (int i = 0, j = form.degree(); i < j; ++i, --j) std::swap(form[i], form[j]);
}

/// Removes the largest common power of two: keeps long subdivisions from growing needlessly.
void remove_power_of_two(Form& form) {
  mp_bitcnt_t common = ~mp_bitcnt_t{0};
  for (int j = 0; j <= form.degree(); ++j) {
    if (sgn(form[j]) != 0) common = std::min(common, mpz_scan1(form[j].get_mpz_t(), 0));
  }
  if (common == 0 || common == ~mp_bitcnt_t{0}) return;
  for (int j = 0; j <= form.degree(); ++j) form[j] >>= common;
}

/// Divides by the content.
void make_primitive(Form& form) {
  mpz_class content;
  for (int j = 0; j <= form.degree() && content != 1; ++j) content = gcd(content, form[j]);
  if (content <= 1) return;
  for (int j = 0; j <= form.degree(); ++j) mpz_divexact(form[j].get_mpz_t(), form[j].get_mpz_t(), content.get_mpz_t());
}

/// The remainder of a by b as polynomials in z, up to a constant factor; b without roots at 0 and 1. The result is
/// primitive and without roots at 0 and 1 (b has none, so no common divisor is lost), or zero.
Form remainder(Form a, const Form& b) {
  const int m = b.degree();
  while (a.degree() >= m && !a.is_zero()) {
    const int n = a.degree();
    const mpz_class leading = a[n];
    Form reduced(n - 1 < 0 ? 0 : n - 1);
    for (int j = 0; j < n; ++j) {
      reduced[j] = a[j] * b[m];
      if (j >= n - m) reduced[j] -= leading * b[j - (n - m)];
    }
    if (reduced.is_zero()) return Form();
    a = without_roots_at_1(reduced);
  }
  a = without_roots_at_0(a);
  make_primitive(a);
  return a;
}

/// a / b for a primitive b that divides a as polynomials in z: integers by Gauss' lemma.
Form quotient(Form a, const Form& b) {
  const int m = b.degree();
  Form result(a.degree() - m);
  for (int k = result.degree(); k >= 0; --k) {
    mpz_divexact(result[k].get_mpz_t(), a[k + m].get_mpz_t(), b[m].get_mpz_t());
    for (int j = 0; j <= m; ++j) a[k + j] -= result[k] * b[j];
  }
  assert(a.is_zero() && "the divisor divides");
  return result;
}

/// The sign at (x, y), both not negative and not both zero.
int sign_at_ratio(const Form& form, const mpz_class& x, const mpz_class& y) {
  const int n = form.degree();
  mpz_class value = form[n], power = 1;
  for (int j = n - 1; j >= 0; --j) {
    power *= x;
    value *= y;
    mpz_addmul(value.get_mpz_t(), form[j].get_mpz_t(), power.get_mpz_t());
  }
  return sgn(value);
}

}  // namespace

Form::Form(const Form& other) : degree_(other.degree_) {  // an unused coefficient stays without memory
  for (int j = 0; j <= degree_; ++j) (*this)[j] = other[j];
}

Form Form::linear(const mpz_class& at_0, const mpz_class& at_1) {
  Form form(1);
  form[0] = at_0;
  form[1] = at_1;
  return form;
}

bool Form::is_zero() const {
  for (int j = 0; j <= degree_; ++j) {
    if (sgn((*this)[j]) != 0) return false;
  }
  return true;
}

Form operator+(const Form& a, const Form& b) {
  assert(a.degree() == b.degree());
  Form r(a.degree());
  for (int j = 0; j <= a.degree(); ++j) r[j] = a[j] + b[j];
  return r;
}

Form operator-(const Form& a, const Form& b) {
  assert(a.degree() == b.degree());
  Form r(a.degree());
  for (int j = 0; j <= a.degree(); ++j) r[j] = a[j] - b[j];
  return r;
}

void add_product(Form& sum, const Form& a, const Form& b) {
  assert(sum.degree() == a.degree() + b.degree());
  for (int i = 0; i <= a.degree(); ++i) {
    for (int j = 0; j <= b.degree(); ++j) {
      mpz_addmul(sum[i + j].get_mpz_t(), a[i].get_mpz_t(), b[j].get_mpz_t());
    }
  }
}

void subtract_product(Form& difference, const Form& a, const Form& b) {
  assert(difference.degree() == a.degree() + b.degree());
  for (int i = 0; i <= a.degree(); ++i) {
    for (int j = 0; j <= b.degree(); ++j) {
      mpz_submul(difference[i + j].get_mpz_t(), a[i].get_mpz_t(), b[j].get_mpz_t());
    }
  }
}

int sign_at(const Form& form, const DyadicTime& time) {
  return sign_at_ratio(form, (mpz_class(1) << time.exponent) - time.numerator, time.numerator);
}

int sign_at_rational(const Form& form, const mpq_class& time) {
  return sign_at_ratio(form, time.get_den() - time.get_num(), time.get_num());
}

mpz_class leading_coefficient(const Form& form) {
  // (1-t)^(n-j) t^j adds (-1)^(k-j) C(n-j, k-j) to the coefficient of t^k.
  const int n = form.degree();
  for (int k = n; k >= 0; --k) {
    mpz_class sum, binomial;
    for (int j = 0; j <= k; ++j) {
      mpz_bin_uiui(binomial.get_mpz_t(), static_cast<unsigned long>(n - j), static_cast<unsigned long>(k - j));
      sum += ((k - j) % 2 == 0 ? form[j] : mpz_class(-form[j])) * binomial;
    }
    if (sgn(sum) != 0) return sum;
  }
  assert(false && "the form is not zero");
  return 0;
}

int hull_sign(const Form& form) {
  const int first = sgn(form[0]);
  for (int j = 1; j <= form.degree(); ++j) {
    if (sgn(form[j]) != first) return 0;
  }
  return first;
}

int sign_variations(const Form& form) {
  int last = 0, count = 0;
  for (int j = 0; j <= form.degree(); ++j) {
    const int s = sgn(form[j]);
    if (s == 0) continue;
    if (s == -last) ++count;
    last = s;
  }
  return count;
}

Form restricted(const Form& form, const DyadicTime& lower) {
  const int n = form.degree();
  const mpz_class scale = mpz_class(1) << lower.exponent;
  const Form y = Form::linear(lower.numerator, lower.numerator + 1);
  const Form x = Form::linear(scale - lower.numerator, scale - lower.numerator - 1);
  Form result(0), power(0);  // Horner: result y + form[j] x^(n-j)
  result[0] = form[n];
  power[0] = 1;
  for (int j = n - 1; j >= 0; --j) {
    Form next_power(n - j), next(n - j);
    add_product(next_power, power, x);
    power = std::move(next_power);
    add_product(next, result, y);
    for (int i = 0; i <= n - j; ++i) mpz_addmul(next[i].get_mpz_t(), form[j].get_mpz_t(), power[i].get_mpz_t());
    result = std::move(next);
  }
  remove_power_of_two(result);
  return result;
}

// [1/2, 1]: with the half's own (x', y'), 2 x = x' and 2 y = x' + 2 y', so z = 2 z' + 1.
Form right_half(const Form& form) {
  Form r = form;
  shift_by_one(r);
  double_argument(r);
  remove_power_of_two(r);
  return r;
}

// [0, 1/2]: the mirror image, 1 / z = 2 / z' + 1.
Form left_half(const Form& form) {
  Form r = form;
  reverse(r);
  shift_by_one(r);
  double_argument(r);
  reverse(r);
  remove_power_of_two(r);
  return r;
}

Form without_roots_at_0(const Form& form) {
  int low = 0;
  while (low < form.degree() && sgn(form[low]) == 0) ++low;
  if (low == 0) return form;
  Form r(form.degree() - low);
  for (int j = 0; j <= r.degree(); ++j) r[j] = form[j + low];
  return r;
}

Form without_roots_at_1(const Form& form) {
  int high = form.degree();
  while (high > 0 && sgn(form[high]) == 0) --high;
  if (high == form.degree()) return form;
  Form r(high);
  for (int j = 0; j <= high; ++j) r[j] = form[j];
  return r;
}

Form common_divisor(const Form& a, const Form& b) {
  if (a.is_zero()) return common_divisor(b, a);
  Form p = without_roots_at_0(without_roots_at_1(a));
  make_primitive(p);
  if (b.is_zero()) return p;
  Form q = without_roots_at_0(without_roots_at_1(b));
  make_primitive(q);
  while (!q.is_zero()) {  // Euclid with primitive pseudo-remainders
    Form r = remainder(std::move(p), q);
    p = std::move(q);
    q = std::move(r);
  }
  return p;
}

Form square_free(const Form& form) {
  const int n = form.degree();
  if (n < 2) return form;
  Form derivative(n - 1);
  for (int j = 1; j <= n; ++j) derivative[j - 1] = form[j] * j;
  const Form repeated = common_divisor(form, derivative);
  return repeated.degree() == 0 ? form : quotient(form, repeated);
}

}  // namespace tightrope::ccd::oracle
