#pragma once
/// Inputs that make predicates err: where the exact value is zero or nearly so, at all scales, and beyond them.

#include <tightrope/testing/reference.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <random>

namespace tightrope::testing {

/// A seeded source of numbers, the same on every machine (the standard's distributions are not).
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  std::uint64_t bits() { return engine_(); }
  /// 0 .. n - 1
  int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
  int between(int low, int high) { return low + below(high - low + 1); }
  bool one_in(int n) { return below(n) == 0; }
  /// Uniform on [-1, 1], rounded: every bit of the mantissa is random, however small the number. (Multiples of 2^-53
  /// would not do: their differences are exact.)
  template <class Real>
  Real uniform() {
    const int exponent = std::countl_zero(engine_() | 1);
    constexpr int digits = std::numeric_limits<Real>::digits;
    const std::uint64_t mantissa = (engine_() >> (65 - digits)) | (std::uint64_t{1} << (digits - 1));
    const Real x = std::ldexp(static_cast<Real>(mantissa), -digits - exponent);
    return one_in(2) ? x : -x;
  }

 private:
  std::mt19937_64 engine_;
};

/// Inputs of a predicate: as generated code takes them, and the exact numbers that they stand for (for bounded inputs
/// any within the bound; for others the same).
template <class Real>
struct Case {
  std::vector<Bounded<Real>> x;
  std::vector<Exact> exact;
};

enum class Family {
  uniform,     ///< [-1, 1]
  lattice,     ///< small whole numbers: exact zeros, exact operations
  zero_set,    ///< driven to a zero of one output by secant steps in one coordinate, then moved by a few ulps
  dependent,   ///< parameters that coincide or depend linearly, then moved by a few ulps
  scales,      ///< 2^-300 .. 2^300, for all together or for each parameter
  far_away,    ///< near a common point 1e2 .. 1e12 away
  mixed,       ///< every coordinate has a magnitude of its own; zeros among them
  underflow,   ///< towards and in the subnormal numbers
  extreme,     ///< the whole range of exponents
  not_finite,  ///< infinities, NaN and the largest number among ordinary ones
};

template <class Real>
class Inputs {
 public:
  Inputs(const Reference& reference, Random& random) : reference_(reference), random_(random) {
    for (const Parameter& p : reference.parameters) {
      first_slot_.push_back(static_cast<int>(parameter_of_.size()));
      parameter_of_.insert(parameter_of_.end(), static_cast<std::size_t>(p.slots()),
                           static_cast<int>(first_slot_.size()) - 1);
    }
  }

  Case<Real> make(Family family) {
    x_.assign(parameter_of_.size(), Bounded<Real>{0, 0});
    if (x_.empty()) return finish();
    fill_values(family);
    fit_ranges();
    fill_bounds(family);
    if (family == Family::not_finite) spoil();
    return finish();
  }

  /// Inputs as `make(uniform)`, without errors of bounded inputs.
  Case<Real> make_generic() {
    x_.assign(parameter_of_.size(), Bounded<Real>{0, 0});
    for (auto& x : x_) x.value = random_.template uniform<Real>();
    fit_ranges();
    return finish();
  }

  /// A neighbour of `origin`: one number is changed, a little or much.
  Case<Real> mutate(const Case<Real>& origin) {
    Case<Real> result = origin;
    x_ = origin.x;
    if (x_.empty()) return result;
    const auto i = static_cast<std::size_t>(random_.below(static_cast<int>(x_.size())));
    Real& value = x_[i].value;
    switch (random_.below(6)) {
      case 0:
        value = step(value, random_.between(-4, 4));
        break;
      case 1:
        value += product(value, std::ldexp(random_.template uniform<Real>(), -random_.between(1, digits)));
        break;
      case 2:
        value = random_.template uniform<Real>();
        break;
      case 3:
        value = std::ldexp(std::round(std::ldexp(value, 8)), -8);
        break;  // few bits: exact operations
      case 4:
        value *= 1 + std::ldexp(static_cast<Real>(random_.between(-8, 8)), 1 - digits);
        break;
      default:
        value = std::ldexp(value, random_.between(-3, 3));
        break;
    }
    if (bounded(i) && random_.one_in(2)) x_[i].bound = random_bound(x_[i].value);
    fit_ranges();
    result.x = x_;
    if (!bounded(i) || random_.one_in(2)) {
      result.exact[i] = exact_input(i);
    } else {  // the same relative error, or the other end of it
      result.exact[i] = offset_input(i, random_.one_in(4) ? 1 : -1);
    }
    return result;
  }

