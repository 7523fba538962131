#include "codegen/error_sum.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "codegen/precision.h"

namespace tightrope::codegen {

using dsl::no_node;
using dsl::Node;
using dsl::NodeId;
using dsl::Op;

namespace {
constexpr double infinity = std::numeric_limits<double>::infinity();
}

ErrorSum::ErrorSum(dsl::Graph& graph, RangeAnalysis& ranges, std::vector<double> roundings, Weakening weakening)
    : graph_(graph), ranges_(ranges), roundings_(std::move(roundings)), weakening_(weakening) {
  extend_perturbations();
}

/// Derivatives that turn out to be nodes of the predicate keep that node's rounding: too much, never too little.
void ErrorSum::extend_perturbations() {
  for (auto id = static_cast<NodeId>(perturbations_.size()); id < graph_.size(); ++id) {
    const auto i = static_cast<std::size_t>(id);
    const double own = i < roundings_.size() ? roundings_[i] : 0;
    perturbations_.push_back(add_up(perturbation(graph_[id]), own));
  }
}

double ErrorSum::perturbation(const Node& n) const {
  const auto product = [&] {
    const double first = mul_up(size(n.a), at(n.b));
    return add_up(first, mul_up(at(n.a), add_up(size(n.b), at(n.b))));
  };
  switch (n.op) {
    case Op::input:
    case Op::constant:
      return 0;
    case Op::add:
    case Op::sub:
      return add_up(at(n.a), at(n.b));
    case Op::neg:
      return at(n.a);
    case Op::mul:
      return product();
    case Op::fma:
      return add_up(product(), at(n.c));
    case Op::mul_pow2:
      return scaled_up(at(n.a), n.index);
    case Op::div:
      if (graph_[n.b].op == Op::constant) return div_up(at(n.a), std::abs(graph_[n.b].value));
      break;
    case Op::sqrt:
    case Op::abs:
    case Op::min:
    case Op::max:
    case Op::certain_nonzero:
    case Op::certain_nonnegative:
    case Op::normalizer:
    case Op::max_magnitude:
    case Op::select:
      break;
  }
  return infinity;
}

bool ErrorSum::polynomial(NodeId id) const { return std::isfinite(at(id)) && std::isfinite(size(id)); }

NodeId ErrorSum::times(NodeId x, NodeId y) {
  const auto is_one = [&](NodeId id) { return graph_[id].op == Op::constant && graph_[id].value == 1; };
  return is_one(x) ? y : is_one(y) ? x : graph_.mul(x, y);
}

void ErrorSum::add_derivative(NodeId id, NodeId contribution) {
  NodeId& d = derivatives_[static_cast<std::size_t>(id)];
  d = d == no_node ? contribution : graph_.add(d, contribution);
}

/// One step of reverse differentiation: what node n hands on to its operands.
void ErrorSum::propagate(const Node& n, NodeId d) {
  const auto factors = [&] {
    if (!weakened(Weakening::drop_first_factor_error)) add_derivative(n.a, times(d, n.b));
    if (!weakened(Weakening::drop_second_factor_error)) add_derivative(n.b, times(d, n.a));
  };
  switch (n.op) {
    case Op::add:
    case Op::sub:
      add_derivative(n.a, d);
      if (!weakened(Weakening::drop_operand_error_of_sums)) add_derivative(n.b, n.op == Op::add ? d : graph_.neg(d));
      break;
    case Op::neg:
      add_derivative(n.a, graph_.neg(d));
      break;
    case Op::mul:
      factors();
      break;
    case Op::fma:
      factors();
      add_derivative(n.c, d);
      break;
    case Op::mul_pow2:
      add_derivative(n.a, graph_.mul_pow2(d, n.index));
      break;
    case Op::div:
      add_derivative(n.a, graph_.binary(Op::div, d, n.b));
      break;
    case Op::input:
    case Op::constant:
    case Op::sqrt:
    case Op::abs:
    case Op::min:
    case Op::max:
    case Op::certain_nonzero:
    case Op::certain_nonnegative:
    case Op::normalizer:
    case Op::max_magnitude:
    case Op::select:
      break;
  }
}

std::vector<WeightedNode> ErrorSum::weighted_derivatives(NodeId output) {
  derivatives_.assign(static_cast<std::size_t>(output) + 1, no_node);
  derivatives_[static_cast<std::size_t>(output)] = graph_.constant(1);
  std::map<NodeId, double> weights;
  for (NodeId id = output; id >= 0; --id) {
    const NodeId d = derivatives_[static_cast<std::size_t>(id)];
    if (d == no_node) continue;
    const double rounding = roundings_[static_cast<std::size_t>(id)];
    if (rounding > 0) weights[d] = add_up(weights[d], rounding);
    const Node n = graph_[id];  // a copy: the graph grows
    propagate(n, d);
  }
  std::vector<WeightedNode> result;
  for (const auto& [node, weight] : weights) result.push_back({node, weight});
  return result;
}

double ErrorSum::bound(NodeId output) {
  if (!polynomial(output)) return infinity;
  const std::vector<WeightedNode> terms = weighted_derivatives(output);
  ranges_.extend();
  extend_perturbations();
  double separately = 0;
  double second_order = 0;
  for (const WeightedNode& term : terms) {
    separately = add_up(separately, mul_up(term.weight, size(term.node)));
    const bool dropped = weakened(Weakening::drop_product_of_errors);
    if (!dropped) second_order = add_up(second_order, mul_up(term.weight, at(term.node)));
  }
  const double first_order = std::min(separately, ranges_.largest_sum(terms).value_or(infinity));
  const double total = add_up(first_order, second_order);
  return std::isnan(total) ? infinity : total;
}

}  // namespace tightrope::codegen
