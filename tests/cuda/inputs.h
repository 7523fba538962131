#pragma once
/// Seeded inputs of several kinds, from a generator of integers alone: the same numbers from every compiler.

#include <cmath>
#include <cstdint>
#include <limits>

namespace tightrope_test {

enum class Kind { uniform, lattice, close, scaled, subnormal, any_exponent, not_finite };

struct Family {
  const char* name;
  Kind kind;
};

inline constexpr Family families[] = {
    {"uniform", Kind::uniform},       {"lattice", Kind::lattice},     {"close", Kind::close},
    {"scaled", Kind::scaled},         {"subnormal", Kind::subnormal}, {"any-exponent", Kind::any_exponent},
    {"not-finite", Kind::not_finite},
};

/// SplitMix64 [Steele, Lea, Flood 2014], seeded by two texts.
class Random {
 public:
  Random(const char* a, const char* b) {
    for (; *a; ++a) state_ = (state_ ^ static_cast<unsigned char>(*a)) * 0x100000001b3;
    for (; *b; ++b) state_ = (state_ ^ static_cast<unsigned char>(*b)) * 0x100000001b3;
  }

  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

  template <class Real>
  Real number(Kind kind) {
    using Limits = std::numeric_limits<Real>;
    switch (kind) {
      case Kind::uniform:
        return uniform<Real>();
      case Kind::lattice:
        return static_cast<Real>(static_cast<int>(bits() % 7) - 3);
      case Kind::close:
        return 1 + std::ldexp(uniform<Real>(), -12);
      case Kind::scaled:
        return std::ldexp(uniform<Real>(), between(-Limits::max_exponent / 4, Limits::max_exponent / 4));
      case Kind::subnormal:
        return std::ldexp(uniform<Real>(), between(Limits::min_exponent - Limits::digits, Limits::min_exponent + 3));
      case Kind::any_exponent:
        return std::ldexp(uniform<Real>(), between(Limits::min_exponent - Limits::digits, Limits::max_exponent));
      case Kind::not_finite:
        break;
    }
    switch (bits() % 64) {
      case 0:
        return Limits::quiet_NaN();
      case 1:
        return Limits::infinity();
      case 2:
        return -Limits::infinity();
      default:
        return uniform<Real>();
    }
  }

  /// The bound of an input x: nothing, a few roundings, or half of it.
  template <class Real>
  Real error_bound(Real x) {
    const std::uint64_t kind = bits() % 4;
    return kind == 0 ? 0 : std::ldexp(std::fabs(x), kind == 1 ? -1 : -std::numeric_limits<Real>::digits + 3);
  }

 private:
  /// In [-1, 1), every bit random; exact in both formats.
  template <class Real>
  Real uniform() {
    constexpr int digits = std::numeric_limits<Real>::digits;
    return std::ldexp(static_cast<Real>(bits() >> (64 - digits)), 1 - digits) - 1;
  }
  int between(int least, int most) {
    return least + static_cast<int>(bits() % static_cast<std::uint64_t>(most - least + 1));
  }

  std::uint64_t state_ = 0xcbf29ce484222325;
};

}  // namespace tightrope_test
