#pragma once
/// Families of small queries for tests of the oracle: coordinates that make degenerate cases frequent.

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "static_contact.h"

namespace tightrope::ccd::test {

class QueryMaker {
 public:
  explicit QueryMaker(std::uint64_t seed) : engine_(seed) {}

  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }

  static constexpr int families = 8;
  /// A query of one family, all coordinates small dyadic numbers.
  Points make(int family) {
    switch (family) {
      case 0:
        return lattice(2);
      case 1:
        return lattice(1);
      case 2:
        return partly_still();
      case 3:
        return in_one_plane();
      case 4:
        return on_one_line();
      case 5:
        return with_coincident_points();
      case 6:
        return translating_together();
      default:
        return shrinking();
    }
  }

 private:
  Points lattice(int radius) {
    Points p;
    for (double& x : p) x = integer(-radius, radius);
    return p;
  }
  Points partly_still() {
    Points p = lattice(2);
    for (std::size_t i = 0; i < 12; ++i) {
      if (integer(0, 3) != 0) p[i + 12] = p[i];
    }
    return p;
  }
  /// Y vanishes identically; half the time the plane itself moves along.
  Points in_one_plane() {
    Points p, basis = lattice(2);
    for (std::size_t i = 0; i < 8; ++i) {
      const double u = integer(-3, 3), v = integer(-3, 3);
      for (std::size_t k = 0; k < 3; ++k) p[3 * i + k] = basis[k] + u * basis[3 + k] + v * basis[6 + k];
    }
    if (integer(0, 1) != 0) {
      for (std::size_t i = 12; i < 24; ++i) p[i] += basis[9 + i % 3];
    }
    return p;
  }
  Points on_one_line() {
    Points p, basis = lattice(1);
    for (std::size_t i = 0; i < 8; ++i) {
      const double u = integer(-4, 4);
      for (std::size_t k = 0; k < 3; ++k) p[3 * i + k] = basis[k] + u * basis[3 + k] + (i < 4 ? 0 : basis[6 + k]);
    }
    return p;
  }
  Points with_coincident_points() {
    Points p = lattice(2);
    const auto from = static_cast<std::size_t>(integer(0, 3)), to = static_cast<std::size_t>(integer(0, 3));
    for (std::size_t k = 0; k < 3; ++k) {
      p[3 * to + k] = p[3 * from + k];
      if (integer(0, 2) != 0) p[12 + 3 * to + k] = p[12 + 3 * from + k];
    }
    return p;
  }
  Points translating_together() {
    Points p = lattice(2);
    const bool flat = integer(0, 1) != 0;
    const std::array<double, 3> step = {double(integer(-2, 2)), double(integer(-2, 2)), double(integer(-2, 2))};
    for (std::size_t i = 0; i < 12; ++i) {
      if (flat && i % 3 == 2) p[i] = 0;
      p[i + 12] = p[i] + step[i % 3];
    }
    return p;
  }
  /// Points that meet or pass through one centre together, at t = 1/2 or 1/3, but for one of them.
  Points shrinking() {
    Points p = lattice(2);
    const std::array<double, 3> centre = {double(integer(-1, 1)), double(integer(-1, 1)), double(integer(-1, 1))};
    const double factor = integer(1, 2);
    const auto free_point = static_cast<std::size_t>(integer(0, 5));
    for (std::size_t i = 0; i < 12; ++i) {
      if (i / 3 != free_point) p[i + 12] = centre[i % 3] + factor * (centre[i % 3] - p[i]);
    }
    return p;
  }

  std::mt19937_64 engine_;
};

}  // namespace tightrope::ccd::test
