#include "dsl/coefficient.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>

namespace tightrope::dsl {
namespace {

Coefficient checked(Lowering& low, Coefficient a) {
  if (!a.factor.valid()) {
    low.overflow = true;
    a.factor = 1;  // keeps what follows well-defined; the caller reports and discards it
  }
  return a;
}

/// What it costs to multiply by a positive factor: a rounding counts 100, an exact scaling 1, or 2 downwards (it may
/// underflow, which bounds have to allow for).
int cost(const Rational& factor) {
  int total = 0;
  if (factor.odd_numerator() != 1) total += 100;
  if (factor.odd_denominator() != 1) total += 101;
  if (total == 0 && factor.exponent() != 0) total = factor.exponent() > 0 ? 1 : 2;
  return total;
}

/// The multiple of a simpler node that `node` was made of by `materialise`.
Coefficient peel(const Graph& graph, NodeId node) {
  Rational factor = 1;
  const auto constant = [&](NodeId id) -> std::optional<Rational> {
    if (graph[id].op != Op::constant) return std::nullopt;
    int exponent = 0;
    const double mantissa = std::frexp(graph[id].value, &exponent);
    if (mantissa == 0 || !std::isfinite(mantissa)) return std::nullopt;
    return Rational(static_cast<std::int64_t>(std::ldexp(mantissa, 53))) * Rational::power_of_two(exponent - 53);
  };
  for (;;) {
    const Node& n = graph[node];
    if (n.op == Op::neg) {
      factor = -factor;
      node = n.a;
    } else if (n.op == Op::mul_pow2) {
      factor = factor * Rational::power_of_two(n.index);
      node = n.a;
    } else if (const auto c = n.op == Op::mul ? constant(n.a) : std::nullopt; c) {
      factor = factor * *c;
      node = n.b;
    } else if (const auto d = n.op == Op::mul ? constant(n.b) : std::nullopt; d) {
      factor = factor * *d;
      node = n.a;
    } else if (const auto q = n.op == Op::div ? constant(n.b) : std::nullopt; q) {
      factor = factor / *q;
      node = n.a;
    } else {
      return {.factor = factor, .node = node};
    }
  }
}

std::optional<NodeId> constant_node(Lowering& low, const Rational& value) {
  if (const auto d = value.to_double()) return low.graph.constant(*d);
  return std::nullopt;
}

/// The whole number that makes `value` whole: 10 of 3/10.
Rational denominator(const Rational& value) {
  return Rational::quotient(value.odd_denominator(), 1) * Rational::power_of_two(std::max(-value.exponent(), 0));
}

NodeId unrepresentable(Lowering& low, const Coefficient& a) {
  if (!low.unrepresentable) low.unrepresentable = a;
  return a.is_number() ? low.graph.constant(0) : a.node;
}

NodeId materialise_number(Lowering& low, const Coefficient& a) {
  if (const auto node = constant_node(low, a.factor)) return *node;
  if (a.literal) return unrepresentable(low, a);
  const Rational q = denominator(a.factor);
  const auto n = constant_node(low, a.factor * q);
  const auto d = constant_node(low, q);
  if (q.is_one() || !n || !d) return unrepresentable(low, a);
  return low.graph.binary(Op::div, *n, *d);
}

}  // namespace

NodeId materialise(Lowering& low, const Coefficient& a) {
  if (a.is_number()) return materialise_number(low, a);
  const Rational& f = a.factor;
  NodeId node = a.node;
  if (f.odd_denominator() == 1 && abs(Rational::quotient(f.odd_numerator(), 1)).is_one()) {  // exact
    if (std::abs(f.exponent()) > 2098) return unrepresentable(low, a);  // any double would leave its range
    if (f.exponent() != 0) node = low.graph.mul_pow2(node, f.exponent());
    return f.sign() < 0 ? low.graph.neg(node) : node;
  }
  // |f| = 2^e p / q. The power of two rides on the constant it makes larger, the sign on the first one.
  const Int128 p = f.sign() < 0 ? -f.odd_numerator() : f.odd_numerator();
  std::vector<double> multipliers = p == 1 ? std::vector<double>{} : double_factors(p);
  std::vector<double> divisors = f.odd_denominator() == 1 ? std::vector<double>{} : double_factors(f.odd_denominator());
  if ((p != 1 && multipliers.empty()) || (f.odd_denominator() != 1 && divisors.empty()) ||
      std::abs(f.exponent()) > 900) {
    return unrepresentable(low, a);
  }
  const bool on_multiplier = divisors.empty() || (f.exponent() > 0 && !multipliers.empty());
  double& carrier = on_multiplier ? multipliers.front() : divisors.front();
  carrier = std::ldexp(carrier, on_multiplier ? f.exponent() : -f.exponent());
  if (f.sign() < 0) (multipliers.empty() ? divisors : multipliers).front() *= -1;
  for (const double m : multipliers) node = low.graph.mul(node, low.graph.constant(m));
  for (const double d : divisors) node = low.graph.binary(Op::div, node, low.graph.constant(d));
  return node;
}

Rational common_factor(std::span<const Rational> factors) {
  std::vector<Rational> candidates = {Rational(1)};
  Rational divisor = factors.empty() ? Rational(1) : factors.front();
  for (const Rational& f : factors) {
    if (std::find(candidates.begin(), candidates.end(), f) == candidates.end()) candidates.push_back(f);
    if (divisor.valid()) divisor = common_divisor(divisor, f);
  }
  if (divisor.valid()) candidates.push_back(divisor);
  Rational best = 1;
  int best_cost = -1;
  for (const Rational& candidate : candidates) {
    int total = cost(candidate);
    for (const Rational& f : factors) {
      const Rational rest = f / candidate;
      total += rest.valid() ? cost(rest) : 1000;
    }
    if (best_cost < 0 || total < best_cost) {
      best = candidate;
      best_cost = total;
    }
  }
  return best;
}

Coefficient negate(const Coefficient& a) { return {.factor = -a.factor, .node = a.node, .literal = a.literal}; }

Coefficient scale(Lowering& low, const Coefficient& a, const Rational& by) {
  if (by.is_one()) return a;
  if (by.is_zero() && !a.is_number()) return run_time(low.graph.mul(a.node, low.graph.constant(0)));
  return checked(low, {.factor = a.factor * by, .node = a.node});
}

Coefficient multiply(Lowering& low, const Coefficient& a, const Coefficient& b) {
  if (a.is_number()) return scale(low, b, a.factor);
  if (b.is_number()) return scale(low, a, b.factor);
  return checked(low, {.factor = a.factor * b.factor, .node = low.graph.mul(a.node, b.node)});
}

Coefficient divide(Lowering& low, const Coefficient& a, const Coefficient& b) {
  if (b.is_number()) return checked(low, {.factor = a.factor / b.factor, .node = a.node});
  if (!a.is_number()) {
    return checked(low, {.factor = a.factor / b.factor, .node = low.graph.binary(Op::div, a.node, b.node)});
  }
  // A number over a run-time value: as much of the quotient's factor as a constant holds becomes the numerator.
  const Rational factor = a.factor / b.factor;
  if (!factor.valid()) return checked(low, {.factor = factor, .node = b.node});
  const Rational rest = factor.odd_denominator() == 1 ? Rational(1) : Rational(1) / denominator(factor);
  if (const auto numerator = constant_node(low, factor / rest)) {
    return {.factor = rest, .node = low.graph.binary(Op::div, *numerator, b.node)};
  }
  return {.factor = factor, .node = low.graph.binary(Op::div, low.graph.constant(1), b.node)};
}

void share_factor(Lowering& low, std::span<Coefficient> coefficients) {
  std::vector<Rational> factors;
  for (const Coefficient& c : coefficients) {
    if (!c.is_number()) factors.push_back(abs(c.factor));
  }
  if (std::all_of(factors.begin(), factors.end(), [&](const Rational& f) { return f == factors.front(); })) return;
  const Rational common = common_factor(factors);
  for (Coefficient& c : coefficients) {
    if (c.is_number()) continue;
    const Rational rest = abs(c.factor) / common;
    if (!rest.valid()) low.overflow = true;
    const NodeId node = rest.valid() ? materialise(low, {.factor = rest, .node = c.node}) : c.node;
    c = {.factor = c.factor.sign() < 0 ? -common : common, .node = node};
  }
}

namespace {

/// Merges terms with the same node (unless they cancel), and numbers; drops the number 0.
std::vector<Coefficient> merged(Lowering& low, std::span<const Coefficient> terms) {
  std::vector<Coefficient> result;
  for (const Coefficient& term : terms) {
    const auto same = std::find_if(result.begin(), result.end(), [&](const Coefficient& earlier) {
      if (earlier.node != term.node) return false;
      return term.is_number() || !(earlier.factor + term.factor).is_zero();
    });
    if (same == result.end()) {
      result.push_back(term);
    } else if (same->is_number() && same->factor.is_zero()) {
      *same = term;
    } else if (!(term.is_number() && term.factor.is_zero())) {
      *same = checked(low, {.factor = same->factor + term.factor, .node = term.node});
    }
  }
  if (result.size() > 1) {
    std::erase_if(result, [](const Coefficient& t) { return t.is_number() && t.factor.is_zero(); });
  }
  return result;
}

}  // namespace

Coefficient sum(Lowering& low, std::span<const Coefficient> all_terms) {
  const std::vector<Coefficient> terms = merged(low, all_terms);
  if (terms.empty()) return number(0);
  if (terms.size() == 1) return terms.front();

  std::vector<Rational> factors;
  bool has_number = false;
  for (const Coefficient& t : terms) {
    if (t.is_number()) {
      has_number = true;
    } else {
      factors.push_back(abs(t.factor));
    }
  }
  if (factors.empty()) return terms.front();  // cannot happen: numbers have been merged
  Rational common = common_factor(factors);
  // A literal keeps its meaning only as it stands; other numbers take any factor, at no cost if they stay doubles.
  if (has_number && !common.is_one()) {
    const auto stays_double = [&](const Coefficient& t) {
      return !t.is_number() || (!t.literal && (t.factor / common).to_double().has_value());
    };
    if (!std::all_of(terms.begin(), terms.end(), stays_double)) common = 1;
    // One term and a number: multiplying the term out costs the same, and the sum is then as written.
    if (factors.size() == 1) common = 1;
  }

  NodeId total = no_node;
  bool negative = false;  // of the total so far
  for (const Coefficient& t : terms) {
    const Rational rest = abs(t.factor) / common;
    if (!rest.valid()) {
      low.overflow = true;
      return t;
    }
    const NodeId node = materialise(low, {.factor = rest, .node = t.node, .literal = t.literal});
    const bool minus = t.factor.sign() < 0;
    if (total == no_node) {
      total = node;
      negative = minus;
    } else if (minus == negative) {
      total = low.graph.add(total, node);
    } else if (minus) {
      total = low.graph.sub(total, node);
    } else {
      total = low.graph.sub(node, total);
      negative = false;
    }
  }
  return {.factor = negative ? -common : common, .node = total};
}

Coefficient add(Lowering& low, const Coefficient& a, const Coefficient& b) {
  if (!a.is_number() && !b.is_number() && a.node != b.node) {  // the common cases, as `sum` does them
    if (a.factor == b.factor) return {.factor = a.factor, .node = low.graph.add(a.node, b.node)};
    if (a.factor == -b.factor) {
      return a.factor.sign() > 0 ? Coefficient{.factor = a.factor, .node = low.graph.sub(a.node, b.node)}
                                 : Coefficient{.factor = b.factor, .node = low.graph.sub(b.node, a.node)};
    }
  }
  const Coefficient terms[] = {a, b};
  return sum(low, terms);
}

Coefficient subtract(Lowering& low, const Coefficient& a, const Coefficient& b) { return add(low, a, negate(b)); }

Coefficient complement(Lowering& low, const Coefficient& a, const Coefficient& b) {
  if (!a.is_number() && !b.is_number()) {
    const Node& n = low.graph[b.node];
    if (n.op == Op::add || n.op == Op::sub) {
      const auto part = [&](NodeId node, bool minus) {
        Coefficient c = peel(low.graph, node);
        c.factor = c.factor * (minus ? -b.factor : b.factor);
        return c;
      };
      Coefficient whole = peel(low.graph, a.node);
      whole.factor = whole.factor * a.factor;
      const Coefficient first = part(n.a, false);
      const Coefficient second = part(n.b, n.op == Op::sub);
      if (first == whole && second.factor.valid()) return second;
      if (second == whole && first.factor.valid()) return first;
    }
  }
  return subtract(low, b, a);
}

Coefficient abs(Lowering& low, const Coefficient& a) {
  if (a.is_number()) return {.factor = abs(a.factor), .literal = a.literal};
  return {.factor = abs(a.factor), .node = low.graph.abs(a.node)};
}

Coefficient square_root(Lowering& low, const Coefficient& a) {
  if (const auto root = a.factor.square_root(); root && a.factor.sign() >= 0) {
    if (a.is_number()) return number(*root);
    return {.factor = *root, .node = low.graph.unary(Op::sqrt, a.node)};
  }
  return run_time(low.graph.unary(Op::sqrt, materialise(low, a)));
}

Coefficient fused(Lowering& low, const Coefficient& a, const Coefficient& b, const Coefficient& c) {
  if (a.is_number() && b.is_number()) return add(low, multiply(low, a, b), c);
  return run_time(low.graph.fma(materialise(low, a), materialise(low, b), materialise(low, c)));
}

Coefficient minimum_or_maximum(Lowering& low, Op op, const Coefficient& a, const Coefficient& b) {
  assert(op == Op::min || op == Op::max);
  if (a.is_number() && b.is_number()) {
    const Rational difference = a.factor - b.factor;
    if (!difference.valid()) low.overflow = true;
    return (difference.sign() <= 0) == (op == Op::min) ? a : b;
  }
  if (!a.is_number() && !b.is_number() && a.factor == b.factor && a.factor.sign() > 0) {
    return {.factor = a.factor, .node = low.graph.binary(op, a.node, b.node)};
  }
  return run_time(low.graph.binary(op, materialise(low, a), materialise(low, b)));
}

}  // namespace tightrope::dsl
