#include "codegen/count.h"

#include <fmt/format.h>

namespace tightrope::codegen {
namespace {

using dsl::NodeId;
using dsl::Op;

/// The nodes that `needed` nodes depend on, themselves included.
void close_over_operands(const dsl::Graph& graph, std::vector<bool>& needed) {
  for (NodeId id = graph.size() - 1; id >= 0; --id) {
    if (!needed[static_cast<std::size_t>(id)]) continue;
    for (const NodeId operand : {graph[id].a, graph[id].b, graph[id].c}) {
      if (operand != dsl::no_node) needed[static_cast<std::size_t>(operand)] = true;
    }
  }
}

}  // namespace

void OperationCount::add(Op op) {
  switch (op) {
    case Op::input:
    case Op::constant:
      break;
    case Op::add:
    case Op::sub:
      ++sums;
      break;
    case Op::mul:
      ++products;
      break;
    case Op::fma:
      ++sums, ++products;
      break;
    case Op::div:
    case Op::sqrt:
      ++divisions;
      break;
    case Op::min:
    case Op::max:
    case Op::certain_nonzero:
    case Op::certain_nonnegative:
    case Op::normalizer:
    case Op::max_magnitude:
    case Op::select:
      ++comparisons;
      break;
    case Op::neg:
    case Op::mul_pow2:
    case Op::abs:
      ++exact;
      break;
  }
}

std::vector<Cost> stage_costs(const BoundedPredicate& predicate, const Schedule& schedule) {
  std::vector<bool> value(static_cast<std::size_t>(predicate.graph.size()), false);
  for (const BoundedStage& stage : predicate.stages) {
    for (const OutputBound& output : stage.outputs) {
      for (const BoundedNode& element : output.elements) value[static_cast<std::size_t>(element.value)] = true;
    }
  }
  close_over_operands(predicate.graph, value);
  std::vector<Cost> costs;
  for (const StageSchedule& stage : schedule.stages) {
    Cost& cost = costs.emplace_back();
    for (const Step& step : stage.steps) {
      if (step.kind != Step::Kind::compute) continue;
      (value[static_cast<std::size_t>(step.node)] ? cost.value : cost.bound).add(predicate.graph[step.node].op);
    }
  }
  return costs;
}

Cost output_cost(const BoundedPredicate& predicate, const OutputBound& output) {
  const auto size = static_cast<std::size_t>(predicate.graph.size());
  std::vector<bool> value(size, false);
  std::vector<bool> bound(size, false);
  for (const BoundedNode& element : output.elements) {
    value[static_cast<std::size_t>(element.value)] = true;
    if (element.bound != dsl::no_node) bound[static_cast<std::size_t>(element.bound)] = true;
  }
  close_over_operands(predicate.graph, value);
  close_over_operands(predicate.graph, bound);
  Cost cost;
  for (NodeId id = 0; id < predicate.graph.size(); ++id) {
    const auto i = static_cast<std::size_t>(id);
    if (value[i]) {
      cost.value.add(predicate.graph[id].op);
    } else if (bound[i]) {
      cost.bound.add(predicate.graph[id].op);
    }
  }
  return cost;
}

std::string text(const OperationCount& count) {
  std::string parts;
  const auto append = [&](int number, std::string_view singular, std::string_view plural) {
    if (number == 0) return;
    parts += fmt::format("{}{} {}", parts.empty() ? "" : ", ", number, number == 1 ? singular : plural);
  };
  append(count.sums, "sum", "sums");
  append(count.products, "product", "products");
  append(count.divisions, "division", "divisions");
  append(count.comparisons, "comparison", "comparisons");
  append(count.exact, "exact", "exact");
  return parts.empty() ? "0" : fmt::format("{} ({})", count.total(), parts);
}

}  // namespace tightrope::codegen
