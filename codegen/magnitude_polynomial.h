#pragma once
/// B of SafeBound: a polynomial with non-negative coefficients in the maxima of the groups of inputs.

#include <map>
#include <string>
#include <vector>

#include "dsl/graph.h"

namespace tightrope::codegen {

/// Exponents of the groups, by group number, trailing zeros cut off.
using Monomial = std::vector<int>;

/// Coefficients are rounded up, so the polynomial is never below the exact one.
class MagnitudePolynomial {
 public:
  static MagnitudePolynomial constant(double c);
  static MagnitudePolynomial variable(int group);

  MagnitudePolynomial operator+(const MagnitudePolynomial& other) const;
  MagnitudePolynomial operator*(const MagnitudePolynomial& other) const;
  MagnitudePolynomial scaled(double factor) const;
  /// Coefficient by coefficient, the larger: not below either of the two.
  static MagnitudePolynomial max(const MagnitudePolynomial& x, const MagnitudePolynomial& y);

  std::size_t terms() const { return terms_.size(); }
  int degree() const;
  double coefficient_sum() const;
  /// The value where group g's maximum is values[g], rounded up.
  double at(const std::vector<double>& values) const;
  /// "6 d_x d_y d_z + 2 d_x^2"
  std::string text(const std::vector<std::string>& group_names) const;
  const std::map<Monomial, double>& monomials() const { return terms_; }

 private:
  std::map<Monomial, double> terms_;
};

}  // namespace tightrope::codegen