  const std::vector<int>& parameter_of() const { return parameter_of_; }

 private:
  static constexpr int digits = std::numeric_limits<Real>::digits;
  static constexpr int max_exponent = std::numeric_limits<Real>::max_exponent - 1;       // 1023, 127
  static constexpr int min_exponent = std::numeric_limits<Real>::min_exponent - digits;  // -1074, -149
  static constexpr int scale_exponent = std::is_same_v<Real, float> ? 36 : 300;

  const Parameter& parameter(std::size_t slot) const {
    return reference_.parameters[static_cast<std::size_t>(parameter_of_[slot])];
  }
  bool bounded(std::size_t slot) const { return parameter(slot).bounded; }

  static Real step(Real x, int ulps) {
    for (; ulps > 0; --ulps) x = std::nextafter(x, std::numeric_limits<Real>::infinity());
    for (; ulps < 0; ++ulps) x = std::nextafter(x, -std::numeric_limits<Real>::infinity());
    return x;
  }

  void fill_values(Family family) {
    switch (family) {
      case Family::uniform:
        fill_uniform();
        break;
      case Family::lattice:
        fill_lattice();
        break;
      case Family::zero_set:
        fill_start();
        drive_to_zero();
        break;
      case Family::dependent:
        fill_start();
        make_dependent();
        break;
      case Family::scales:
        fill_uniform();
        scale_parameters(-scale_exponent, scale_exponent);
        break;
      case Family::far_away:
        fill_uniform();
        move_away();
        break;
      case Family::mixed:
        fill_mixed(-60, 60);
        break;
      case Family::underflow:
        fill_start();
        scale_parameters(min_exponent, 0);
        break;
      case Family::extreme:
        fill_mixed(min_exponent, max_exponent);
        break;
      case Family::not_finite:
        fill_start();
        break;
    }
  }

  void fill_uniform() {
    for (auto& x : x_) x.value = random_.template uniform<Real>();
  }

  void fill_lattice() {
    const int limit = random_.between(1, 4);
    for (auto& x : x_) x.value = static_cast<Real>(random_.between(-limit, limit));
  }

  /// Any of the plain fillings.
  void fill_start() {
    if (random_.one_in(3)) {
      fill_lattice();
    } else {
      fill_uniform();
      if (random_.one_in(3)) move_away();
    }
  }

  void fill_mixed(int low, int high) {
    for (auto& x : x_) {
      x.value = random_.one_in(8) ? 0 : std::ldexp(random_.template uniform<Real>(), random_.between(low, high));
    }
  }

