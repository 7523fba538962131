#include "codegen/clang/canonical_graph.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace tightrope::codegen {

using dsl::no_node;
using dsl::Node;
using dsl::NodeId;
using dsl::Op;

namespace {

/// k if the node is the constant 2^k.
std::optional<int> power_of_two(const Node& node) {
  if (node.op != Op::constant || !(node.value > 0) || std::isinf(node.value)) return std::nullopt;
  int exponent = 0;
  if (std::frexp(node.value, &exponent) != 0.5) return std::nullopt;
  return exponent - 1;
}

}  // namespace

CanonicalGraph::CanonicalGraph(const dsl::Graph& analysed, int significand_bits) : significand_bits_(significand_bits) {
  const auto mapped = [&](NodeId id) { return id == no_node ? no_node : canonical_[static_cast<std::size_t>(id)]; };
  for (NodeId id = 0; id < analysed.size(); ++id) {
    Node node = analysed[id];
    node.a = mapped(node.a), node.b = mapped(node.b), node.c = mapped(node.c);
    canonical_.push_back(intern(node));
  }
  analysed_.assign(static_cast<std::size_t>(graph_.size()), false);
  for (const NodeId id : canonical_) analysed_[static_cast<std::size_t>(id)] = true;
}

NodeId CanonicalGraph::intern(Node node) {
  if (node.op == Op::neg && graph_[node.a].op == Op::constant && graph_[node.a].value != 0) {
    return graph_.constant(-graph_[node.a].value);
  }
  if (node.op == Op::mul_pow2) return scaled(node.a, node.index);
  if (node.op == Op::mul) {
    const std::optional<int> a = power_of_two(graph_[node.a]);
    const std::optional<int> b = power_of_two(graph_[node.b]);
    if (b && !(a && *a > *b)) return scaled(node.a, *b);  // of two powers the larger is the factor
    if (a) return scaled(node.b, *a);
  }
  return graph_.intern(node);
}

NodeId CanonicalGraph::scaled(NodeId operand, std::int32_t exponent) {
  const Node& inner = graph_[operand];
  if (inner.op == Op::mul_pow2) {
    const bool exact = inner.index > 0 && exponent > 0;
    const bool vanishing = inner.index < 0 && exponent <= -significand_bits_;
    if (exact || vanishing) return graph_.mul_pow2(inner.a, inner.index + exponent);
  }
  return graph_.mul_pow2(operand, exponent);
}

std::string CanonicalGraph::describe(NodeId id, int depth) const {
  const Node& node = graph_[id];
  if (node.op == Op::input) return fmt::format("input {}", node.index);
  if (node.op == Op::constant) return fmt::format("{:a}", node.value);
  if (depth == 0) return "...";
  std::string text = dsl::op_name(node.op);
  const char* separator = "(";
  for (const NodeId operand : {node.a, node.b, node.c}) {
    if (operand == no_node) continue;
    text += separator + describe(operand, depth - 1);
    separator = ", ";
  }
  if (node.op == Op::mul_pow2) text += fmt::format(", {}", node.index);
  return text + ")";
}

}  // namespace tightrope::codegen
