#pragma once
/// A scalar while it is being lowered: an exact rational multiple of a graph node, or a compile-time number.
///
/// Factors stay symbolic as long as they can. The binomial weights of Bernstein products then cancel instead of being
/// multiplied in and divided out (MATH 1.1, 1.2: a product's scaled coefficient C(n,i) b_i is a plain sum of products),
/// and `3 * Y` of a cubic Y costs no division. A factor becomes an operation where a value is needed: for an output,
/// for an operand of a non-linear operation, or where terms of different factors meet in a sum.

#include <optional>
#include <span>
#include <vector>

#include "dsl/graph.h"
#include "dsl/program.h"
#include "dsl/rational.h"

namespace tightrope::dsl {

struct Coefficient {
  Rational factor;        ///< times the node; or the number itself
  NodeId node = no_node;  ///< no_node: a compile-time number
  bool literal = false;   ///< a number just as a literal says it, and no double: `0.1`, but not `1/10`
  bool is_number() const { return node == no_node; }
  bool operator==(const Coefficient&) const = default;
};

inline Coefficient number(const Rational& value) { return {.factor = value}; }
inline Coefficient run_time(NodeId node) { return {.factor = 1, .node = node}; }

/// The graph under construction, and what went wrong while adding to it (to be turned into a diagnostic by the caller,
/// who knows the place).
struct Lowering {
  Graph graph;
  ProductScheme products = ProductScheme::direct;
  EvaluationScheme evaluation = EvaluationScheme::horner;

  bool overflow = false;                       ///< a compile-time number left the range of `Rational`
  std::optional<Coefficient> unrepresentable;  ///< a number that had to become a constant and is no double
};

// Each of these adds the nodes it needs. Terms with compile-time numbers fold exactly (x * 1, x + 0); nothing that
// depends on an input is ever dropped: 0 * x and x - x stay, because they are NaN where x is not finite.
Coefficient scale(Lowering& low, const Coefficient& a, const Rational& by);
Coefficient negate(const Coefficient& a);
Coefficient multiply(Lowering& low, const Coefficient& a, const Coefficient& b);
/// b is not the number 0.
Coefficient divide(Lowering& low, const Coefficient& a, const Coefficient& b);
Coefficient add(Lowering& low, const Coefficient& a, const Coefficient& b);
Coefficient subtract(Lowering& low, const Coefficient& a, const Coefficient& b);
/// The sum, left to right; terms with the same node are merged first (for the few terms of a Bernstein product).
Coefficient sum(Lowering& low, std::span<const Coefficient> terms);
/// b - a where `b` was computed as a + x, a - x or x + a: x itself, exactly; else the difference. For the weights
/// (s - r, r) of an evaluation at r/s with s = r + x, which need not suffer the rounding of s.
Coefficient complement(Lowering& low, const Coefficient& a, const Coefficient& b);
Coefficient abs(Lowering& low, const Coefficient& a);
/// a is not a negative number.
Coefficient square_root(Lowering& low, const Coefficient& a);
/// a * b + c, rounded once; a product of two numbers is one.
Coefficient fused(Lowering& low, const Coefficient& a, const Coefficient& b, const Coefficient& c);
Coefficient minimum_or_maximum(Lowering& low, Op op, const Coefficient& a, const Coefficient& b);

/// The node that computes `a`: at most one rounding for a factor p/1 or 1/q, two for p/q, none for powers of two.
NodeId materialise(Lowering& low, const Coefficient& a);

/// The factor to take out of a sum of multiples `factors[i]` (positive) of nodes, so that the remaining factors and the
/// one taken out cost the fewest roundings, then the fewest operations.
Rational common_factor(std::span<const Rational> factors);

/// Rewrites run-time coefficients so that all have the same factor up to sign.
void share_factor(Lowering& low, std::span<Coefficient> coefficients);

}  // namespace tightrope::dsl
