#pragma once
/// Exact rescaling by powers of two: keeps every stage's numbers near 1, so that polynomials of degree 24 neither
/// overflow nor underflow and answers do not depend on the scene's units (MATH 3.3, 4.4).

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "tightrope/sign.h"

namespace tightrope::ccd {

/// The power of two that takes x into [1/2, 1); 0 < x < 2^1022. A subnormal x is only taken below 1.
inline double scale_to_one(double x) {
  constexpr int mantissa_bits = 52;
  constexpr std::uint64_t bias = 1023;
  const std::uint64_t exponent = std::max<std::uint64_t>(std::bit_cast<std::uint64_t>(x) >> mantissa_bits, 1);
  return std::bit_cast<double>((2 * bias - 1 - exponent) << mantissa_bits);
}

/// Scales the tuple by one power of two such that no value or bound exceeds 1, the largest being at least 1/2 if it can
/// be. False if a number is not finite or as large as 2^1022 (the tuple is unchanged then and carries no sign).
///
/// The bound grows by the smallest normal number, which covers what scaling down loses to underflow: where the scaled
/// bound is larger than 2^52 times that, the loss (less than 2^-1074) is covered by the inflation that a bounded input
/// gets on entry (MATH 4.3).
inline bool rescale(std::span<Bounded<double>> tuple) {
  double largest = 0;
  bool finite = true;
  for (const Bounded<double>& x : tuple) {
    const double magnitude = std::max(tightrope::magnitude(x.value), x.bound);
    finite &= x.value - x.value == 0 && x.bound - x.bound == 0;
    largest = std::max(largest, magnitude);
  }
  if (!finite || largest >= 0x1p1022) return false;
  if (largest == 0) return true;
  const double factor = scale_to_one(largest);
  for (Bounded<double>& x : tuple) {
    x.value *= factor;
    x.bound = tightrope::product(x.bound, factor) + std::numeric_limits<double>::min();
  }
  return true;
}

}  // namespace tightrope::ccd
