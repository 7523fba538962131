#pragma once
/// What generated tests check. Every check returns "" or a text that says what failed, on which inputs (in hexadecimal
/// floating point, to be copied into a program).

#include <tightrope/testing/inputs.h>

#include <cstdio>
#include <optional>
#include <string>

namespace tightrope::testing {

/// One generated header's functions for one predicate, on flat arrays: slots in, output elements out.
template <class Real>
struct Code {
  using Evaluate = void (*)(const Bounded<Real>* x, Bounded<Real>* y);
  const char* name;  ///< "tight double"
  bool has_bounds;   ///< false: mode `float`
  double definite;   ///< the least fraction of signs on generic inputs that must be definite
  Evaluate evaluate;
  Evaluate evaluate_in_range;                ///< null without declared ranges
  bool (*in_range)(const Bounded<Real>* x);  ///< null without declared ranges
  bool own_values = false;  ///< mode `interval`: values are middles of intervals, not those of plain evaluation
};

/// Copies a result's numbers, array by array, to `to`; returns the place behind the last.
template <class Real>
Bounded<Real>* collect(const Bounded<Real>& from, Bounded<Real>* to) {
  *to = from;
  return to + 1;
}
template <class Element, std::size_t N, class Real>
Bounded<Real>* collect(const Element (&from)[N], Bounded<Real>* to) {
  for (const Element& element : from) to = collect(element, to);
  return to;
}

namespace detail {

inline std::string hex(double x) {
  char text[64];
  std::snprintf(text, sizeof text, "%a", x);
  return text;
}

template <class Real>
std::string describe_inputs(const Reference& reference, const Case<Real>& c) {
  std::string text;
  std::size_t slot = 0;
  for (const Parameter& p : reference.parameters) {
    text += std::string("  ") + p.name + " =";
    for (int k = 0; k < p.slots(); ++k, ++slot) {
      text += ' ' + hex(static_cast<double>(c.x[slot].value));
      if (!p.bounded) continue;
      text += "+-" + hex(static_cast<double>(c.x[slot].bound));
      if (c.exact[slot].finite()) text += " (exactly " + c.exact[slot].value.lower().to_string() + ")";
    }
    text += '\n';
  }
  return text;
}

/// "Y[2]" for element 2, counted over all outputs.
inline std::string output_name(const Reference& reference, int element) {
  for (const Output& output : reference.outputs) {
    if (element >= output.elements()) {
      element -= output.elements();
      continue;
    }
    std::string text = output.name;
    int rest = output.elements();
    for (const int extent : output.extents) {
      rest /= extent;
      text += '[' + std::to_string(element / rest % extent) + ']';
    }
    return text;
  }
  return "?";
}

template <class Real>
std::string failure(const Reference& reference, const char* code, const Case<Real>& c, int element,
                    const Bounded<Real>& y, const std::string& what) {
  return std::string(reference.name) + ", " + code + ", " + output_name(reference, element) + ": " + what +
         "\n  value " + hex(static_cast<double>(y.value)) + ", bound " + hex(static_cast<double>(y.bound)) + "\n" +
         describe_inputs(reference, c);
}

/// Whether |value - exact| <= bound and the sign is right; "" or what is wrong.
template <class Real>
std::string judge(const Bounded<Real>& y, const Exact& exact) {
  const Sign s = sign(y);
  if (exact.kind == Exact::Kind::unknown) return "";
  if (!exact.finite()) return s == Sign::uncertain ? "" : "a definite sign of an exact value that is not finite";
  if (y.bound < 0) return "a negative bound";
  if (!std::isfinite(y.value) && s != Sign::uncertain) return "a definite sign of a value that is not finite";
  if (!std::isfinite(y.value) || !std::isfinite(y.bound)) return "";
  const Enclosure error = abs(Enclosure(static_cast<double>(y.value)) - exact.value);
  if (error.lower() > DyadicRatio(static_cast<double>(y.bound))) {
    return "the bound does not cover the error " + hex(error.to_double()) + " (exact value " +
           hex(exact.value.to_double()) + ")";
  }
  const bool decided = exact.value.is_exact() || exact.value.sign() != 0;
  if (s != Sign::uncertain && decided && static_cast<int>(s) != exact.value.sign()) return "a wrong definite sign";
  return "";
}

/// By slot the power of two that generated code multiplies the input with.
template <class Real>
std::vector<Real> scales(const Reference& reference, const Case<Real>& c) {
  std::vector<int> groups;
  for (const Parameter& p : reference.parameters)
    groups.insert(groups.end(), static_cast<std::size_t>(p.slots()), p.normalized);
  std::vector<Real> result(groups.size(), Real(1));
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (groups[i] < 0) continue;
    Real largest = 0;
    bool first = true;
    for (std::size_t k = 0; k < groups.size(); ++k) {
      if (groups[k] != groups[i]) continue;
      largest = first ? magnitude(c.x[k].value) : max_magnitude(largest, magnitude(c.x[k].value));
      first = false;
    }
    result[i] = normalizer(largest);
  }
  return result;
}

/// The exact inputs behind the values and bounds that generated code gives: those of normalized groups are scaled.
template <class Real>
std::vector<Exact> normalized_exact(const Reference& reference, const Case<Real>& c) {
  std::vector<Exact> result(c.exact.begin(), c.exact.end());
  const std::vector<Real> scale = scales(reference, c);
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (result[i].finite() && std::isfinite(scale[i])) {
      result[i] = Exact::of(result[i].value * Enclosure(static_cast<double>(scale[i])));
    }
  }
  return result;
}

