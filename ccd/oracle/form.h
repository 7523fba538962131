#pragma once
/// Exact binary forms: homogeneous polynomials in (x, y) = (1 - t, t) with integer coefficients.
///
/// Coefficient j belongs to x^(n-j) y^j and is a positive multiple of the j-th Bernstein coefficient on [0, 1], so hull
/// tests and Descartes' rule read its sign directly. Read as ordinary polynomials in z = y / x they have a gcd; roots t
/// in (0, 1) are the positive roots z. A factor y is a root at t = 0, a factor x one at t = 1.

#include <gmpxx.h>

#include <array>
#include <cstddef>

namespace tightrope::ccd::oracle {

/// A dyadic time numerator / 2^exponent.
struct DyadicTime {
  mpz_class numerator;
  unsigned long exponent = 0;
};

class Form {
 public:
  static constexpr int max_degree = 4;

  explicit Form(int degree = 0) : degree_(degree) {}  ///< zero
  Form(const Form& other);
  Form(Form&& other) = default;
  Form& operator=(const Form& other) { return *this = Form(other); }
  Form& operator=(Form&& other) = default;
  ~Form() = default;
  static Form linear(const mpz_class& at_0, const mpz_class& at_1);

  int degree() const { return degree_; }  ///< nominal: the leading coefficient may be zero
  mpz_class& operator[](int j) { return coefficients_[static_cast<std::size_t>(j)]; }
  const mpz_class& operator[](int j) const { return coefficients_[static_cast<std::size_t>(j)]; }
  bool is_zero() const;

 private:
  std::array<mpz_class, max_degree + 1> coefficients_;  // an mpz allocates when first written, so unused ones are free
  int degree_;
};

Form operator+(const Form& a, const Form& b);  ///< of equal degrees
Form operator-(const Form& a, const Form& b);  ///< of equal degrees
/// sum += a * b, degrees adding up to sum's.
void add_product(Form& sum, const Form& a, const Form& b);
/// difference -= a * b, degrees adding up to difference's.
void subtract_product(Form& difference, const Form& a, const Form& b);

/// The sign of the form at `time`, which must lie in [0, 1].
int sign_at(const Form& form, const DyadicTime& time);
int sign_at_rational(const Form& form, const mpq_class& time);
/// The leading coefficient of the form as an ordinary polynomial in t; not for zero.
mpz_class leading_coefficient(const Form& form);
/// The common strict sign of all coefficients, hence of all values on [0, 1]; 0 if there is none.
int hull_sign(const Form& form);
/// Sign changes in the coefficients, zeros skipped: by Descartes' rule the number of roots in the open (0, 1), counted
/// with multiplicity, is this or less by an even number.
int sign_variations(const Form& form);

/// The form on [numerator, numerator + 1] / 2^exponent, over that interval's own parameter in [0, 1].
Form restricted(const Form& form, const DyadicTime& lower);
Form left_half(const Form& form);   ///< restricted to [0, 1/2], up to a positive factor
Form right_half(const Form& form);  ///< restricted to [1/2, 1], up to a positive factor

/// The form divided by y, resp. x, as often as possible: without its roots at t = 0, resp. t = 1. Not for zero.
Form without_roots_at_0(const Form& form);
Form without_roots_at_1(const Form& form);
/// A greatest common divisor, up to a constant, without roots at 0 and 1; not both may be zero.
Form common_divisor(const Form& a, const Form& b);
/// With every root in (0, 1) simple and the same set of them; for forms that do not vanish at 0 and 1.
Form square_free(const Form& form);

}  // namespace tightrope::ccd::oracle
