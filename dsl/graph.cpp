#include "dsl/graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <iterator>
#include <utility>

namespace tightrope::dsl {

int operand_count(Op op) {
  switch (op) {
    case Op::input:
    case Op::constant:
      return 0;
    case Op::neg:
    case Op::mul_pow2:
    case Op::sqrt:
    case Op::abs:
    case Op::normalizer:
      return 1;
    case Op::add:
    case Op::sub:
    case Op::mul:
    case Op::div:
    case Op::min:
    case Op::max:
    case Op::certain_nonzero:
    case Op::certain_nonnegative:
    case Op::max_magnitude:
      return 2;
    case Op::fma:
    case Op::select:
      return 3;
  }
  return 0;
}

const char* op_name(Op op) {
  switch (op) {
    case Op::input:
      return "input";
    case Op::constant:
      return "constant";
    case Op::add:
      return "add";
    case Op::sub:
      return "sub";
    case Op::neg:
      return "neg";
    case Op::mul:
      return "mul";
    case Op::mul_pow2:
      return "mul_pow2";
    case Op::div:
      return "div";
    case Op::sqrt:
      return "sqrt";
    case Op::abs:
      return "abs";
    case Op::min:
      return "min";
    case Op::max:
      return "max";
    case Op::fma:
      return "fma";
    case Op::select:
      return "select";
    case Op::normalizer:
      return "normalizer";
    case Op::max_magnitude:
      return "max_magnitude";
    case Op::certain_nonzero:
      return "certain_nonzero";
    case Op::certain_nonnegative:
      return "certain_nonnegative";
  }
  return "";
}

namespace {

bool is_commutative(Op op) { return op == Op::add || op == Op::mul || op == Op::min || op == Op::max; }

std::uint64_t hash(const Node& node) {
  std::uint64_t h = static_cast<std::uint64_t>(node.op);
  const auto mix = [&h](std::uint64_t word) {  // the finaliser of a 64-bit multiplicative hash, once a word
    h = (h ^ word) * 0x9E3779B97F4A7C15ull;
    h ^= h >> 32;
  };
  mix((std::uint64_t{static_cast<std::uint32_t>(node.a)} << 32) | static_cast<std::uint32_t>(node.b));
  mix((std::uint64_t{static_cast<std::uint32_t>(node.c)} << 32) | static_cast<std::uint32_t>(node.index));
  mix(std::bit_cast<std::uint64_t>(node.value));
  return h;
}

}  // namespace

/// Where `node` stands in the table, or the free slot where it would.
std::size_t Graph::slot_of(const Node& node) const {
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = static_cast<std::size_t>(hash(node)) & mask;
  while (table_[slot] != no_node && !(nodes_[static_cast<std::size_t>(table_[slot])] == node)) slot = (slot + 1) & mask;
  return slot;
}

void Graph::grow() {
  table_.assign(std::max<std::size_t>(64, 2 * table_.size()), no_node);
  for (NodeId id = 0; id < size(); ++id) table_[slot_of(nodes_[static_cast<std::size_t>(id)])] = id;
}

NodeId Graph::intern(const Node& wanted) {
  Node node = wanted;
  assert(node.value == node.value && "a graph holds no NaN constants");
  if (node.value == 0) node.value = 0;  // -0 is stored as +0, so that equality and hash agree
  if (is_commutative(node.op) && node.a > node.b) std::swap(node.a, node.b);
  assert(node.a < size() && node.b < size() && node.c < size() && "operands stand before their users");
  if (2 * nodes_.size() >= table_.size()) grow();
  NodeId& id = table_[slot_of(node)];
  if (id == no_node) {
    id = size();
    nodes_.push_back(node);
  }
  return id;
}

NodeId Graph::input(std::int32_t slot) { return intern({.op = Op::input, .index = slot}); }

NodeId Graph::constant(double value) { return intern({.op = Op::constant, .value = value}); }

NodeId Graph::unary(Op op, NodeId a) {
  assert(operand_count(op) == 1 && op != Op::mul_pow2);
  return intern({.op = op, .a = a});
}

NodeId Graph::binary(Op op, NodeId a, NodeId b) {
  assert(operand_count(op) == 2);
  return intern({.op = op, .a = a, .b = b});
}

NodeId Graph::mul_pow2(NodeId a, std::int32_t exponent) {
  return intern({.op = Op::mul_pow2, .a = a, .index = exponent});
}

NodeId Graph::fma(NodeId a, NodeId b, NodeId c) { return intern({.op = Op::fma, .a = a, .b = b, .c = c}); }

NodeId Graph::select(NodeId condition, NodeId if_not_negative, NodeId otherwise) {
  return intern({.op = Op::select, .a = condition, .b = if_not_negative, .c = otherwise});
}

std::string print(const Graph& graph) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (NodeId id = 0; id < graph.size(); ++id) {
    const Node& node = graph[id];
    fmt::format_to(out, "%{} = {}", id, op_name(node.op));
    if (node.op == Op::input) fmt::format_to(out, " {}", node.index);
    if (node.op == Op::constant) fmt::format_to(out, " {}", node.value);
    for (const NodeId operand : {node.a, node.b, node.c}) {
      if (operand != no_node) fmt::format_to(out, " %{}", operand);
    }
    if (node.op == Op::mul_pow2) fmt::format_to(out, " {}", node.index);
    text += '\n';
  }
  return text;
}

}  // namespace tightrope::dsl
