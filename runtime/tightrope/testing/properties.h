#pragma once
/// Declared properties (antisymmetric, cyclic, translation_invariant, ...): they must hold exactly, and no two definite
/// signs of generated code may contradict them.

#include <tightrope/testing/checks.h>

namespace tightrope::testing {

namespace detail {

/// The exact outputs' factor from the inputs to the transformed inputs: f(x') = factor f(x).
template <class Real>
struct Transformed {
  Case<Real> inputs;
  DyadicRatio factor;
};

inline DyadicRatio power(const DyadicRatio& base, int exponent) {
  DyadicRatio result(1);
  for (int i = 0; i < std::abs(exponent); ++i) result = result * base;
  return exponent < 0 ? DyadicRatio(1) / result : result;
}

template <class Real>
Transformed<Real> permuted(const Property& property, const Case<Real>& c) {
  Transformed<Real> result{c, DyadicRatio(property.factor)};
  for (std::size_t i = 0; i < property.permutation.size(); ++i) {
    const auto from = static_cast<std::size_t>(property.permutation[i]);
    result.inputs.x[i] = c.x[from];
    result.inputs.exact[i] = c.exact[from];
  }
  return result;
}

/// Moves all points by whole numbers: exact for inputs on the lattice.
template <class Real>
Transformed<Real> translated(const Reference& reference, const Case<Real>& c, Random& random) {
  Transformed<Real> result{c, DyadicRatio(1)};
  const int offset[3] = {random.between(-100, 100), random.between(-100, 100), random.between(-100, 100)};
  std::size_t slot = 0;
  for (const Parameter& p : reference.parameters) {
    for (int k = 0; k < p.slots(); ++k, ++slot) {
      if (!p.point) continue;
      const int d = offset[k % p.dimension];
      result.inputs.x[slot].value += static_cast<Real>(d);
      Enclosure& x = result.inputs.exact[slot].value;
      x = x + Enclosure(DyadicRatio(d));
    }
  }
  return result;
}

/// Scales all inputs by a power of two (exact in floating point) or by three times that (exact for small numbers).
template <class Real>
Transformed<Real> scaled(const Property& property, const Case<Real>& c, Random& random) {
  const Real s = std::ldexp(static_cast<Real>(random.one_in(2) ? 1 : 3), random.between(-8, 8));
  const DyadicRatio exact_s(static_cast<double>(s));
  Transformed<Real> result{c, power(exact_s, property.exponent)};
  for (std::size_t i = 0; i < c.x.size(); ++i) {
    result.inputs.x[i] = {c.x[i].value * s, c.x[i].bound * s};
    result.inputs.exact[i].value = result.inputs.exact[i].value * exact_s;
  }
  return result;
}

/// Inputs that every transformation keeps exact: whole numbers, bounded inputs without error.
template <class Real>
Case<Real> exact_case(Inputs<Real>& inputs) {
  Case<Real> c = inputs.make(Family::lattice);
  for (std::size_t i = 0; i < c.x.size(); ++i) {
    c.x[i].bound = 0;
    c.exact[i] = Exact::of(static_cast<double>(c.x[i].value));
  }
  return c;
}

}  // namespace detail

template <class Real>
std::string check_property(const Reference& reference, std::span<const Code<Real>> codes, std::size_t index) {
  const Property& property = reference.properties[index];
  Random random(detail::seed(reference, property.text));
  Inputs<Real> inputs(reference, random);
  for (int n = 0; n < reference.cases; ++n) {
    const bool permutation = property.kind == Property::Kind::permutation;
    const Case<Real> c = permutation && random.one_in(2) ? inputs.make(Family::uniform) : detail::exact_case(inputs);
    const detail::Transformed<Real> t = permutation ? detail::permuted(property, c)
                                        : property.kind == Property::Kind::translation
                                            ? detail::translated(reference, c, random)
                                            : detail::scaled(property, c, random);
    const std::vector<Exact> before = evaluate_exact(reference, c.exact);
    const std::vector<Exact> after = evaluate_exact(reference, t.inputs.exact);
    for (const int element : property.outputs) {
      const auto i = static_cast<std::size_t>(element);
      if (!before[i].finite() || !after[i].finite()) continue;
      const Enclosure difference = after[i].value - before[i].value * t.factor;
      if (difference.sign() != 0) {
        return std::string(reference.name) + ": property " + property.text + " does not hold for " +
               detail::output_name(reference, element) + "\n" + detail::describe_inputs(reference, c) + "becomes\n" +
               detail::describe_inputs(reference, t.inputs);
      }
    }
    for (const Code<Real>& code : codes) {
      if (!code.has_bounds) continue;
      const std::vector<Bounded<Real>> y = detail::evaluate(reference, code, c);
      const std::vector<Bounded<Real>> z = detail::evaluate(reference, code, t.inputs);
      for (const int element : property.outputs) {
        const auto i = static_cast<std::size_t>(element);
        const int signs = static_cast<int>(sign(y[i])) * static_cast<int>(sign(z[i]));
        if (signs == -t.factor.sign() && signs != 0) {
          return detail::failure(reference, code.name, t.inputs, element, z[i],
                                 std::string("contradicts property ") + property.text);
        }
      }
    }
  }
  return "";
}

/// The alternatives of every `either` are equal: outputs are exactly the same whichever are taken.
template <class Real>
std::string check_alternatives(const Reference& reference, std::span<const Code<Real>> /*codes*/) {
  Random random(detail::seed(reference, "alternatives"));
  Inputs<Real> inputs(reference, random);
  for (int n = 0; n < reference.cases; ++n) {
    const Case<Real> c = inputs.make(n % 2 == 0 ? Family::uniform : Family::lattice);
    const std::uint64_t seed = n == 0 ? 0 : static_cast<std::uint64_t>(random.between(1, 1 << 30));
    const auto takes_first = [&](int line) {
      return seed != 0 && ((static_cast<std::uint64_t>(line) + seed) * 0x9E3779B97F4A7C15U) >> 63 != 0;
    };
    const std::vector<Exact> first = evaluate_exact(reference, c.exact, [](int) { return true; });
    const std::vector<Exact> other = evaluate_exact(reference, c.exact, takes_first);
    for (std::size_t i = 0; i < first.size(); ++i) {
      if (!first[i].finite() || !other[i].finite()) continue;
      const Enclosure difference = first[i].value - other[i].value;
      const bool differ = difference.lower().sign() > 0 || difference.upper().sign() < 0;
      if (!differ) continue;
      return std::string(reference.name) + ", " + detail::output_name(reference, static_cast<int>(i)) +
             ": the alternatives of an `either` are not equal: " + detail::hex(first[i].value.to_double()) + " and " +
             detail::hex(other[i].value.to_double()) + "\n" + detail::describe_inputs(reference, c);
    }
  }
  return "";
}

}  // namespace tightrope::testing
