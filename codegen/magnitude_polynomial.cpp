#include "codegen/magnitude_polynomial.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "codegen/precision.h"

namespace tightrope::codegen {

MagnitudePolynomial MagnitudePolynomial::constant(double c) {
  MagnitudePolynomial p;
  if (c > 0) p.terms_[{}] = c;
  return p;
}

MagnitudePolynomial MagnitudePolynomial::variable(int group) {
  MagnitudePolynomial p;
  Monomial m(static_cast<std::size_t>(group) + 1, 0);
  m.back() = 1;
  p.terms_[m] = 1;
  return p;
}

MagnitudePolynomial MagnitudePolynomial::operator+(const MagnitudePolynomial& other) const {
  MagnitudePolynomial sum = *this;
  for (const auto& [monomial, coefficient] : other.terms_) {
    double& c = sum.terms_[monomial];
    c = add_up(c, coefficient);
  }
  return sum;
}

MagnitudePolynomial MagnitudePolynomial::operator*(const MagnitudePolynomial& other) const {
  MagnitudePolynomial product;
  for (const auto& [x, cx] : terms_) {
    for (const auto& [y, cy] : other.terms_) {
      Monomial m = x.size() >= y.size() ? x : y;
      const Monomial& shorter = x.size() >= y.size() ? y : x;
      for (std::size_t i = 0; i < shorter.size(); ++i) m[i] += shorter[i];
      double& c = product.terms_[m];
      c = add_up(c, mul_up(cx, cy));
    }
  }
  return product;
}

MagnitudePolynomial MagnitudePolynomial::scaled(double factor) const {
  MagnitudePolynomial result = *this;
  for (auto& entry : result.terms_) entry.second = mul_up(entry.second, factor);
  return result;
}

MagnitudePolynomial MagnitudePolynomial::max(const MagnitudePolynomial& x, const MagnitudePolynomial& y) {
  MagnitudePolynomial result = x;
  for (const auto& [monomial, coefficient] : y.terms_) {
    double& c = result.terms_[monomial];
    c = std::max(c, coefficient);
  }
  return result;
}

int MagnitudePolynomial::degree() const {
  int degree = 0;
  for (const auto& [monomial, coefficient] : terms_) {
    degree = std::max(degree, std::accumulate(monomial.begin(), monomial.end(), 0));
  }
  return degree;
}

double MagnitudePolynomial::coefficient_sum() const {
  double sum = 0;
  for (const auto& [monomial, coefficient] : terms_) sum = add_up(sum, coefficient);
  return sum;
}

double MagnitudePolynomial::at(const std::vector<double>& values) const {
  double sum = 0;
  for (const auto& [monomial, coefficient] : terms_) {
    double product = coefficient;
    for (std::size_t i = 0; i < monomial.size(); ++i) {
      for (int e = 0; e < monomial[i]; ++e) product = mul_up(product, values[i]);
    }
    sum = add_up(sum, product);
  }
  return sum;
}

std::string MagnitudePolynomial::text(const std::vector<std::string>& group_names) const {
  std::string result;
  for (const auto& [monomial, coefficient] : terms_) {
    if (!result.empty()) result += " + ";
    std::string product = coefficient == 1 && !monomial.empty() ? "" : fmt::format("{:.6g}", coefficient);
    for (std::size_t i = 0; i < monomial.size(); ++i) {
      if (monomial[i] == 0) continue;
      if (!product.empty()) product += ' ';
      product += group_names[i];
      if (monomial[i] > 1) product += fmt::format("^{}", monomial[i]);
    }
    result += product;
  }
  return result.empty() ? "0" : result;
}

}  // namespace tightrope::codegen
