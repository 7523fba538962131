#pragma once
/// Exact rescaling by powers of two: keeps every stage's numbers near 1, so that polynomials of degree 24 neither
/// overflow nor underflow and answers do not depend on the scene's units (MATH 3.3, 4.4), in double and in float.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

#include "ccd/host_device.h"
#include "tightrope/sign.h"

namespace tightrope::ccd {

/// 2^exponent; normal numbers only.
template <class Real>
constexpr Real power_of_two(int exponent) {
  using Bits = std::conditional_t<sizeof(Real) == 8, std::uint64_t, std::uint32_t>;
  return std::bit_cast<Real>(static_cast<Bits>(exponent + std::numeric_limits<Real>::max_exponent - 1)
                             << (std::numeric_limits<Real>::digits - 1));
}

/// What a bound that comes in is multiplied with so that the rounding of bounds is covered (MATH 4.3, 4.7), as
/// generated code does.
template <class Real>
inline constexpr Real inflation = 1 + power_of_two<Real>(sizeof(Real) == 8 ? -20 : -10);

/// What the floor of underflow is taken to be after normalisation (MATH 4.4, 4.7).
template <class Real>
inline constexpr Real underflow_floor = power_of_two<Real>(sizeof(Real) == 8 ? -1000 : -120);

/// Numbers from here on are not rescaled: 2^1022, 2^126.
template <class Real>
inline constexpr Real rescaling_limit = power_of_two<Real>(std::numeric_limits<Real>::max_exponent - 2);

/// The power of two that takes x into [1/2, 1); 0 < x < rescaling_limit. A subnormal x is only taken below 1.
template <class Real>
TIGHTROPE_HOST_DEVICE Real scale_to_one(Real x) {
  using Bits = std::conditional_t<sizeof(Real) == 8, std::uint64_t, std::uint32_t>;
  constexpr int mantissa_bits = std::numeric_limits<Real>::digits - 1;
  constexpr Bits bias = std::numeric_limits<Real>::max_exponent - 1;
  const Bits exponent = std::max<Bits>(std::bit_cast<Bits>(x) >> mantissa_bits, 1);
  return std::bit_cast<Real>((2 * bias - 1 - exponent) << mantissa_bits);
}

/// Scales the tuple by one power of two such that no value or bound exceeds 1, the largest being at least 1/2 if it can
/// be. False if a number is not finite or as large as `rescaling_limit` (the tuple is unchanged then and carries no
/// sign).
///
/// The bound grows by the smallest normal number, which covers what scaling down loses to underflow: where the scaled
/// bound is larger than 2^52 (2^23) times that, the loss (less than 2^-1074, 2^-149) is covered by the inflation that a
/// bounded input gets on entry (MATH 4.3).
template <class Real, std::size_t Extent>
TIGHTROPE_HOST_DEVICE bool rescale(std::span<Bounded<Real>, Extent> tuple) {
  Real largest = 0;
  bool finite = true;
  for (const Bounded<Real>& x : tuple) {
    const Real magnitude = std::max(tightrope::magnitude(x.value), x.bound);
    finite &= x.value - x.value == 0 && x.bound - x.bound == 0;
    largest = std::max(largest, magnitude);
  }
  if (!finite || largest >= rescaling_limit<Real>) return false;
  if (largest == 0) return true;
  const Real factor = scale_to_one(largest);
  for (Bounded<Real>& x : tuple) {
    x.value *= factor;
    x.bound = tightrope::product(x.bound, factor) + std::numeric_limits<Real>::min();
  }
  return true;
}
template <class Real, std::size_t N>
TIGHTROPE_HOST_DEVICE bool rescale(std::array<Bounded<Real>, N>& tuple) {
  return rescale(std::span(tuple));
}
template <class Real, std::size_t N>
TIGHTROPE_HOST_DEVICE bool rescale(Bounded<Real> (&tuple)[N]) {
  return rescale(std::span(tuple));
}

}  // namespace tightrope::ccd
