#include "codegen/bound_expression.h"

#include <algorithm>
#include <cmath>

#include "codegen/precision.h"

namespace tightrope::codegen {

using dsl::no_node;
using dsl::NodeId;
using dsl::Op;

NodeId BoundExpressions::base(NodeId id) const {
  while (graph_[id].op == Op::neg || graph_[id].op == Op::abs) id = graph_[id].a;
  return id;
}

NodeId BoundExpressions::magnitude(NodeId id) {
  const NodeId x = base(id);
  return graph_[x].op == Op::sqrt ? x : graph_.abs(x);
}

double BoundExpressions::roundings(NodeId id) const {
  const auto found = roundings_.find(id);
  return found == roundings_.end() ? 0 : found->second;
}

/// A node may be a value and a bound at once (both are hash-consed): the larger count stands.
NodeId BoundExpressions::noted(NodeId id, double roundings) {
  double& d = roundings_[id];
  d = std::max(d, roundings);
  return id;
}

NodeId BoundExpressions::constant(double value) { return graph_.constant(round_up(value, format_)); }

NodeId BoundExpressions::least() { return graph_.constant(format_.eta); }

NodeId BoundExpressions::plus(NodeId x, NodeId y) {
  if (x == no_node) return y;
  if (y == no_node) return x;
  return noted(graph_.add(x, y), std::max(roundings(x), roundings(y)) + 1);
}

NodeId BoundExpressions::times(NodeId x, NodeId y) { return noted(graph_.mul(x, y), roundings(x) + roundings(y) + 1); }

NodeId BoundExpressions::times_constant(NodeId x, double c) {
  if (c == 1) return x;
  int exponent = 0;
  if (std::frexp(c, &exponent) == 0.5) return noted(graph_.mul_pow2(x, exponent - 1), roundings(x));
  return noted(graph_.mul(x, constant(c)), roundings(x) + 1);
}

NodeId BoundExpressions::maximum(NodeId x, NodeId y) {
  return x == y ? x : noted(graph_.binary(Op::max, x, y), std::max(roundings(x), roundings(y)));
}

NodeId BoundExpressions::larger(NodeId x, NodeId y) {
  return noted(graph_.binary(Op::max_magnitude, x, y), std::max(roundings(x), roundings(y)));
}

NodeId BoundExpressions::selected(NodeId condition, NodeId x, NodeId y) {
  return x == y ? x : noted(graph_.select(condition, x, y), std::max(roundings(x), roundings(y)));
}

NodeId BoundExpressions::quotient(NodeId x, NodeId y) {
  return noted(graph_.binary(Op::div, x, y), roundings(x) + roundings(y) + 1);
}

NodeId BoundExpressions::root_divisor(NodeId radicand, NodeId root, NodeId bound, bool unguarded) {
  const NodeId least = constant(std::exp2(std::floor(std::log2(format_.eta) / 2)));
  NodeId size = root;
  NodeId margin = graph_.sub(radicand, bound);
  if (unguarded) {
    size = graph_.binary(Op::max, size, graph_.unary(Op::sqrt, bound));
    margin = graph_.binary(Op::max, margin, graph_.constant(0));
  }
  size = graph_.binary(Op::max, size, least);
  return graph_.add(size, graph_.binary(Op::div, margin, size));
}

NodeId BoundExpressions::power(NodeId x, int exponent) {
  if (exponent == 1) return x;
  const NodeId half = power(x, exponent / 2);
  const NodeId square = times(half, half);
  return exponent % 2 == 0 ? square : times(square, x);
}

double root_underflow(const FloatFormat& format) {
  return std::sqrt(format.eta) < std::ldexp(1.0, format.min_exponent) ? 2 : 0;
}

std::vector<const dsl::Output*> outputs_of_nodes(const dsl::Predicate& predicate) {
  std::vector<const dsl::Output*> result(static_cast<std::size_t>(predicate.graph.size()), nullptr);
  for (const auto& stage : predicate.stages) {
    for (const auto& output : stage.outputs) {
      for (const NodeId id : output.nodes) result[static_cast<std::size_t>(id)] = &output;
    }
  }
  for (NodeId id = predicate.graph.size() - 1; id >= 0; --id) {
    const dsl::Node& n = predicate.graph[id];
    for (const NodeId operand : {n.a, n.b, n.c}) {
      if (operand == no_node) continue;
      auto& output = result[static_cast<std::size_t>(operand)];
      if (!output) output = result[static_cast<std::size_t>(id)];
    }
  }
  return result;
}

bool all_inputs_have_ranges(const dsl::Predicate& predicate) {
  return std::all_of(predicate.parameters.begin(), predicate.parameters.end(),
                     [](const dsl::Parameter& p) { return p.range.has_value(); });
}

void report_unbounded(const dsl::Node& node, const dsl::Output& output, BoundMode mode, dsl::Diagnostics& diagnostics) {
  const std::string operation = node.op == Op::div ? "/" : dsl::op_name(node.op);
  diagnostics.error(output.span,
                    "`" + operation + "` has no error bound in mode `" + name(mode) +
                        (node.op == Op::div ? "`, except a division by a number" : "`"),
                    "compile it with --bound float, or rewrite the output without it");
}

}  // namespace tightrope::codegen
