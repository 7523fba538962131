#pragma once
/// Polynomials over integers: what exact code evaluates, and how large its values get.
///
/// At run time all inputs are integers times one common power of two, x = X 2^e (runtime/tightrope/exact_sign.h). Every
/// node of degree d stands for the number factor * V * 2^(e d), V an integer that the node computes from the X, factor
/// a positive rational known at compile time (ScaledNode). So divisions by constants and scalings never happen, sums
/// bring both sides to a common factor by integer multipliers, and the sign of a node is that of V.
///
/// Lemma (growth): if every |X| < 2^L, every node has |V| < growth * 2^(d L). Induction over the nodes: an input has
/// growth 1, d = 1; the constant 1 has growth 2, d = 0; sums add growths of one degree, products multiply growths and
/// add degrees; multiples and shifts multiply the growth; the others compute V of an operand, its negative or 0, or
/// -1, 0, 1. Growths are rounded upwards.

#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include "dsl/rational.h"

namespace tightrope::codegen {

using ExactId = std::int32_t;

enum class ExactOp : std::uint8_t {
  input,       ///< X of input slot `value`; slot -1 is the number 1 as an input, 2^-e
  whole,       ///< `value`, which is 0 or 1
  sum,         ///< a + b
  difference,  ///< a - b
  negated,     ///< -a
  product,     ///< a * b
  multiple,    ///< a * value
  shifted,     ///< a * 2^value
  raised,      ///< a * (2^-e)^value: the same number, its degree raised by `value`
  magnitude,   ///< |a|
  signed_by,   ///< a * sign(b)
  selected,    ///< c < 0 ? a : b
  root_sign,   ///< sign(a + b sqrt(z)), with c = a^2 - b^2 z, and b = 0 if z = 0
};

struct ExactNode {
  ExactOp op = ExactOp::whole;
  ExactId a = -1, b = -1, c = -1;
  std::int64_t value = 0;
  int degree = 0;
  double growth = 0;
};

/// factor * V * 2^(e d); factor > 0. Zero is the node `zero()` with factor 1 and may stand for any degree.
struct ScaledNode {
  ExactId node = -1;
  dsl::Rational factor = 1;
};

/// Hash-consed arena, operands before users.
class ExactGraph {
 public:
  ExactGraph();

  const ExactNode& operator[](ExactId id) const { return nodes_[static_cast<std::size_t>(id)]; }
  ExactId size() const { return static_cast<ExactId>(nodes_.size()); }
  ScaledNode zero() const { return {0, 1}; }
  ScaledNode one() const { return {1, 1}; }
  bool is_zero(const ScaledNode& x) const { return x.node == 0; }
  bool is_one(ExactId id) const { return id == 1; }

  ScaledNode input(int slot);
  ScaledNode constant(const dsl::Rational& value);
  ScaledNode negated(const ScaledNode& x);
  ScaledNode sum(const ScaledNode& x, const ScaledNode& y);
  ScaledNode difference(const ScaledNode& x, const ScaledNode& y) { return sum(x, negated(y)); }
  ScaledNode product(const ScaledNode& x, const ScaledNode& y);
  ScaledNode scaled(const ScaledNode& x, const dsl::Rational& positive) const;
  ScaledNode magnitude(const ScaledNode& x);
  ScaledNode signed_by(const ScaledNode& x, ExactId by);
  /// condition < 0 ? x : y
  ScaledNode selected(ExactId condition, const ScaledNode& x, const ScaledNode& y);
  ExactId root_sign(const ScaledNode& a, const ScaledNode& b, const ScaledNode& test);

  /// Whether every factor so far stayed within dsl::Rational; if not, the graph is of no use.
  bool factors_fit() const { return factors_fit_; }

 private:
  struct Pair {
    ExactId x, y;
    dsl::Rational factor;
  };
  /// x and y as nodes of one degree and one factor.
  Pair aligned(const ScaledNode& x, const ScaledNode& y);
  ExactId raised(ExactId id, int degree);
  ExactId multiplied(ExactId id, const dsl::Rational& whole);
  ExactId multiplied(ExactId id, dsl::Int128 number);
  ScaledNode checked(ScaledNode x);
  ExactId intern(ExactNode node);

  std::vector<ExactNode> nodes_;
  std::unordered_multimap<std::uint64_t, ExactId> table_;
  bool factors_fit_ = true;
};

/// The least k with growth <= 2^k.
int growth_bits(const ExactNode& node);

/// A growth above this has no fixed width.
inline constexpr double largest_growth = 0x1p900;

}  // namespace tightrope::codegen
