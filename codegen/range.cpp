#include "codegen/range.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tightrope::codegen {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Residuals of products above this are exact in an fma; below, they may underflow.
constexpr double safe_product = 0x1p-900;

/// 0 where `rounded` is exact, else of the sign of exact - rounded or, if that is unknown, NaN.
double residual_of_sum(double x, double y, double rounded) {
  const double x_part = rounded - y;  // TwoSum: exact, or NaN after an overflow
  const double y_part = rounded - x_part;
  return (x - x_part) + (y - y_part);
}

double residual_of_product(double x, double y, double rounded) {
  if (x == 0 || y == 0) return 0;
  return std::abs(rounded) > safe_product ? std::fma(x, y, -rounded) : std::nan("");
}

/// Of exact - rounded, where the quotient is of ordinary size: the sign of x - rounded y, times that of y.
double residual_of_quotient(double x, double y, double rounded) {
  if (x == 0) return 0;
  if (!(std::abs(rounded) > safe_product) || !(std::abs(x) > safe_product)) return std::nan("");
  const double rest = std::fma(-rounded, y, x);
  return y < 0 ? -rest : rest;
}

// Rounding to nearest errs by less than one unit in the last place, so the neighbour is on the safe side.
double up(double rounded, double residual) { return residual <= 0 ? rounded : std::nextafter(rounded, infinity); }
double down(double rounded, double residual) { return residual >= 0 ? rounded : std::nextafter(rounded, -infinity); }

/// 0 times an infinite end is 0: the end stands for arbitrarily large real numbers.
double product(double x, double y) { return x == 0 || y == 0 ? 0 : x * y; }

}  // namespace

double sum_up(double x, double y) { return up(x + y, residual_of_sum(x, y, x + y)); }
double sum_down(double x, double y) { return down(x + y, residual_of_sum(x, y, x + y)); }
double product_up(double x, double y) { return up(product(x, y), residual_of_product(x, y, product(x, y))); }
double product_down(double x, double y) { return down(product(x, y), residual_of_product(x, y, product(x, y))); }
double quotient_up(double x, double y) { return up(x / y, residual_of_quotient(x, y, x / y)); }
double quotient_down(double x, double y) { return down(x / y, residual_of_quotient(x, y, x / y)); }

double root_up(double x) {
  const double root = std::sqrt(x);
  return x > safe_product && std::fma(root, root, -x) >= 0 ? root : x == 0 ? 0 : std::nextafter(root, infinity);
}

double root_down(double x) {
  const double root = std::sqrt(x);
  return x > safe_product && std::fma(root, root, -x) <= 0 ? root : x == 0 ? 0 : std::nextafter(root, 0.0);
}

double scaled_up(double x, int exponent) {
  const double scaled = std::ldexp(x, exponent);
  return std::ldexp(scaled, -exponent) == x ? scaled : std::nextafter(scaled, infinity);
}

double scaled_down(double x, int exponent) {
  const double scaled = std::ldexp(x, exponent);
  return std::ldexp(scaled, -exponent) == x ? scaled : std::nextafter(scaled, -infinity);
}

Range symmetric(double magnitude) { return {-magnitude, magnitude}; }
double magnitude(const Range& x) { return std::max(std::abs(x.lo), std::abs(x.hi)); }
bool contains_zero(const Range& x) { return x.lo <= 0 && x.hi >= 0; }
double mignitude(const Range& x) { return contains_zero(x) ? 0 : std::min(std::abs(x.lo), std::abs(x.hi)); }

Range operator+(const Range& x, const Range& y) { return {sum_down(x.lo, y.lo), sum_up(x.hi, y.hi)}; }
Range operator-(const Range& x, const Range& y) { return {sum_down(x.lo, -y.hi), sum_up(x.hi, -y.lo)}; }
Range operator-(const Range& x) { return {-x.hi, -x.lo}; }

Range operator*(const Range& x, const Range& y) {
  return {std::min(
              {product_down(x.lo, y.lo), product_down(x.lo, y.hi), product_down(x.hi, y.lo), product_down(x.hi, y.hi)}),
          std::max({product_up(x.lo, y.lo), product_up(x.lo, y.hi), product_up(x.hi, y.lo), product_up(x.hi, y.hi)})};
}

Range square(const Range& x) {
  return {product_down(mignitude(x), mignitude(x)), product_up(magnitude(x), magnitude(x))};
}

Range quotient(const Range& x, const Range& y) {
  if (!std::isfinite(magnitude(x)) || !std::isfinite(magnitude(y))) return symmetric(infinity);
  return {
      std::min(
          {quotient_down(x.lo, y.lo), quotient_down(x.lo, y.hi), quotient_down(x.hi, y.lo), quotient_down(x.hi, y.hi)}),
      std::max({quotient_up(x.lo, y.lo), quotient_up(x.lo, y.hi), quotient_up(x.hi, y.lo), quotient_up(x.hi, y.hi)})};
}

Range root(const Range& x) { return {root_down(std::max(x.lo, 0.0)), root_up(std::max(x.hi, 0.0))}; }
Range scaled(const Range& x, int exponent) { return {scaled_down(x.lo, exponent), scaled_up(x.hi, exponent)}; }
Range absolute(const Range& x) { return {mignitude(x), magnitude(x)}; }
Range minimum(const Range& x, const Range& y) { return {std::min(x.lo, y.lo), std::min(x.hi, y.hi)}; }
Range hull(const Range& x, const Range& y) { return {std::min(x.lo, y.lo), std::max(x.hi, y.hi)}; }

Range maximum(const Range& x, const Range& y) { return {std::max(x.lo, y.lo), std::max(x.hi, y.hi)}; }
Range widened(const Range& x, double distance) { return {sum_down(x.lo, -distance), sum_up(x.hi, distance)}; }
Range intersection(const Range& x, const Range& y) { return {std::max(x.lo, y.lo), std::min(x.hi, y.hi)}; }

}  // namespace tightrope::codegen
