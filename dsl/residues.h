#pragma once
/// Whether two expressions are the same polynomial, or quotient of polynomials: their values modulo a prime, at random
/// points.
///
/// Every node is evaluated at `points` points of Z_p, p a prime near 2^61, the inputs being numbers of a seeded random
/// sequence. Expressions that are equal have equal residues wherever no divisor is 0 modulo p. Two that differ, their
/// difference a quotient with a numerator of degree d, have equal residues at one random point with a probability of at
/// most d / p (Schwartz, 1980; Zippel, 1979), so at all four points with at most (d / 2^59)^4: less than 2^-200 up to
/// degree 512. (A difference all of whose coefficients are multiples of p would pass at the points of p; the points
/// have two primes.)
///
/// |x|, sqrt, min and max have no meaning modulo p: each is taken as an unknown function of its operands. Then equal
/// residues still mean equal expressions, but different ones may be equal, too.

#include <array>
#include <cstdint>
#include <vector>

#include "dsl/coefficient.h"

namespace tightrope::dsl {

enum class Comparison {
  equal,
  opposite,   ///< a = -b
  different,  ///< certainly
  unknown,    ///< as far as polynomials can tell, different; but roots, magnitudes or extrema are in them
};

/// The residues of the nodes of a graph that only grows.
class Residues {
 public:
  static constexpr std::size_t points = 4;

  Comparison compare(const Graph& graph, const Coefficient& a, const Coefficient& b);

 private:
  /// Values at the points; `none` where a divisor was 0.
  using Values = std::array<std::uint64_t, points>;

  void extend(const Graph& graph);
  Values of(const Coefficient& c) const;
  std::uint64_t value(const Node& node, std::size_t point) const;

  std::vector<Values> values_;
  std::vector<bool> polynomial_;  ///< nothing but + - * / is in it
};

}  // namespace tightrope::dsl
