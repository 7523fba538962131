#include "codegen/explore/sums.h"

#include "codegen/node_uses.h"
#include "codegen/simplify.h"

namespace tightrope::codegen::explore {
namespace {

using dsl::Graph;
using dsl::no_node;
using dsl::Node;
using dsl::NodeId;
using dsl::Op;

class Resummation {
 public:
  Resummation(const dsl::Predicate& predicate, const Summation& summation)
      : predicate_(predicate), graph_(predicate.graph), summation_(summation), uses_(uses_of_nodes(predicate)) {}

  dsl::Predicate run() {
    const std::vector<bool> absorbed = absorbed_nodes();
    for (NodeId id = 0; id < graph_.size(); ++id) {
      const Node& n = graph_[id];
      if (is_sum(n) && !absorbed[static_cast<std::size_t>(id)] && !is_difference_of_inputs(n)) {
        const Term total = summation_(out_, terms(id));
        image_.push_back(total.negative ? out_.neg(total.node) : total.node);
      } else {
        image_.push_back(out_.intern({n.op, at(n.a), at(n.b), at(n.c), n.index, n.value}));
      }
    }
    dsl::Predicate result = predicate_;
    for (dsl::Stage& stage : result.stages) {
      for (dsl::Output& output : stage.outputs) {
        for (NodeId& id : output.nodes) id = at(id);
      }
    }
    result.graph = std::move(out_);
    return simplify(result);  // leaves the sums behind that were taken apart
  }

 private:
  static bool is_sum(const Node& n) { return n.op == Op::add || n.op == Op::sub; }
  bool is_difference_of_inputs(const Node& n) const {
    return n.op == Op::sub && graph_[n.a].op == Op::input && graph_[n.b].op == Op::input;
  }
  NodeId at(NodeId id) const { return id == no_node ? no_node : image_[static_cast<std::size_t>(id)]; }

  /// Whether `id`, an operand of a sum, is taken apart.
  bool opens(NodeId id) const {
    const Node& n = graph_[id];
    return uses_[static_cast<std::size_t>(id)] == 1 && (is_sum(n) || n.op == Op::neg) && !is_difference_of_inputs(n);
  }

  /// Nodes that stand within a larger sum alone.
  std::vector<bool> absorbed_nodes() const {
    std::vector<bool> absorbed(static_cast<std::size_t>(graph_.size()), false);
    for (NodeId id = graph_.size() - 1; id >= 0; --id) {
      const Node& n = graph_[id];
      const bool within = n.op == Op::neg && absorbed[static_cast<std::size_t>(id)];
      if (!within && (!is_sum(n) || is_difference_of_inputs(n))) continue;
      for (const NodeId operand : {n.a, n.b}) {
        if (operand != no_node && opens(operand)) absorbed[static_cast<std::size_t>(operand)] = true;
      }
    }
    return absorbed;
  }

  /// The terms of the sum `root`, as nodes of the new graph. A stack of what is still to be taken apart, the next on
  /// top: sums may be longer than the call stack.
  std::vector<Term> terms(NodeId root) const {
    std::vector<Term> result;
    std::vector<Term> stack = {{root, false}};
    while (!stack.empty()) {
      const Term top = stack.back();
      stack.pop_back();
      const Node& n = graph_[top.node];
      if (top.node != root && !opens(top.node)) {
        const bool product = n.op == Op::mul && uses_[static_cast<std::size_t>(top.node)] == 1;
        result.push_back({at(top.node), top.negative, product});
        continue;
      }
      // The graph keeps no order of the operands of `add`: what was summed before stands first.
      const bool swapped = n.op == Op::add && opens(n.b) && !opens(n.a);
      if (n.op != Op::neg) stack.push_back({swapped ? n.a : n.b, top.negative != (n.op == Op::sub)});
      stack.push_back({swapped ? n.b : n.a, top.negative != (n.op == Op::neg)});
    }
    return result;
  }

  const dsl::Predicate& predicate_;
  const Graph& graph_;
  const Summation& summation_;
  std::vector<int> uses_;
  std::vector<NodeId> image_;
  Graph out_;
};

}  // namespace

dsl::Predicate with_sums(const dsl::Predicate& predicate, const Summation& summation) {
  const dsl::Predicate simple = simplify(predicate);
  return Resummation(simple, summation).run();
}

Term sum(Graph& graph, const Term& a, const Term& b) {
  if (a.negative == b.negative) return {graph.add(a.node, b.node), a.negative};
  return {a.negative ? graph.sub(b.node, a.node) : graph.sub(a.node, b.node), false};
}

}  // namespace tightrope::codegen::explore
