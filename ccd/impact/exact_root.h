#pragma once
/// Times in [0, 1] that are roots of cubics, exactly (MATH 3.6): their order relative to other numbers, signs of
/// functions there, enclosure by doubles.

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "ccd/impact/exact_polynomials.h"
#include "ccd/methods/exact_tables.h"

namespace tightrope::ccd::exact {

/// The signs of a cubic's coefficients over [0, x], but the first; the last is that of its value at x.
using PartSigns = std::array<DefiniteSign, 3>;

/// The time t / (s + t), s, t >= 0, not both 0.
struct Ratio {
  Dyadic s, t;
};

/// An exact time in [0, 1]: a ratio, or a simple root of a cubic in (0, 1), which must outlive this object.
class Root {
 public:
  static Root at_0() { return Root(Ratio{Dyadic(1), Dyadic()}, 0, 0); }
  static Root at_1() { return Root(Ratio{Dyadic(), Dyadic(1)}, 1, 1); }
  /// The only time in [lower, upper] at which the cubic is zero, with opposite signs before and after it there.
  static Root crossing(const Cubic& cubic, double lower, double upper);

  /// lower <= this time <= upper; equal if it is this double, else strictly between. [0, 1] until it is narrowed.
  double lower() const { return lower_; }
  double upper() const { return upper_; }
  bool is_double() const { return lower_ == upper_; }

  /// Narrows the enclosure to about what floating point can see.
  void narrow();
  /// Narrows it to neighbouring doubles.
  void narrow_to_neighbours();
  /// Is this time later than x?
  bool after(double x);

  /// The sign of a function at this time.
  DefiniteSign sign(const Line& l) const;
  DefiniteSign sign(const Quadratic& j) const;

 private:
  friend std::vector<Root> inner_roots(const Cubic& k);
  Root(Ratio ratio, double lower, double upper) : ratio_(std::move(ratio)), lower_(lower), upper_(upper) {}
  /// Root number `index` of `count` in (0, 1), roots counted with multiplicity.
  Root(const Cubic& cubic, int index, int count, DefiniteSign before)
      : cubic_(&cubic), index_(index), count_(count), before_(before) {}
  int earlier_roots(const PartSigns& part) const;
  void isolate();
  double estimate() const;
  /// How many doubles away from the estimate floating point tells the sign of the cubic.
  std::uint64_t first_step(double estimate) const;

  DefiniteSign order(const PartSigns& part) const;
  DefiniteSign order(const Ratio& other) const;
  DefiniteSign order(double x);
  bool crosses(const Line& l) const;
  DefiniteSign sign_by_division(const Quadratic& j) const;

  bool is_ratio() const { return cubic_ == nullptr; }
  bool is_end() const { return upper_ == 0 || lower_ == 1; }

  Ratio ratio_;
  const Cubic* cubic_ = nullptr;  ///< none: this is the ratio
  // This is number index_ of count_ roots in (0, 1), with multiplicity; or the only root in (lower_, upper_), count_
  // = 1.
  int index_ = 0, count_ = 0;
  DefiniteSign before_ = DefiniteSign::zero;  ///< of the cubic before the first of these roots
  double lower_ = 0, upper_ = 1;
};

/// The different roots in the open (0, 1) of a cubic that is not zero, ascending.
std::vector<Root> inner_roots(const Cubic& k);

}  // namespace tightrope::ccd::exact