template <class Real>
std::vector<Real> normalized_values(const Reference& reference, const Case<Real>& c) {
  std::vector<Real> result;
  const std::vector<Real> scale = scales(reference, c);
  for (std::size_t i = 0; i < scale.size(); ++i) result.push_back(product(c.x[i].value, scale[i]));
  return result;
}

/// Whether both are the same floating-point number, zeros of both signs being one, NaNs too.
template <class Real>
bool same(Real a, Real b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

template <class Real>
std::vector<Bounded<Real>> evaluate(const Reference& reference, const Code<Real>& code, const Case<Real>& c) {
  std::vector<Bounded<Real>> y(reference.results.size());
  code.evaluate(c.x.data(), y.data());
  return y;
}

/// The seed of a check: the same in every run, another for every predicate and check.
inline std::uint64_t seed(const Reference& reference, std::string_view check) {
  std::uint64_t state = 0xcbf29ce484222325U;  // FNV-1a
  for (const std::string_view text : {std::string_view(reference.name), check}) {
    for (const char c : text) state = (state ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  }
  return state;
}

/// One code's outputs against the exact ones and, if it is to compute the same values, the plain ones.
template <class Real>
std::string check_case(const Reference& reference, const Code<Real>& code, const Case<Real>& c,
                       const std::vector<Exact>& exact, const std::vector<Real>& plain) {
  const std::vector<Bounded<Real>> y = evaluate(reference, code, c);
  const bool inside = code.in_range == nullptr || code.in_range(c.x.data());
  const bool guarded = has_preconditions(reference);
  for (std::size_t i = 0; i < y.size(); ++i) {
    std::string what;
    if (code.has_bounds) what = judge(y[i], exact[i]);
    // Simplification may only remove an overflow (or the NaN that follows it).
    const bool same_values = reference.same_values && !code.own_values;
    // Where a precondition is in doubt, the code with bounds has NaN.
    const bool refused = guarded && code.has_bounds && std::isnan(y[i].value);
    if (what.empty() && same_values && inside && !refused && std::isfinite(plain[i]) && !same(plain[i], y[i].value)) {
      what = "the value is not that of plain evaluation, " + hex(static_cast<double>(plain[i]));
    }
    if (!what.empty()) return failure(reference, code.name, c, static_cast<int>(i), y[i], what);
  }
  return "";
}

}  // namespace detail

/// Error bounds cover errors, definite signs are right, values are those of plain evaluation, on inputs of one family.
template <class Real>
std::string check_family(const Reference& reference, std::span<const Code<Real>> codes, Family family) {
  Random random(detail::seed(reference, "family") + static_cast<std::uint64_t>(family));
  Inputs<Real> inputs(reference, random);
  for (int n = 0; n < reference.cases; ++n) {
    const Case<Real> c = inputs.make(family);
    const std::vector<Exact> exact = evaluate_exact(reference, detail::normalized_exact(reference, c));
    const std::vector<Real> plain = evaluate_plain<Real>(reference, detail::normalized_values(reference, c));
    for (const Code<Real>& code : codes) {
      if (std::string text = detail::check_case(reference, code, c, exact, plain); !text.empty()) return text;
    }
  }
  return "";
}

/// The same on inputs that a random search has driven towards the largest ratio of error to bound.
template <class Real>
std::string check_worst_errors(const Reference& reference, std::span<const Code<Real>> codes) {
  constexpr int steps = 200;
  Random random(detail::seed(reference, "worst"));
  Inputs<Real> inputs(reference, random);
  const Family starts[] = {Family::uniform, Family::lattice, Family::dependent, Family::far_away, Family::zero_set};
  const int climbs = std::max(1, 4 * reference.cases / steps);
  for (int climb = 0; climb < climbs; ++climb) {
    const Code<Real>& code = codes[static_cast<std::size_t>(climb) % codes.size()];
    if (!code.has_bounds || reference.results.empty()) continue;
    const auto target = static_cast<std::size_t>(random.below(static_cast<int>(reference.results.size())));
    Case<Real> best = inputs.make(starts[random.below(5)]);
    double best_ratio = -1;
    for (int n = 0; n < steps; ++n) {
      const Case<Real> c = n == 0 ? best : inputs.mutate(best);
      const std::vector<Exact> exact = evaluate_exact(reference, detail::normalized_exact(reference, c));
      const std::vector<Bounded<Real>> y = detail::evaluate(reference, code, c);
      for (std::size_t i = 0; i < y.size(); ++i) {
        const std::string what = detail::judge(y[i], exact[i]);
        if (!what.empty()) return detail::failure(reference, code.name, c, static_cast<int>(i), y[i], what);
      }
      if (!exact[target].finite() || !std::isfinite(y[target].value) || !(y[target].bound > 0)) continue;
      const Enclosure error = Enclosure(static_cast<double>(y[target].value)) - exact[target].value;
      const double ratio = std::abs(error.to_double()) / static_cast<double>(y[target].bound);
      if (ratio >= best_ratio) best = c, best_ratio = ratio;
    }
  }
  return "";
}

/// Bounds are of use: on generic inputs at least the stated fraction of the signs that exist are definite.
template <class Real>
std::string check_usefulness(const Reference& reference, std::span<const Code<Real>> codes) {
  for (const Code<Real>& code : codes) {
    if (!code.has_bounds) continue;
    Random random(detail::seed(reference, "usefulness"));
    Inputs<Real> inputs(reference, random);
    int exist = 0;
    int definite = 0;
    for (int n = 0; n < reference.cases; ++n) {
      const Case<Real> c = inputs.make_generic();
      const std::vector<Exact> exact = evaluate_exact(reference, c.exact);
      const std::vector<Bounded<Real>> y = detail::evaluate(reference, code, c);
      for (std::size_t i = 0; i < y.size(); ++i) {
        if (!exact[i].finite() || exact[i].value.sign() == 0) continue;
        ++exist;
        if (sign(y[i]) != Sign::uncertain) ++definite;
      }
    }
    if (definite < code.definite * exist) {
      return std::string(reference.name) + ", " + code.name + ": only " + std::to_string(definite) + " of " +
             std::to_string(exist) + " signs are definite on generic inputs\n";
    }
  }
  return "";
}

/// Declared ranges: the functions without the check agree with the checked ones inside, and outside every sign is
/// uncertain.
template <class Real>
std::string check_ranges(const Reference& reference, std::span<const Code<Real>> codes) {
  using limits = std::numeric_limits<Real>;
  Random random(detail::seed(reference, "ranges"));
  Inputs<Real> inputs(reference, random);
  std::vector<std::size_t> limited;
  for (std::size_t i = 0; i < inputs.parameter_of().size(); ++i) {
    const auto p = static_cast<std::size_t>(inputs.parameter_of()[i]);
    if (std::isfinite(reference.parameters[p].range)) limited.push_back(i);
  }
  for (int n = 0; n < reference.cases && !limited.empty(); ++n) {
    const Case<Real> inside = inputs.make(n % 2 == 0 ? Family::uniform : Family::extreme);
    Case<Real> outside = inside;
    const std::size_t slot = limited[static_cast<std::size_t>(random.below(static_cast<int>(limited.size())))];
    const Parameter& p = reference.parameters[static_cast<std::size_t>(inputs.parameter_of()[slot])];
    Real limit = static_cast<Real>(std::min(p.range, static_cast<double>(limits::max())));
    if (static_cast<double>(limit) > p.range) limit = std::nextafter(limit, Real(0));
    const Real beyond[] = {std::nextafter(limit, limits::infinity()), 2 * limit, limits::infinity(),
                           limits::quiet_NaN()};
    const bool negative = random.one_in(2);
    const Real bad = beyond[random.below(4)];
    if (p.bounded && random.one_in(2)) {
      outside.x[slot].bound = bad;
    } else {
      outside.x[slot].value = negative ? -bad : bad;
    }
    for (const Code<Real>& code : codes) {
      if (!code.in_range(inside.x.data())) {
        return std::string(reference.name) + ", " + code.name + ": refused although in range\n" +
               detail::describe_inputs(reference, inside);
      }
      const std::vector<Bounded<Real>> checked = detail::evaluate(reference, code, inside);
      std::vector<Bounded<Real>> unchecked(checked.size());
      code.evaluate_in_range(inside.x.data(), unchecked.data());
      const std::vector<Bounded<Real>> refused = detail::evaluate(reference, code, outside);
      for (std::size_t i = 0; i < checked.size(); ++i) {
        const int element = static_cast<int>(i);
        if (!detail::same(checked[i].value, unchecked[i].value) ||
            !detail::same(checked[i].bound, unchecked[i].bound)) {
          return detail::failure(reference, code.name, inside, element, checked[i],
                                 "the function without check differs");
        }
        if (code.in_range(outside.x.data()) || sign(refused[i]) != Sign::uncertain) {
          return detail::failure(reference, code.name, outside, element, refused[i],
                                 "a sign beyond the declared range");
        }
      }
    }
  }
  return "";
}

}  // namespace tightrope::testing
