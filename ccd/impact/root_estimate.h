#pragma once
/// Where a cubic's root is, about: floating point without bounds. It chooses where exact signs are asked and decides
/// nothing.

#include <array>

namespace tightrope::ccd {

/// Root number `index` in (0, 1) of the cubic with the Bernstein coefficients k; in [0, 1] whatever k is.
double root_estimate(const std::array<double, 4>& k, int index);

/// Where it crosses zero in [a, b], upwards (`rising`) or downwards; in [a, b] whatever k is.
double crossing_estimate(const std::array<double, 4>& k, double a, double b, bool rising);

}  // namespace tightrope::ccd
