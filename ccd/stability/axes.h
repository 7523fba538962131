#pragma once
/// What the stability atlas sweeps.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tightrope::ccd::stability {

/// The type that methods compute in; coordinates are rounded to it.
enum class Real { in_double, in_float };

std::string_view name(Real real);  ///< "double", "float"

/// A cell of a map is one value of each axis.
struct Axes {
  /// How far each coordinate is moved at most, in sizes of the query. 0: not moved; see BaseQueries.
  std::vector<double> distances;
  /// Exponents of the powers of two that all coordinates are multiplied with, for double; for float half of them.
  std::vector<int> scales;
  /// Distances from the origin before scaling, in sizes of the query, about.
  std::vector<double> offsets;

  std::size_t cells() const { return distances.size() * scales.size() * offsets.size(); }
  /// Maps are stored offset by offset, in them distance by distance.
  std::size_t cell(std::size_t offset, std::size_t distance, std::size_t scale) const {
    return (offset * distances.size() + distance) * scales.size() + scale;
  }
  bool operator==(const Axes&) const = default;
};

/// 0, 1e-18, 1e-16 .. 1; 2^-200 .. 2^200; 0, 1, 2^10, 2^20, 2^40.
Axes full_axes();

/// Few values of each, for the tests.
Axes small_axes();

/// The exponent that is meant for this type.
int scale_exponent(int of_double, Real real);

}  // namespace tightrope::ccd::stability
