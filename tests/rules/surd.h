#pragma once
/// Exact numbers with at most one square root, for judging roots: r + s sqrt(q), r and q >= 0 rational, s = -1, 0, 1.

#include <tightrope/exact.h>

namespace tightrope::rules {

/// Closed under the operations that the rule cases use: everything on rationals, one root, its sums and products with
/// rationals. What is not closed ends the program (a case that needs it is a mistake of the test).
class Surd {
 public:
  Surd() = default;
  explicit Surd(DyadicRatio rational) : rational_(std::move(rational)) {}

  friend Surd operator-(const Surd& a) { return {-a.rational_, -a.sign_, a.radicand_}; }
  friend Surd operator+(const Surd& a, const Surd& b) {
    if (a.sign_ != 0 && b.sign_ != 0) detail::exact_precondition_violated("one root a sum");
    const Surd& rooted = a.sign_ != 0 ? a : b;
    return {a.rational_ + b.rational_, rooted.sign_, rooted.radicand_};
  }
  friend Surd operator-(const Surd& a, const Surd& b) { return a + -b; }
  friend Surd operator*(const Surd& a, const Surd& b) {
    if (b.sign_ != 0) return a.sign_ == 0 ? b * a : product_of_roots(a, b);
    const DyadicRatio& t = b.rational_;
    return {a.rational_ * t, a.sign_ * t.sign(), a.radicand_ * t * t};
  }
  friend Surd operator/(const Surd& a, const Surd& b) {
    if (b.sign_ != 0) detail::exact_precondition_violated("divisors without roots");
    return a * Surd(DyadicRatio(1) / b.rational_);
  }
  friend Surd sqrt(const Surd& a) {
    if (a.sign_ != 0 || a.rational_.sign() < 0) detail::exact_precondition_violated("roots of rationals >= 0");
    return {DyadicRatio(), a.rational_.sign(), a.rational_};
  }
  friend Surd mul_pow2(const Surd& a, int k) { return a * Surd(mul_pow2(DyadicRatio(1), k)); }
  friend Surd abs(const Surd& a) { return a.sign() < 0 ? -a : a; }
  friend Surd min(const Surd& a, const Surd& b) { return (a - b).sign() < 0 ? a : b; }
  friend Surd max(const Surd& a, const Surd& b) { return (a - b).sign() < 0 ? b : a; }
  friend Surd fma(const Surd& a, const Surd& b, const Surd& c) { return a * b + c; }

  /// -1, 0, +1: r against -s sqrt(q) by their squares.
  int sign() const {
    if (sign_ == 0 || rational_.sign() == 0) return sign_ + rational_.sign();
    if (sign_ == rational_.sign()) return sign_;
    const auto order = radicand_ <=> rational_ * rational_;
    return order > 0 ? sign_ : order < 0 ? -sign_ : 0;
  }

 private:
  Surd(DyadicRatio rational, int sign, DyadicRatio radicand)
      : rational_(std::move(rational)), sign_(sign), radicand_(std::move(radicand)) {}
  static Surd product_of_roots(const Surd& a, const Surd& b) {
    if (a.rational_.sign() != 0 || b.rational_.sign() != 0) detail::exact_precondition_violated("pure roots");
    return {DyadicRatio(), a.sign_ * b.sign_, a.radicand_ * b.radicand_};
  }

  DyadicRatio rational_;
  int sign_ = 0;
  DyadicRatio radicand_;
};

}  // namespace tightrope::rules
