#include "codegen/raised_maxima.h"

#include <algorithm>
#include <cassert>
#include <functional>

#include "codegen/precision.h"

namespace tightrope::codegen {
namespace {

using dsl::no_node;
using dsl::NodeId;

int exponent_of(const Monomial& monomial, std::size_t group) { return group < monomial.size() ? monomial[group] : 0; }

/// The largest monomial that divides all of them.
Monomial common_monomial(const MagnitudePolynomial& B) {
  Monomial common = B.monomials().begin()->first;
  for (const auto& [monomial, coefficient] : B.monomials()) {
    for (std::size_t g = 0; g < common.size(); ++g) common[g] = std::min(common[g], exponent_of(monomial, g));
  }
  return common;
}

}  // namespace

NodeId evaluate_raised(const MagnitudePolynomial& B, double factor, double threshold, InputGroups& groups,
                       BoundExpressions& r) {
  assert(B.terms() > 0 && "a rounded value has a magnitude");
  const auto times = [&](NodeId x, NodeId y) { return x == no_node ? y : y == no_node ? x : r.times(x, y); };
  const auto product_of_maxima = [&](const std::function<int(std::size_t)>& exponent) {
    NodeId product = no_node;
    for (std::size_t g = 0; g < static_cast<std::size_t>(groups.size()); ++g) {
      if (exponent(g) == 0) continue;
      const NodeId raised = r.larger(groups.maximum(static_cast<int>(g), r), r.constant(threshold));
      product = times(product, r.power(raised, exponent(g)));
    }
    return product;
  };
  const Monomial common = common_monomial(B);
  const auto& terms = B.monomials();
  const double coefficient = terms.begin()->second;
  const bool one_coefficient =
      std::all_of(terms.begin(), terms.end(), [&](const auto& term) { return term.second == coefficient; });
  NodeId total = no_node;
  for (const auto& [monomial, c] : terms) {
    const Monomial& whole = monomial;
    const NodeId rest =
        product_of_maxima([&](std::size_t g) { return exponent_of(whole, g) - exponent_of(common, g); });
    const double own = one_coefficient ? 1 : c;
    total = r.plus(total, rest == no_node ? r.constant(own) : own == 1 ? rest : r.times(rest, r.constant(own)));
  }
  const NodeId outer = product_of_maxima([&](std::size_t g) { return exponent_of(common, g); });
  const bool single = terms.size() == 1;  // the sum is its coefficient alone
  const NodeId body = single ? outer : times(outer, total);
  const NodeId constant = r.constant(one_coefficient ? mul_up(coefficient, factor) : factor);
  return body == no_node ? constant : r.times(body, constant);
}

}  // namespace tightrope::codegen
