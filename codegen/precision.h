#pragma once
/// The constants of a floating-point format that error bounds are made of (MATH 4.1, 4.3, 4.7).

#include "codegen/bounds.h"

namespace tightrope::codegen {

/// A binary floating-point format with gradual underflow, infinities and NaN; at most that of `double`.
struct FloatFormat {
  int significand_bits;  ///< the leading one included: 53, 24
  int min_exponent;      ///< of the smallest positive normal number, 2^min_exponent: -1022, -126
  int max_exponent;      ///< of the largest finite number, below 2^(max_exponent + 1): 1023, 127
  double unit_roundoff;  ///< u: |fl(x) - x| <= u |fl(x)| barring underflow
  double eta;            ///< the smallest positive subnormal; a rounding in the subnormal range errs by at most eta / 2
  double slack;        ///< delta: rules use u (1 + delta) in place of u, which pays for the roundings inside the bound;
                       ///< 0: the ideal rules, whose bounds hold only if they are evaluated exactly (tests/rules)
  double floor_limit;  ///< a compile-time underflow floor above this would spoil the bounds: use run-time terms instead
  double largest;      ///< the largest finite number
};

const FloatFormat& format(Precision precision);

/// `value` rounded up to a number that the format holds (and never below the exact real it stands for if `value` is).
double round_up(double value, const FloatFormat& format);

/// Whether the format holds `value` exactly.
bool representable(double value, const FloatFormat& format);

/// x * y and x + y and x / y of non-negative numbers, never below the exact result.
double mul_up(double x, double y);
double add_up(double x, double y);
double div_up(double x, double y);

}  // namespace tightrope::codegen
