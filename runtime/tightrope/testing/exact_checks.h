#pragma once
/// What generated tests check of modes `exact` and `staged`. Every check returns "" or a text that says what failed, on
/// which inputs.

#include <tightrope/exact_sign.h>
#include <tightrope/testing/checks.h>

#include <optional>

namespace tightrope::testing {

/// One output element: its sign, or for a `value` output the exact value (`exact`) or a bounded one (`staged`).
template <class Real>
struct ExactOutcome {
  std::optional<ExactSign> sign;
  std::optional<DyadicRatio> value;
  std::optional<Bounded<Real>> bounded;
};

/// One generated header's functions for one predicate: a case in, output elements out.
template <class Real>
struct ExactCode {
  const char* name;  ///< "staged double"
  void (*evaluate)(const Case<Real>& c, ExactOutcome<Real>* y);
};

/// Copies a result's members, array by array, to `to`; returns the place behind the last.
template <class Real>
ExactOutcome<Real>* collect_exact(ExactSign from, ExactOutcome<Real>* to) {
  to->sign = from;
  return to + 1;
}
template <class Number, class Real>
ExactOutcome<Real>* collect_exact(const std::optional<Number>& from, ExactOutcome<Real>* to) {
  if (from) to->value = DyadicRatio(*from);
  return to + 1;
}
template <class Real>
ExactOutcome<Real>* collect_exact(const Bounded<Real>& from, ExactOutcome<Real>* to) {
  to->bounded = from;
  return to + 1;
}
template <class Element, std::size_t N, class Real>
ExactOutcome<Real>* collect_exact(const Element (&from)[N], ExactOutcome<Real>* to) {
  for (const Element& element : from) to = collect_exact(element, to);
  return to;
}

namespace detail {

/// "" or what is wrong. Where an input is not finite a sign may be invalid although the reference has one: min(x, inf).
template <class Real>
std::string judge_exact(const ExactOutcome<Real>& y, const Exact& exact, bool finite_inputs) {
  if (y.bounded) return judge(*y.bounded, exact);
  if (exact.kind == Exact::Kind::unknown) return "";
  if (exact.kind == Exact::Kind::unknown) return "";
  if (!y.sign) {
    if (!exact.finite()) return y.value ? "a value where there is none" : "";
    if (!y.value) return finite_inputs ? "no value" : "";
    return *y.value == exact.value.lower()
               ? ""
               : "the value " + y.value->to_string() + " is not " + exact.value.lower().to_string();
  }
  const auto sign = static_cast<int>(*y.sign);
  if (!exact.finite()) return *y.sign == ExactSign::invalid ? "" : "a sign where there is none";
  if (*y.sign == ExactSign::invalid) return finite_inputs ? "no sign" : "";
  const bool right = exact.value.lower().sign() <= sign && sign <= exact.value.upper().sign();
  return right ? "" : "the sign " + std::to_string(sign) + " is wrong";
}

/// Whether exact code takes the case: the exact values of bounded inputs must be finite dyadic numbers.
template <class Real>
bool takes(const Reference& reference, const Case<Real>& c) {
  std::size_t slot = 0;
  for (const Parameter& p : reference.parameters) {
    for (int k = 0; k < p.slots(); ++k, ++slot) {
      if (!p.bounded) continue;
      if (!c.exact[slot].finite() || !(c.exact[slot].value.lower().denominator() == Dyadic(1))) return false;
    }
  }
  return true;
}

}  // namespace detail

/// The signs are the exact ones, on inputs of one family; all codes agree.
template <class Real>
std::string check_exact_family(const Reference& reference, std::span<const ExactCode<Real>> codes, Family family) {
  Random random(detail::seed(reference, "exact") + static_cast<std::uint64_t>(family));
  Inputs<Real> inputs(reference, random);
  for (int n = 0; n < reference.cases; ++n) {
    const Case<Real> c = inputs.make(family);
    if (!detail::takes(reference, c)) continue;
    const std::vector<Exact> exact = evaluate_exact(reference, c.exact);
    const bool finite = std::all_of(c.exact.begin(), c.exact.end(), [](const Exact& x) { return x.finite(); });
    std::vector<ExactOutcome<Real>> first;
    for (const ExactCode<Real>& code : codes) {
      std::vector<ExactOutcome<Real>> y(reference.results.size());
      code.evaluate(c, y.data());
      if (first.empty()) first = y;
      for (std::size_t i = 0; i < y.size(); ++i) {
        std::string what = detail::judge_exact(y[i], exact[i], finite);
        if (what.empty() && y[i].sign != first[i].sign) what = std::string("not the sign of ") + codes.front().name;
        if (what.empty()) continue;
        return std::string(reference.name) + ", " + code.name + ", " +
               detail::output_name(reference, static_cast<int>(i)) + ": " + what + "\n" +
               detail::describe_inputs(reference, c);
      }
    }
  }
  return "";
}

}  // namespace tightrope::testing
