#pragma once
/// The arithmetic of exact_search.h: doubles with TightBound that give up where a bound does not tell a sign.
///
/// Who includes this includes the generated headers first.

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "ccd/methods/exact_tables.h"
#include "ccd/rescale.h"
#include "tightrope/sign.h"

namespace tightrope::generated {
template <class Bound, class Real>
struct quadratic_at_roots;
}  // namespace tightrope::generated

namespace tightrope::ccd::exact {

// Outputs of generated predicates as arrays of numbers.
inline const Bounded<double>& value(const Bounded<double>& x) { return x; }
template <class Output, std::size_t N>
auto values(const Output (&x)[N]) {
  std::array<std::remove_cvref_t<decltype(value(x[0]))>, N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = value(x[i]);
  return result;
}

/// Quotient and remainder of a cubic by a quadratic: square * Y = j * m + n (MATH 2.5).
template <class Number>
struct Division {
  std::array<Number, 2> m, n;
};

/// `Signs` reads the signs (sign_reader.h).
template <class Signs>
class FilterArithmetic {
 public:
  using Number = Bounded<double>;
  explicit FilterArithmetic(Signs& signs) : signs_(signs) {}
  bool gave_up() const { return gave_up_; }

  DefiniteSign sign(const Bounded<double>& x) {
    const Sign known = signs_(x);
    gave_up_ = gave_up_ || known == Sign::uncertain;
    return static_cast<DefiniteSign>(known);
  }
  /// The sign that a quadratic has on all of [0, 1]; zero, without giving up, if its coefficients do not tell.
  DefiniteSign hull_sign(const std::array<Bounded<double>, 3>& j) {
    return static_cast<DefiniteSign>(common(common(signs_(j[0]), signs_(j[1])), signs_(j[2])));
  }
  static Bounded<double> negated(const Bounded<double>& x) { return {-x.value, x.bound}; }

  template <template <class, class> class Predicate, class... Arguments>
  static auto evaluate(const Arguments&... arguments) {
    return Predicate<bound::tight, double>::evaluate_in_range(arguments...);
  }
  static Division<Bounded<double>> division(const std::array<Bounded<double>, 4>& k,
                                            const std::array<Bounded<double>, 3>& j) {
    using predicate = generated::quadratic_at_roots<bound::tight, double>;
    typename predicate::State state;
    const auto cofactor = predicate::cofactor_in_range(k.data(), j.data(), state);
    return {values(cofactor.m), values(predicate::remainder_in_range(k.data(), j.data(), state).n)};
  }

  template <class Tuple>
  void rescale(Tuple& tuple) {
    gave_up_ = !ccd::rescale(tuple) || gave_up_;
  }
  /// The axis with the largest numbers first: its signs are the most certain.
  template <class Quadratics>
  static std::array<std::size_t, 3> axes(const Quadratics& z) {
    std::array<double, 3> sizes{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const auto& j : z[axis]) {
        for (const auto& x : j) sizes[axis] = std::max(sizes[axis], magnitude(x.value));
      }
    }
    std::array<std::size_t, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
    return order;
  }

 private:
  Signs& signs_;
  bool gave_up_ = false;
};

}  // namespace tightrope::ccd::exact