  /// One power of two for all, or one for each parameter.
  void scale_parameters(int low, int high) {
    const bool common = random_.one_in(2);
    int exponent = random_.between(low, high);
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (!common && i > 0 && parameter_of_[i] != parameter_of_[i - 1]) exponent = random_.between(low, high);
      x_[i].value = std::ldexp(x_[i].value, exponent);
    }
  }

  void move_away() {
    const Real distance = static_cast<Real>(std::pow(10.0, random_.between(2, 12)));
    Real offset[3];
    for (Real& o : offset) o = distance * random_.template uniform<Real>();
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const auto first = static_cast<std::size_t>(first_slot_[static_cast<std::size_t>(parameter_of_[i])]);
      const auto component = (i - first) % static_cast<std::size_t>(parameter(i).dimension);
      x_[i].value += offset[component];
    }
  }

  /// Secant steps on one coordinate towards a zero of one output, in floating point; then a few ulps aside.
  TIGHTROPE_MAY_DIVIDE_BY_ZERO void drive_to_zero() {
    if (reference_.results.empty()) return;
    const auto output = static_cast<std::size_t>(random_.below(static_cast<int>(reference_.results.size())));
    const auto slot = static_cast<std::size_t>(random_.below(static_cast<int>(x_.size())));
    std::vector<Real> slots;
    for (const auto& x : x_) slots.push_back(x.value);
    Real t0 = slots[slot];
    Real f0 = evaluate_plain<Real>(reference_, slots)[output];
    Real t1 = t0 + random_.template uniform<Real>();
    for (int iteration = 0; iteration < 8; ++iteration) {
      slots[slot] = t1;
      const Real f1 = evaluate_plain<Real>(reference_, slots)[output];
      const Real t2 = t1 - product(f1, (t1 - t0) / (f1 - f0));
      if (f1 == 0 || !std::isfinite(t2) || t2 == t1) break;
      t0 = t1, f0 = f1, t1 = t2;
    }
    x_[slot].value = step(t1, random_.between(-3, 3));
  }

  /// Makes a parameter equal to another, or puts it on a line through two others.
  void make_dependent() {
    const int n = static_cast<int>(reference_.parameters.size());
    for (int repeat = random_.between(1, 2); repeat > 0; --repeat) {
      const int to = random_.below(n);
      const int from = random_.below(n);
      const int other = random_.below(n);
      const Real s =
          random_.one_in(2) ? static_cast<Real>(random_.between(-4, 8)) / 4 : random_.template uniform<Real>();
      const bool on_line = random_.one_in(2);
      const auto slots = [&](int p) { return reference_.parameters[static_cast<std::size_t>(p)].slots(); };
      for (int k = 0; k < slots(to); ++k) {
        const auto at = [&](int p) -> Real& {
          const int slot = first_slot_[static_cast<std::size_t>(p)] + k % slots(p);
          return x_[static_cast<std::size_t>(slot)].value;
        };
        at(to) = on_line ? at(from) + product(s, at(other) - at(from)) : at(from);
      }
    }
    if (random_.one_in(2)) {
      Real& value = x_[static_cast<std::size_t>(random_.below(static_cast<int>(x_.size())))].value;
      value = step(value, random_.between(-3, 3));
    }
  }

  /// Values beyond a declared range come back into it by a power of two.
  void fit_ranges() {
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const double range = parameter(i).range;
      for (Real* number : {&x_[i].value, &x_[i].bound}) {
        const double size = std::abs(static_cast<double>(*number));
        if (!(size > range)) continue;
        *number = std::ldexp(*number, static_cast<int>(std::floor(std::log2(range) - std::log2(size))));
        if (std::abs(static_cast<double>(*number)) > range) *number /= 2;
      }
    }
  }

  /// 0, tiny, or comparable to the value.
  Real random_bound(Real value) {
    const Real size = std::abs(value);
    switch (random_.below(6)) {
      case 0:
        return 0;
      case 1:
        return std::ldexp(size, -digits - 1);
      case 2:
        return std::ldexp(size, -random_.between(1, 2 * digits));
      case 3:
        return size * std::abs(random_.template uniform<Real>());
      case 4:
        return std::ldexp(size, random_.between(0, 3));
      default:
        return std::numeric_limits<Real>::denorm_min() * static_cast<Real>(random_.below(4));
    }
  }

  void fill_bounds(Family family) {
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (bounded(i)) x_[i].bound = family == Family::lattice && random_.one_in(2) ? 0 : random_bound(x_[i].value);
      if (bounded(i) && !std::isfinite(x_[i].bound)) x_[i].bound = 0;
    }
    fit_ranges();
  }

  /// Replaces some numbers by infinities, NaN, or the largest number.
  void spoil() {
    using limits = std::numeric_limits<Real>;
    const Real bad[] = {limits::infinity(), -limits::infinity(), limits::quiet_NaN(), limits::max(), -limits::max()};
    for (int repeat = random_.between(1, 3); repeat > 0; --repeat) {
      const auto i = static_cast<std::size_t>(random_.below(static_cast<int>(x_.size())));
      const Real number = bad[random_.below(5)];
      if (bounded(i) && random_.one_in(2)) {
        x_[i].bound = std::abs(number);
      } else {
        x_[i].value = number;
      }
    }
  }

  /// The exact number for slot i that lies s bounds away from its value, s in [-1, 1].
  Exact offset_input(std::size_t i, double s) const {
    const Bounded<Real>& x = x_[i];
    if (!std::isfinite(x.bound)) return Exact::undefined();
    if (!std::isfinite(x.value)) return Exact::of(static_cast<double>(x.value));
    const auto value = static_cast<double>(x.value);
    const auto bound = static_cast<double>(x.bound);
    return {Exact::Kind::finite, DyadicRatio(Dyadic(value) + Dyadic(bound) * Dyadic(s))};
  }

  Exact exact_input(std::size_t i) {
    if (!bounded(i)) return Exact::of(static_cast<double>(x_[i].value));
    const double end = random_.one_in(2) ? 1.0 : -1.0;
    return offset_input(i, random_.one_in(3) ? random_.template uniform<double>() : end);
  }

  Case<Real> finish() {
    Case<Real> result{x_, {}};
    for (std::size_t i = 0; i < x_.size(); ++i) result.exact.push_back(exact_input(i));
    return result;
  }

  const Reference& reference_;
  Random& random_;
  std::vector<int> first_slot_;    ///< by parameter
  std::vector<int> parameter_of_;  ///< by slot
  std::vector<Bounded<Real>> x_;
};

}  // namespace tightrope::testing
