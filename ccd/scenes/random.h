#pragma once
/// Random numbers that are the same on every machine: std::mt19937_64 is specified bit by bit, the standard's
/// distributions are not. For the same reason the scenes use only + - * / and sqrt, which IEEE 754 rounds correctly,
/// and never two draws in one expression, whose order C++ leaves open.

#include <cmath>
#include <cstdint>
#include <random>

namespace tightrope::ccd {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [0, 1), a multiple of 2^-53.
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * uniform(); }

  /// Uniform in {low, .., high} but for a bias below 2^-32.
  int integer(int low, int high) {
    const auto count = static_cast<std::uint64_t>(static_cast<std::int64_t>(high) - low + 1);
    return static_cast<int>(low + static_cast<std::int64_t>(engine_() % count));
  }
  bool chance(double probability) { return uniform() < probability; }

  /// Of random sign and of a magnitude in [2^low, 2^(high + 1)), every binade equally likely.
  double magnitude(int low, int high) {
    const int exponent = integer(low, high);
    const double mantissa = between(1, 2);
    return std::ldexp(chance(0.5) ? mantissa : -mantissa, exponent);
  }

 private:
  std::mt19937_64 engine_;
};

/// Seeds of independent streams from one seed (splitmix64's output function, Steele, Lea, Flood 2014).
inline std::uint64_t derived_seed(std::uint64_t seed, std::uint64_t stream) {
  std::uint64_t z = seed + 0x9e3779b97f4a7c15u * (stream + 1);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

}  // namespace tightrope::ccd
