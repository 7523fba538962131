#pragma once
/// Evaluates a graph on any number type: floating point (what generated code computes) or exact arithmetic.

#include <cmath>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "dsl/graph.h"

namespace tightrope::dsl {

/// The values of all nodes of `graph`, in order, given one value per input slot.
///
/// `Number` needs + - * / and unary minus, construction from double, and found by argument-dependent lookup (or built
/// in for floating point) abs(x), sqrt(x), min(x, y), max(x, y), mul_pow2(x, int), fma(x, y, z). On exact
/// numbers the guards (Op::certain_nonzero ..) let everything pass.
template <class Number>
std::vector<Number> evaluate(const Graph& graph, std::span<const Number> slots) {
  using std::abs;
  using std::fma;
  using std::sqrt;
  std::vector<Number> v;
  v.reserve(static_cast<std::size_t>(graph.size()));
  const auto at = [&](NodeId id) -> const Number& { return v[static_cast<std::size_t>(id)]; };
  const auto less_or = [](const Number& x, const Number& y, bool want_less) {  // NaN if either operand is NaN
    if (x < y) return want_less ? x : y;
    if (y < x || x == y) return want_less ? y : x;
    return x + y;
  };
  const auto guarded = [](const Number& x, const Number& bound, bool strictly) -> Number {
    if constexpr (std::is_floating_point_v<Number>) {
      const bool holds = strictly ? std::abs(x) > bound : x >= bound;
      return holds ? x : std::numeric_limits<Number>::quiet_NaN();
    } else {
      return x;
    }
  };
  for (NodeId id = 0; id < graph.size(); ++id) {
    const Node& n = graph[id];
    switch (n.op) {
      case Op::input:
        v.push_back(slots[static_cast<std::size_t>(n.index)]);
        break;
      case Op::constant:
        v.push_back(Number(n.value));
        break;
      case Op::add:
        v.push_back(at(n.a) + at(n.b));
        break;
      case Op::sub:
        v.push_back(at(n.a) - at(n.b));
        break;
      case Op::neg:
        v.push_back(-at(n.a));
        break;
      case Op::mul:
        v.push_back(at(n.a) * at(n.b));
        break;
      case Op::mul_pow2:
        if constexpr (std::is_floating_point_v<Number>) {
          v.push_back(std::ldexp(at(n.a), n.index));
        } else {
          v.push_back(mul_pow2(at(n.a), n.index));
        }
        break;
      case Op::div:
        v.push_back(at(n.a) / at(n.b));
        break;
      case Op::sqrt:
        v.push_back(sqrt(at(n.a)));
        break;
      case Op::abs:
        v.push_back(abs(at(n.a)));
        break;
      case Op::min:
        v.push_back(less_or(at(n.a), at(n.b), true));
        break;
      case Op::max:
        v.push_back(less_or(at(n.a), at(n.b), false));
        break;
      case Op::certain_nonzero:
        v.push_back(guarded(at(n.a), at(n.b), true));
        break;
      case Op::certain_nonnegative:
        v.push_back(guarded(at(n.a), at(n.b), false));
        break;
      case Op::max_magnitude:
        v.push_back(at(n.b) > at(n.a) ? at(n.b) : at(n.a));
        break;
      case Op::fma:
        v.push_back(fma(at(n.a), at(n.b), at(n.c)));
        break;
    }
  }
  return v;
}

}  // namespace tightrope::dsl
