#include "codegen/exact_graph.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "codegen/precision.h"

namespace tightrope::codegen {
namespace {

using dsl::Int128;
using dsl::Rational;

std::uint64_t hash(const ExactNode& n) {
  std::uint64_t h = static_cast<std::uint64_t>(n.op);
  for (const std::int64_t part : {std::int64_t{n.a}, std::int64_t{n.b}, std::int64_t{n.c}, n.value}) {
    h = (h ^ static_cast<std::uint64_t>(part)) * 0x9E3779B97F4A7C15U;
    h ^= h >> 32;
  }
  return h;
}

bool same(const ExactNode& x, const ExactNode& y) {
  return x.op == y.op && x.a == y.a && x.b == y.b && x.c == y.c && x.value == y.value;
}

}  // namespace

int growth_bits(const ExactNode& node) {
  int exponent = 0;
  const double fraction = std::frexp(node.growth, &exponent);  // growth = fraction 2^exponent, fraction >= 1/2
  return fraction == 0.5 ? exponent - 1 : exponent;
}

ExactGraph::ExactGraph() {
  intern({.op = ExactOp::whole, .value = 0});
  intern({.op = ExactOp::whole, .value = 1});
}

ExactId ExactGraph::intern(ExactNode n) {
  if ((n.op == ExactOp::sum || n.op == ExactOp::product) && n.a > n.b) std::swap(n.a, n.b);
  const std::uint64_t key = hash(n);
  for (auto [it, end] = table_.equal_range(key); it != end; ++it) {
    if (same(nodes_[static_cast<std::size_t>(it->second)], n)) return it->second;
  }
  const auto at = [this](ExactId id) -> const ExactNode& { return nodes_[static_cast<std::size_t>(id)]; };
  switch (n.op) {
    case ExactOp::input:
      n.degree = 1, n.growth = 1;
      break;
    case ExactOp::whole:
      n.growth = 2;
      break;
    case ExactOp::sum:
    case ExactOp::difference:
      n.degree = at(n.a).degree, n.growth = add_up(at(n.a).growth, at(n.b).growth);
      break;
    case ExactOp::product:
      n.degree = at(n.a).degree + at(n.b).degree, n.growth = mul_up(at(n.a).growth, at(n.b).growth);
      break;
    case ExactOp::multiple:
      n.degree = at(n.a).degree;
      n.growth = mul_up(at(n.a).growth, add_up(static_cast<double>(n.value), 512));  // value < 2^62, rounded by <= 2^8
      if (n.value < (std::int64_t{1} << 53)) n.growth = mul_up(at(n.a).growth, static_cast<double>(n.value));
      break;
    case ExactOp::shifted:
      n.degree = at(n.a).degree;
      n.growth = n.value > 900 ? std::numeric_limits<double>::infinity()
                               : mul_up(at(n.a).growth, std::ldexp(1.0, static_cast<int>(n.value)));
      break;
    case ExactOp::raised:
      n.degree = at(n.a).degree + static_cast<int>(n.value), n.growth = at(n.a).growth;
      break;
    case ExactOp::negated:
    case ExactOp::magnitude:
    case ExactOp::signed_by:
      n.degree = at(n.a).degree, n.growth = at(n.a).growth;
      break;
    case ExactOp::selected:
      n.degree = at(n.a).degree, n.growth = std::max(at(n.a).growth, at(n.b).growth);
      break;
    case ExactOp::root_sign:
      n.growth = 2;
      break;
  }
  nodes_.push_back(n);
  table_.emplace(key, size() - 1);
  return size() - 1;
}

ScaledNode ExactGraph::checked(ScaledNode x) {
  if (!x.factor.valid()) {
    factors_fit_ = false;
    x.factor = 1;
  }
  return x;
}

ScaledNode ExactGraph::input(int slot) { return {intern({.op = ExactOp::input, .value = slot}), 1}; }

ScaledNode ExactGraph::constant(const Rational& value) {
  if (value.is_zero()) return zero();
  const ScaledNode positive = {one().node, abs(value)};
  return value.sign() < 0 ? negated(positive) : positive;
}

ScaledNode ExactGraph::scaled(const ScaledNode& x, const Rational& positive) const {
  return is_zero(x) ? x : ScaledNode{x.node, x.factor * positive};
}

ScaledNode ExactGraph::negated(const ScaledNode& x) {
  if (is_zero(x)) return x;
  const ExactNode& n = (*this)[x.node];
  if (n.op == ExactOp::negated) return {n.a, x.factor};
  if (n.op == ExactOp::difference) return {intern({.op = ExactOp::difference, .a = n.b, .b = n.a}), x.factor};
  return {intern({.op = ExactOp::negated, .a = x.node}), x.factor};
}

ExactId ExactGraph::raised(ExactId id, int degree) {
  const ExactNode& n = (*this)[id];
  if (n.degree == degree) return id;
  return intern({.op = ExactOp::raised, .a = id, .value = degree - n.degree});
}

/// id * number, number > 0, in parts of at most 62 bits: high 2^62 + low, where high of 126 bits may have 64.
ExactId ExactGraph::multiplied(ExactId id, Int128 number) {
  constexpr Int128 limit = Int128{1} << 62;
  if (number == 1) return id;
  if (number < limit) {
    return intern({.op = ExactOp::multiple, .a = id, .value = static_cast<std::int64_t>(number)});
  }
  const ExactId above = intern({.op = ExactOp::shifted, .a = multiplied(id, number / limit), .value = 62});
  const Int128 low = number % limit;
  return low == 0 ? above : intern({.op = ExactOp::sum, .a = above, .b = multiplied(id, low)});
}

/// id * whole, a positive whole number.
ExactId ExactGraph::multiplied(ExactId id, const Rational& whole) {
  id = multiplied(id, whole.odd_numerator());
  return whole.exponent() == 0 ? id : intern({.op = ExactOp::shifted, .a = id, .value = whole.exponent()});
}

ExactGraph::Pair ExactGraph::aligned(const ScaledNode& x, const ScaledNode& y) {
  const int degree = is_zero(x)   ? (*this)[y.node].degree
                     : is_zero(y) ? (*this)[x.node].degree
                                  : std::max((*this)[x.node].degree, (*this)[y.node].degree);
  Rational common = is_zero(x) ? y.factor : is_zero(y) ? x.factor : common_divisor(x.factor, y.factor);
  const Rational of_x = is_zero(x) ? Rational(1) : x.factor / common;
  const Rational of_y = is_zero(y) ? Rational(1) : y.factor / common;
  if (!common.valid() || !of_x.valid() || !of_y.valid()) {
    factors_fit_ = false;
    return {x.node, y.node, 1};
  }
  return {multiplied(raised(x.node, degree), of_x), multiplied(raised(y.node, degree), of_y), common};
}

ScaledNode ExactGraph::sum(const ScaledNode& x, const ScaledNode& y) {
  if (is_zero(x)) return y;
  if (is_zero(y)) return x;
  const bool x_negated = (*this)[x.node].op == ExactOp::negated, y_negated = (*this)[y.node].op == ExactOp::negated;
  if (x_negated && y_negated) return negated(sum(negated(x), negated(y)));
  const Pair p = x_negated ? aligned(y, negated(x)) : aligned(x, y_negated ? negated(y) : y);
  const ExactOp op = x_negated || y_negated ? ExactOp::difference : ExactOp::sum;
  return {intern({.op = op, .a = p.x, .b = p.y}), p.factor};
}

ScaledNode ExactGraph::product(const ScaledNode& given_x, const ScaledNode& given_y) {
  ScaledNode x = given_x, y = given_y;
  if (is_zero(x) || is_zero(y)) return zero();
  if ((*this)[x.node].op == ExactOp::negated) return negated(product(negated(x), y));
  if ((*this)[y.node].op == ExactOp::negated) return negated(product(x, negated(y)));
  if (!(x.factor * y.factor).valid()) {  // the numerators become part of V
    for (ScaledNode* const z : {&x, &y}) {
      const Rational numerator = Rational::quotient(z->factor.odd_numerator(), 1);
      z->node = multiplied(z->node, numerator);
      z->factor = z->factor / numerator;
    }
  }
  const ScaledNode result = checked({x.node, x.factor * y.factor});
  if (is_one(x.node)) return {y.node, result.factor};
  if (is_one(y.node)) return result;
  return {intern({.op = ExactOp::product, .a = x.node, .b = y.node}), result.factor};
}

ScaledNode ExactGraph::magnitude(const ScaledNode& x) {
  const ExactNode& n = (*this)[x.node];
  if (n.op == ExactOp::negated) return magnitude({n.a, x.factor});
  if (n.op == ExactOp::magnitude || n.op == ExactOp::whole || (n.op == ExactOp::product && n.a == n.b)) return x;
  return {intern({.op = ExactOp::magnitude, .a = x.node}), x.factor};
}

ScaledNode ExactGraph::signed_by(const ScaledNode& x, ExactId by) {
  if (is_zero(x) || is_one(by)) return x;
  if (by == zero().node) return zero();
  return {intern({.op = ExactOp::signed_by, .a = x.node, .b = by}), x.factor};
}

ScaledNode ExactGraph::selected(ExactId condition, const ScaledNode& x, const ScaledNode& y) {
  const Pair p = aligned(x, y);
  return {intern({.op = ExactOp::selected, .a = p.x, .b = p.y, .c = condition}), p.factor};
}

ExactId ExactGraph::root_sign(const ScaledNode& a, const ScaledNode& b, const ScaledNode& test) {
  return intern({.op = ExactOp::root_sign, .a = a.node, .b = b.node, .c = test.node});
}

}  // namespace tightrope::codegen
