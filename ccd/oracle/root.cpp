#include "ccd/oracle/root.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <utility>

namespace tightrope::ccd::oracle {
namespace {

DyadicTime child(const DyadicTime& lower, bool right) {
  return {2 * lower.numerator + (right ? 1 : 0), lower.exponent + 1};
}

mpq_class rational_of(const DyadicTime& time) {
  mpq_class r(time.numerator, mpz_class(1) << time.exponent);
  r.canonicalize();
  return r;
}

/// A double in [0, 1].
DyadicTime dyadic(double time) {
  int exponent = 0;
  const double fraction = std::frexp(time, &exponent);  // time = fraction * 2^53 * 2^(exponent - 53)
  return {mpz_class(std::ldexp(fraction, 53)), static_cast<unsigned long>(53 - exponent)};  // time <= 1: positive
}

/// Whether the positive root of f, its only one, is a root of g too. Both without roots at 0 and 1 in f: their common
/// divisor has at most that root there, a simple one, so it vanishes there if and only if its ends differ in sign.
bool share_the_root(const Form& f, const Form& g) {
  const Form divisor = common_divisor(f, g);
  return sgn(divisor[0]) * sgn(divisor[divisor.degree()]) < 0;
}

/// Adds the roots of a square-free form without roots at 0 and 1, in ascending order, by bisection until Descartes'
/// rule tells: one or no sign variation. An explicit stack, because close roots of large numbers lie thousands of
/// levels deep.
void isolate(const Form& whole, std::vector<Root>& found) {
  struct Part {
    DyadicTime lower;
    Form form;     // on the part's interval, without roots at its ends
    bool is_root;  // the part is the point `lower`, a root
  };
  std::vector<Part> pending;
  pending.push_back({{0, 0}, whole, false});
  while (!pending.empty()) {
    const Part part = std::move(pending.back());
    pending.pop_back();
    if (part.is_root) {
      found.push_back(Root::exactly(part.lower));
      continue;
    }
    const int variations = sign_variations(part.form);
    if (variations == 1) found.push_back(Root::isolated(part.lower, part.form));
    if (variations <= 1) continue;
    const Form left = left_half(part.form);
    const DyadicTime middle = child(part.lower, true);
    pending.push_back({middle, without_roots_at_0(right_half(part.form)), false});
    if (sgn(left[left.degree()]) == 0) pending.push_back({middle, Form(), true});
    pending.push_back({child(part.lower, false), without_roots_at_1(left), false});
  }
}

}  // namespace

bool Root::halve() {
  assert(!exact_);
  Form left = left_half(form_);
  const int middle = sgn(left[left.degree()]);
  const bool right = middle == 0 || middle == sgn(form_[0]);
  lower_ = child(lower_, right);
  if (middle == 0) {
    exact_ = true;
  } else {
    form_ = right ? right_half(form_) : std::move(left);
  }
  return right;
}

int Root::sign_at_first_sight(const Form& form) const {
  return exact_ ? sign_at(form, lower_) : hull_sign(restricted(form, lower_));
}

int Root::sign(const Form& form) {
  if (form.is_zero()) return 0;
  if (exact_) return sign_at(form, lower_);
  // Most signs show after a few bisections; the common divisor, which alone proves a zero, is computed once after that.
  // If it does not vanish at the root, `form` does not either, and bisection ends: its limit is a non-zero constant.
  constexpr int patience = 16;
  Form local = restricted(form, lower_);
  for (int step = 0;; ++step) {
    if (const int s = hull_sign(local); s != 0) return s;
    if (step == patience && share_the_root(form_, local)) return 0;
    const bool right = halve();
    if (exact_) return sign_at(form, lower_);
    local = right ? right_half(local) : left_half(local);
  }
}

int Root::compare(DyadicTime time) const {
  // On one scale: both as numerators over 2^(both exponents).
  time.numerator <<= lower_.exponent;
  time.numerator -= lower_.numerator << time.exponent;  // (time - lower) * 2^lower.exponent = numerator / 2^exponent
  if (exact_) return -sgn(time.numerator);
  if (sgn(time.numerator) <= 0) return 1;
  if (time.numerator >= mpz_class(1) << time.exponent) return -1;
  return sign_at(form_, time) * sgn(form_[0]);
}

int Root::compare(Root& other) {
  bool known_different = false;
  while (true) {
    if (exact_) return -other.compare(lower_);
    if (other.exact_) return compare(other.lower_);
    // Open intervals of one dyadic grid: once they are equally wide they are equal or disjoint.
    if (lower_.exponent != other.lower_.exponent) {
      (lower_.exponent < other.lower_.exponent ? *this : other).halve();
      continue;
    }
    if (const int order = cmp(lower_.numerator, other.lower_.numerator); order != 0) return order < 0 ? -1 : 1;
    if (!known_different && share_the_root(form_, other.form_)) return 0;
    known_different = true;
    halve();
  }
}

/// Over its interval's own parameter t' the form has integer coefficients, so that the denominator of a rational root
/// divides the leading one, a: a t' is an integer. The interval is narrowed until it leaves one integer to try.
std::optional<mpq_class> Root::rational() {
  if (exact_) return rational_of(lower_);
  const mpz_class a = abs(leading_coefficient(form_)) << lower_.exponent;  // a times a rational root: an integer
  while (!exact_ && a >= mpz_class(1) << lower_.exponent) halve();
  if (exact_) return rational_of(lower_);
  const mpz_class integer = ((lower_.numerator * a) >> lower_.exponent) + 1;  // the ends of the interval are no roots
  mpq_class time(integer, a);
  time.canonicalize();
  const mpq_class own = time * (mpz_class(1) << lower_.exponent) - lower_.numerator;
  if (own >= 1 || sign_at_rational(form_, own) != 0) return std::nullopt;
  return time;
}

TimeInterval Root::interval(const mpq_class& width) {
  assert(width > 0);
  if (const auto time = rational()) return {*time, *time};
  while (mpq_class(1, mpz_class(1) << lower_.exponent) > width) halve();  // irrational: never exact
  return {rational_of(lower_), rational_of({lower_.numerator + 1, lower_.exponent})};
}

Contact Root::enclosure() const {
  // Doubles in [0, 1] are ordered as their bit patterns are: bisection over those also reaches times near 0 quickly.
  const auto as_double = [](std::uint64_t pattern) { return std::bit_cast<double>(pattern); };
  std::uint64_t below = 0, above = std::bit_cast<std::uint64_t>(1.0);
  if (compare(dyadic(0.0)) == 0) return {0.0, 0.0};
  if (compare(dyadic(1.0)) == 0) return {1.0, 1.0};
  while (above - below > 1) {  // as_double(below) < this time < as_double(above)
    const std::uint64_t middle = below + (above - below) / 2;
    const int order = compare(dyadic(as_double(middle)));
    if (order == 0) return {as_double(middle), as_double(middle)};
    (order > 0 ? below : above) = middle;
  }
  return {as_double(below), as_double(above)};
}

std::vector<Root> roots(const Form& form) {
  assert(!form.is_zero());
  std::vector<Root> found;
  if (sgn(form[0]) == 0) found.push_back(Root::exactly({0, 0}));
  const Form inner = without_roots_at_0(without_roots_at_1(form));
  const int variations = sign_variations(inner);
  if (variations > 0) isolate(variations == 1 ? inner : square_free(inner), found);
  if (sgn(form[form.degree()]) == 0) found.push_back(Root::exactly({1, 0}));
  return found;
}

}  // namespace tightrope::ccd::oracle
