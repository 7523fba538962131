#pragma once
/// The scalar graph: a flat arena of small value nodes, hash-consed on construction, operands before users.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tightrope::dsl {

using NodeId = std::int32_t;
inline constexpr NodeId no_node = -1;

enum class Op : std::uint8_t {
  input,                ///< input slot `index`
  constant,             ///< `value`, exact
  add,                  ///< a + b
  sub,                  ///< a - b
  neg,                  ///< -a, exact
  mul,                  ///< a * b
  mul_pow2,             ///< a * 2^index, exact but for underflow and overflow
  div,                  ///< a / b
  sqrt,                 ///< sqrt(a)
  abs,                  ///< |a|, exact
  min,                  ///< exact; NaN if an operand is NaN
  max,                  ///< exact; NaN if an operand is NaN
  fma,                  ///< a * b + c, rounded once
  select,               ///< b if a >= 0, else (a NaN, too) c: `either`, a choice between equal alternatives (either.h)
  normalizer,           ///< the power of two that brings the magnitude a below 1, or NaN (codegen/normalize.h)
  certain_nonzero,      ///< a if |a| > b, else NaN: the divisor of a quotient, b its error bound (bounds only)
  certain_nonnegative,  ///< a if a >= b, else NaN: the radicand of a root, b its error bound (bounds only)
  max_magnitude,  ///< max(a, b) of non-negative numbers, may ignore a NaN in b (bounds and sizes of alternatives only)
};

struct Node {
  Op op = Op::constant;
  NodeId a = no_node, b = no_node, c = no_node;
  std::int32_t index = 0;                        ///< input: the slot; mul_pow2: the exponent
  double value = 0;                              ///< constant
  bool operator==(const Node&) const = default;  // note: Graph never stores NaN constants; -0 is stored as +0
};

int operand_count(Op op);
const char* op_name(Op op);

/// Hash-consed arena. The constructors fold nothing and rewrite nothing but the order of the operands of add, mul,
/// min, max (commutative in floating point, so a + b and b + a are one node).
class Graph {
 public:
  NodeId input(std::int32_t slot);
  NodeId constant(double value);
  NodeId unary(Op op, NodeId a);
  NodeId binary(Op op, NodeId a, NodeId b);
  NodeId mul_pow2(NodeId a, std::int32_t exponent);
  NodeId fma(NodeId a, NodeId b, NodeId c);
  NodeId select(NodeId condition, NodeId if_not_negative, NodeId otherwise);
  NodeId add(NodeId a, NodeId b) { return binary(Op::add, a, b); }
  NodeId sub(NodeId a, NodeId b) { return binary(Op::sub, a, b); }
  NodeId mul(NodeId a, NodeId b) { return binary(Op::mul, a, b); }
  NodeId neg(NodeId a) { return unary(Op::neg, a); }
  NodeId abs(NodeId a) { return unary(Op::abs, a); }
  /// Any node, operands already in this graph.
  NodeId intern(const Node& node);

  const Node& operator[](NodeId id) const { return nodes_[static_cast<std::size_t>(id)]; }
  NodeId size() const { return static_cast<NodeId>(nodes_.size()); }

 private:
  std::size_t slot_of(const Node& node) const;
  void grow();

  std::vector<Node> nodes_;
  std::vector<NodeId> table_;  ///< open addressing, a power of two of slots at most half full; no_node: free
};

/// One line a node, "%7 = mul %3 %5"; the text that tests compare.
std::string print(const Graph& graph);

}  // namespace tightrope::dsl
