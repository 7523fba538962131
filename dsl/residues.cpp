#include "dsl/residues.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace tightrope::dsl {
namespace {

__extension__ typedef unsigned __int128 Wide;

constexpr std::uint64_t none = ~std::uint64_t{0};
/// 2^61 - 1 and 2^59 - 55, which are primes.
constexpr std::array<std::uint64_t, Residues::points> moduli = {
    (std::uint64_t{1} << 61) - 1, (std::uint64_t{1} << 59) - 55, (std::uint64_t{1} << 61) - 1,
    (std::uint64_t{1} << 59) - 55};

/// Arithmetic modulo p; `none` stays none.
struct Field {
  std::uint64_t p;

  std::uint64_t add(std::uint64_t a, std::uint64_t b) const { return a == none || b == none ? none : (a + b) % p; }
  std::uint64_t negate(std::uint64_t a) const { return a == none || a == 0 ? a : p - a; }
  std::uint64_t multiply(std::uint64_t a, std::uint64_t b) const {
    return a == none || b == none ? none : static_cast<std::uint64_t>(Wide{a} * b % p);
  }
  std::uint64_t power(std::uint64_t a, std::uint64_t n) const {
    std::uint64_t result = 1;
    for (; n > 0; n /= 2, a = multiply(a, a)) {
      if (n % 2 == 1) result = multiply(result, a);
    }
    return result;
  }
  std::uint64_t divide(std::uint64_t a, std::uint64_t b) const {  // 1/b = b^(p - 2), by Fermat
    return b == 0 ? none : multiply(a, power(b, p - 2));
  }
  std::uint64_t power_of_two(std::int64_t exponent) const {
    const auto order = static_cast<std::int64_t>(p - 1);  // 2^(p - 1) = 1
    return power(2, static_cast<std::uint64_t>((exponent % order + order) % order));
  }
  std::uint64_t whole(Int128 x) const {
    const auto m = static_cast<Int128>(p);
    return static_cast<std::uint64_t>((x % m + m) % m);
  }
  std::uint64_t rational(const Rational& x) const {
    return multiply(divide(whole(x.odd_numerator()), whole(x.odd_denominator())), power_of_two(x.exponent()));
  }
  std::uint64_t constant(double c) const {
    int exponent = 0;
    const double fraction = std::frexp(c, &exponent);
    return multiply(whole(static_cast<std::int64_t>(std::ldexp(fraction, 53))), power_of_two(exponent - 53));
  }
};

/// A number below p that depends on all of `words` at random.
std::uint64_t random_residue(std::initializer_list<std::uint64_t> words, std::uint64_t p) {
  std::uint64_t state = 0x9E3779B97F4A7C15U;
  for (const std::uint64_t word : words) {
    state = (state ^ word) * 0xBF58476D1CE4E5B9U;
    state = (state ^ (state >> 29)) * 0x94D049BB133111EBU;
    state ^= state >> 32;
  }
  return state % p;
}

/// |x|, sqrt, min, max as functions of which only this is known: |x| = |-x|, min and max are symmetric.
std::uint64_t unknown_function(Op op, std::uint64_t a, std::uint64_t b, const Field& field) {
  if (a == none || b == none) return none;
  if (op == Op::abs) a = std::min(a, field.negate(a));
  if (op == Op::min || op == Op::max) std::tie(a, b) = std::pair(std::min(a, b), std::max(a, b));
  return random_residue({static_cast<std::uint64_t>(op), a, b}, field.p);
}

}  // namespace

std::uint64_t Residues::value(const Node& n, std::size_t point) const {
  const Field field{moduli[point]};
  const auto at = [&](NodeId id) { return id == no_node ? 0 : values_[static_cast<std::size_t>(id)][point]; };
  switch (n.op) {
    case Op::input:
      return random_residue({point, static_cast<std::uint64_t>(n.index), 1979}, field.p);
    case Op::constant:
      return std::isfinite(n.value) ? field.constant(n.value) : none;
    case Op::add:
      return field.add(at(n.a), at(n.b));
    case Op::sub:
      return field.add(at(n.a), field.negate(at(n.b)));
    case Op::neg:
      return field.negate(at(n.a));
    case Op::mul:
      return field.multiply(at(n.a), at(n.b));
    case Op::mul_pow2:
      return field.multiply(at(n.a), field.power_of_two(n.index));
    case Op::div:
      return field.divide(at(n.a), at(n.b));
    case Op::fma:
      return field.add(field.multiply(at(n.a), at(n.b)), at(n.c));
    case Op::select:  // an `either` within, whose alternatives are equal
      return at(n.b);
    case Op::sqrt:
    case Op::abs:
    case Op::min:
    case Op::max:
    case Op::max_magnitude:
    case Op::certain_nonzero:
    case Op::certain_nonnegative:
    case Op::normalizer:
      break;
  }
  return unknown_function(n.op, at(n.a), at(n.b), field);
}

void Residues::extend(const Graph& graph) {
  for (auto id = static_cast<NodeId>(values_.size()); id < graph.size(); ++id) {
    const Node& n = graph[id];
    Values values{};
    for (std::size_t point = 0; point < points; ++point) values[point] = value(n, point);
    values_.push_back(values);
    const bool has_residue = n.op == Op::input || n.op == Op::constant || n.op == Op::add || n.op == Op::sub ||
                             n.op == Op::neg || n.op == Op::mul || n.op == Op::mul_pow2 || n.op == Op::div ||
                             n.op == Op::fma || n.op == Op::select;
    bool polynomial = has_residue;
    for (const NodeId operand : {n.op == Op::select ? no_node : n.a, n.b, n.op == Op::select ? no_node : n.c}) {
      if (operand != no_node) polynomial = polynomial && polynomial_[static_cast<std::size_t>(operand)];
    }
    polynomial_.push_back(polynomial);
  }
}

Residues::Values Residues::of(const Coefficient& c) const {
  Values result{};
  for (std::size_t point = 0; point < points; ++point) {
    const Field field{moduli[point]};
    const std::uint64_t node = c.is_number() ? 1 : values_[static_cast<std::size_t>(c.node)][point];
    result[point] = field.multiply(field.rational(c.factor), node);
  }
  return result;
}

Comparison Residues::compare(const Graph& graph, const Coefficient& a, const Coefficient& b) {
  if (a == b) return Comparison::equal;
  extend(graph);
  const Values x = of(a);
  const Values y = of(b);
  bool equal = true;
  bool opposite = true;
  bool defined = false;
  for (std::size_t point = 0; point < points; ++point) {
    if (x[point] == none || y[point] == none) continue;
    defined = true;
    equal = equal && x[point] == y[point];
    opposite = opposite && x[point] == Field{moduli[point]}.negate(y[point]);
  }
  if (!defined) return Comparison::unknown;
  if (equal) return Comparison::equal;
  const auto polynomial = [&](const Coefficient& c) {
    return c.is_number() || polynomial_[static_cast<std::size_t>(c.node)];
  };
  if (!polynomial(a) || !polynomial(b)) return Comparison::unknown;
  return opposite ? Comparison::opposite : Comparison::different;
}

}  // namespace tightrope::dsl
