#include "codegen/precision.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tightrope::codegen {

namespace {
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr FloatFormat binary64{53, -1022, 1023, 0x1p-53, 0x1p-1074, 0x1p-20, 0x1p-920, 0x1.fffffffffffffp+1023};
constexpr FloatFormat binary32{24, -126, 127, 0x1p-24, 0x1p-149, 0x1p-10, 0x1p-110, 0x1.fffffep+127};
}  // namespace

const FloatFormat& format(Precision precision) { return precision == Precision::binary64 ? binary64 : binary32; }

double round_up(double value, const FloatFormat& format) {
  if (std::isnan(value) || value == 0) return value;
  // The spacing of the format's numbers around `value` is a power of two, so that quotient and product are exact.
  const int exponent = std::max(std::ilogb(value), format.min_exponent);
  const int spacing = exponent - format.significand_bits + 1;
  if (std::isinf(value) || spacing < -1074) return value;
  const double rounded = std::ldexp(std::ceil(std::ldexp(value, -spacing)), spacing);
  return rounded > format.largest ? infinity : rounded;
}

bool representable(double value, const FloatFormat& format) {
  return std::abs(value) <= format.largest && round_up(value, format) == value;
}

// The residual of a product is exact in an fma unless it underflows, and the one of a sum by TwoSum; where a result is
// not proved exact it is moved up by one ulp, which is never too little: rounding to nearest errs by at most half of
// it.
double mul_up(double x, double y) {
  const double p = x * y;
  if (p > 0x1p-960 && std::fma(x, y, -p) <= 0) return p;
  if (x == 0 || y == 0) return 0;
  return std::nextafter(p, infinity);
}

double add_up(double x, double y) {
  const double s = x + y;
  const double x_part = s - y;
  const double error = (x - x_part) + (y - (s - x_part));
  return error <= 0 ? s : std::nextafter(s, infinity);
}

double div_up(double x, double y) {
  const double q = x / y;
  if (x == 0) return 0;
  if (q > 0x1p-900 && x > 0x1p-900 && std::fma(q, y, -x) >= 0) return q;
  return std::nextafter(q, infinity);
}

}  // namespace tightrope::codegen
