#include "codegen/normalize.h"

#include <algorithm>
#include <map>

namespace tightrope::codegen {

using dsl::no_node;
using dsl::Node;
using dsl::NodeId;
using dsl::Op;

bool has_normalized_inputs(const dsl::Predicate& predicate) {
  return std::any_of(predicate.parameters.begin(), predicate.parameters.end(),
                     [](const dsl::Parameter& p) { return p.normalized >= 0; });
}

dsl::Predicate with_normalized_ranges(const dsl::Predicate& predicate) {
  dsl::Predicate result = predicate;
  for (dsl::Parameter& p : result.parameters) {
    if (p.normalized >= 0) p.range = 1;
  }
  return result;
}

namespace {

/// By group the power of two: of all its inputs, whether an output needs them or not.
std::map<int, NodeId> scales(const dsl::Predicate& predicate, dsl::Graph& graph) {
  std::map<int, NodeId> result;
  for (std::size_t i = 0; i < predicate.slots.size(); ++i) {
    const int group = predicate.parameters[static_cast<std::size_t>(predicate.slots[i].parameter)].normalized;
    if (group < 0) continue;
    const NodeId magnitude = graph.abs(graph.input(static_cast<std::int32_t>(i)));
    const auto [largest, first] = result.try_emplace(group, magnitude);
    if (!first) largest->second = graph.binary(Op::max_magnitude, largest->second, magnitude);
  }
  for (auto& [group, largest] : result) largest = graph.unary(Op::normalizer, largest);
  return result;
}

}  // namespace

void normalize_inputs(const dsl::Predicate& predicate, BoundedPredicate& bounded) {
  if (!has_normalized_inputs(predicate)) return;
  dsl::Graph graph;
  const std::map<int, NodeId> scale = scales(predicate, graph);
  std::vector<NodeId> image;
  const auto at = [&](NodeId id) { return id == no_node ? no_node : image[static_cast<std::size_t>(id)]; };
  for (NodeId id = 0; id < bounded.graph.size(); ++id) {
    const Node& n = bounded.graph[id];
    NodeId made = graph.intern({n.op, at(n.a), at(n.b), at(n.c), n.index, n.value});
    if (n.op == Op::input && static_cast<std::size_t>(n.index) < predicate.slots.size()) {
      const dsl::Slot& slot = predicate.slots[static_cast<std::size_t>(n.index)];
      const auto found = scale.find(predicate.parameters[static_cast<std::size_t>(slot.parameter)].normalized);
      if (found != scale.end()) made = graph.mul(made, found->second);
    }
    image.push_back(made);
  }
  for (BoundedStage& stage : bounded.stages) {
    for (OutputBound& output : stage.outputs) {
      output.assumption = output.assumption.empty() ? "" : "inputs normalized, or within their declared ranges";
      for (BoundedNode& element : output.elements) element = {at(element.value), at(element.bound)};
    }
  }
  bounded.graph = std::move(graph);
}

}  // namespace tightrope::codegen
