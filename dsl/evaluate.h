#pragma once
/// Evaluates a graph on any number type: floating point (what generated code computes) or exact arithmetic.

#include <cmath>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "dsl/graph.h"

namespace tightrope::dsl {

/// As `normalizer` of the runtime (tightrope/arithmetic.h).
template <class Real>
Real normalizer_of(Real largest) {
  using limits = std::numeric_limits<Real>;
  if (!(largest <= limits::max())) return limits::quiet_NaN();
  int exponent = limits::min_exponent - 1;
  if (largest >= limits::min()) std::frexp(largest, &exponent);
  return std::ldexp(Real(1), -exponent);
}

/// The value of one node, given one value per input slot and, by `at(id)`, the values of its operands.
///
/// `Number` needs + - * / and unary minus, construction from double, and found by argument-dependent lookup (or built
/// in for floating point) abs(x), sqrt(x), mul_pow2(x, int), fma(x, y, z), and either < and == or min(x, y) and
/// max(x, y). On exact numbers, which have no NaN, the guards (Op::certain_nonzero ..) let everything pass. Op::select
/// takes x.sign(), or not_negative(x), or x >= 0.
template <class Number, class Operands>
Number evaluate_node(const Node& n, std::span<const Number> slots, const Operands& at) {
  using std::abs;
  using std::fma;
  using std::sqrt;
  const auto less_or = [](const Number& x, const Number& y, bool want_less) -> Number {  // NaN if either operand is NaN
    if constexpr (requires { x < y; }) {
      if (x < y) return want_less ? x : y;
      if (y < x || x == y) return want_less ? y : x;
      return x + y;
    } else {
      return want_less ? min(x, y) : max(x, y);
    }
  };
  const auto guarded = [](const Number& x, const Number& bound, bool strictly) -> Number {
    if constexpr (std::numeric_limits<Number>::has_quiet_NaN) {
      const bool holds = strictly ? abs(x) > bound : x >= bound;
      return holds ? x : std::numeric_limits<Number>::quiet_NaN();
    } else {
      return x;
    }
  };
  const auto takes_first = [](const Number& condition) -> bool {
    if constexpr (requires { condition.sign(); }) {
      return condition.sign() >= 0;
    } else if constexpr (requires { not_negative(condition); }) {
      return not_negative(condition);
    } else {
      return condition >= Number(0);
    }
  };
  switch (n.op) {
    case Op::input:
      return slots[static_cast<std::size_t>(n.index)];
    case Op::constant:
      return Number(n.value);
    case Op::add:
      return at(n.a) + at(n.b);
    case Op::sub:
      return at(n.a) - at(n.b);
    case Op::neg:
      return -at(n.a);
    case Op::mul:
      return at(n.a) * at(n.b);
    case Op::mul_pow2:
      if constexpr (std::is_floating_point_v<Number>) {
        return std::ldexp(at(n.a), n.index);
      } else {
        return mul_pow2(at(n.a), n.index);
      }
    case Op::div:
      return at(n.a) / at(n.b);
    case Op::sqrt:
      return sqrt(at(n.a));
    case Op::abs:
      return abs(at(n.a));
    case Op::min:
      return less_or(at(n.a), at(n.b), true);
    case Op::max:
      return less_or(at(n.a), at(n.b), false);
    case Op::certain_nonzero:
      return guarded(at(n.a), at(n.b), true);
    case Op::certain_nonnegative:
      return guarded(at(n.a), at(n.b), false);
    case Op::max_magnitude:
      if constexpr (requires { at(n.a) < at(n.b); }) {
        return at(n.a) < at(n.b) ? at(n.b) : at(n.a);
      } else {
        return less_or(at(n.a), at(n.b), false);
      }
    case Op::normalizer:
      if constexpr (std::is_floating_point_v<Number>) {
        return normalizer_of(at(n.a));
      } else {
        return at(n.a);  // only the generated code of floating-point numbers has it
      }
    case Op::select:
      return takes_first(at(n.a)) ? at(n.b) : at(n.c);
    case Op::fma:
      break;
  }
  return fma(at(n.a), at(n.b), at(n.c));
}

/// The values of all nodes of `graph`, in order, given one value per input slot.
template <class Number>
std::vector<Number> evaluate(const Graph& graph, std::span<const Number> slots) {
  std::vector<Number> v;
  v.reserve(static_cast<std::size_t>(graph.size()));
  const auto at = [&](NodeId id) -> const Number& { return v[static_cast<std::size_t>(id)]; };
  for (NodeId id = 0; id < graph.size(); ++id) v.push_back(evaluate_node<Number>(graph[id], slots, at));
  return v;
}

}  // namespace tightrope::dsl
