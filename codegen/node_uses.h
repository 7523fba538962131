#pragma once
/// How often the nodes of a predicate's graph are used.

#include <cstddef>
#include <vector>

#include "dsl/graph.h"
#include "dsl/program.h"

namespace tightrope::codegen {

/// One number a node: uses by other nodes and by outputs.
inline std::vector<int> uses_of_nodes(const dsl::Predicate& predicate) {
  std::vector<int> uses(static_cast<std::size_t>(predicate.graph.size()), 0);
  for (const dsl::Stage& stage : predicate.stages) {
    for (const dsl::Output& output : stage.outputs) {
      for (const dsl::NodeId id : output.nodes) ++uses[static_cast<std::size_t>(id)];
    }
  }
  for (dsl::NodeId id = 0; id < predicate.graph.size(); ++id) {
    const dsl::Node& n = predicate.graph[id];
    for (const dsl::NodeId operand : {n.a, n.b, n.c}) {
      if (operand != dsl::no_node) ++uses[static_cast<std::size_t>(operand)];
    }
  }
  return uses;
}

}  // namespace tightrope::codegen
