#include "codegen/schedule.h"

#include <algorithm>
#include <array>

namespace tightrope::codegen {
namespace {

using dsl::Graph;
using dsl::no_node;
using dsl::Node;
using dsl::NodeId;
using dsl::Op;

bool is_leaf(const Node& node) { return node.op == Op::input || node.op == Op::constant; }

/// Registers that evaluating each node takes if nothing were shared: operands that need the same number cost one more.
std::vector<int> register_need(const Graph& graph) {
  std::vector<int> need(static_cast<std::size_t>(graph.size()), 0);
  for (NodeId id = 0; id < graph.size(); ++id) {
    const Node& node = graph[id];
    if (is_leaf(node)) continue;
    std::array<int, 3> operands = {0, 0, 0};
    const std::array<NodeId, 3> ids = {node.a, node.b, node.c};
    for (std::size_t i = 0; i < 3; ++i) {
      if (ids[i] != no_node) operands[i] = need[static_cast<std::size_t>(ids[i])];
    }
    std::sort(operands.begin(), operands.end(), std::greater<>());
    // The i-th heaviest is evaluated while i results are held.
    need[static_cast<std::size_t>(id)] = std::max({1, operands[0], operands[1] + 1, operands[2] + 2});
    if (operands[1] == 0) need[static_cast<std::size_t>(id)] = std::max(1, operands[0]);
  }
  return need;
}

class Scheduler {
 public:
  explicit Scheduler(const BoundedPredicate& predicate)
      : graph_(predicate.graph),
        need_(register_need(graph_)),
        computed_in_(static_cast<std::size_t>(graph_.size()), none),
        available_in_(static_cast<std::size_t>(graph_.size()), none),
        recomputes_(predicate.recomputes) {
    result_.saved.assign(static_cast<std::size_t>(graph_.size()), false);
    for (const BoundedStage& stage : predicate.stages) add_stage(stage);
  }

  Schedule take() { return std::move(result_); }

 private:
  static constexpr int none = -1;

  void add_stage(const BoundedStage& stage) {
    result_.stages.emplace_back();
    for (std::size_t o = 0; o < stage.outputs.size(); ++o) {
      const std::vector<BoundedNode>& elements = stage.outputs[o].elements;
      for (std::size_t e = 0; e < elements.size(); ++e) {
        if (elements[e].bound != no_node) visit(elements[e].bound);
        visit(elements[e].value);
        steps().push_back({Step::Kind::output, elements[e].value, static_cast<int>(o), static_cast<int>(e)});
      }
    }
  }

  std::vector<Step>& steps() { return result_.stages.back().steps; }
  int stage() const { return static_cast<int>(result_.stages.size()) - 1; }

  /// Whether this stage can use `id` now; loads it if an earlier stage computed it.
  bool available(NodeId id) {
    const auto i = static_cast<std::size_t>(id);
    if (is_leaf(graph_[id]) || available_in_[i] == stage()) return true;
    if (computed_in_[i] == none || recomputes_) return false;
    result_.saved[i] = true;
    available_in_[i] = stage();
    steps().push_back({Step::Kind::load, id, 0, 0});
    return true;
  }

  /// Operands of `id`, the heaviest first, as they stand among equals.
  std::array<NodeId, 3> operands(NodeId id) const {
    const Node& node = graph_[id];
    std::array<NodeId, 3> ids = {node.a, node.b, node.c};
    std::stable_sort(ids.begin(), ids.end(), [&](NodeId x, NodeId y) { return weight(x) > weight(y); });
    return ids;
  }
  int weight(NodeId id) const { return id == no_node ? -1 : need_[static_cast<std::size_t>(id)]; }

  /// Depth first with a stack of its own: graphs may be deeper than the call stack.
  void visit(NodeId root) {
    struct Frame {
      NodeId node;
      std::array<NodeId, 3> operands;
      std::size_t next = 0;
    };
    if (available(root)) return;
    std::vector<Frame> stack = {{root, operands(root)}};
    while (!stack.empty()) {
      Frame& top = stack.back();
      if (top.next < top.operands.size()) {
        const NodeId operand = top.operands[top.next++];
        if (operand != no_node && !available(operand)) stack.push_back({operand, operands(operand)});
        continue;
      }
      const auto i = static_cast<std::size_t>(top.node);
      computed_in_[i] = available_in_[i] = stage();
      steps().push_back({Step::Kind::compute, top.node, 0, 0});
      stack.pop_back();
    }
  }

  const Graph& graph_;
  std::vector<int> need_;
  std::vector<int> computed_in_;   ///< the stage that computes a node
  std::vector<int> available_in_;  ///< the last stage that computed or loaded it
  bool recomputes_;
  Schedule result_;
};

}  // namespace

Schedule schedule(const BoundedPredicate& predicate) { return Scheduler(predicate).take(); }

}  // namespace tightrope::codegen
