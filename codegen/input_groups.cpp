#include "codegen/input_groups.h"

#include <algorithm>
#include <cmath>

namespace tightrope::codegen {

using dsl::no_node;
using dsl::Node;
using dsl::NodeId;
using dsl::Op;

namespace {
constexpr const char* axis_names[] = {"x", "y", "z"};
}

InputGroups::InputGroups(const dsl::Predicate& predicate, bool one_group, dsl::Graph& graph)
    : predicate_(predicate), one_group_(one_group), graph_(graph) {
  const NodeId count = predicate.graph.size();
  leaf_groups_.assign(static_cast<std::size_t>(count), -1);
  const auto exact_input = [&](NodeId id) { return graph_[id].op == Op::input && !parameter_of(graph_[id]).bounded; };
  std::vector<bool> used_directly(static_cast<std::size_t>(count), false);
  for (const auto& stage : predicate.stages) {
    for (const auto& output : stage.outputs) {
      for (const NodeId id : output.nodes) used_directly[static_cast<std::size_t>(id)] = true;
    }
  }
  for (NodeId id = 0; id < count; ++id) {
    const Node n = graph_[id];
    if ((n.op == Op::add || n.op == Op::sub) && exact_input(n.a) && exact_input(n.b)) {
      leaf_groups_[static_cast<std::size_t>(id)] = enter_difference(n, id);
      continue;
    }
    for (const NodeId operand : {n.a, n.b, n.c}) {
      if (operand != no_node) used_directly[static_cast<std::size_t>(operand)] = true;
    }
  }
  for (NodeId id = 0; id < count; ++id) {
    const Node n = graph_[id];
    if (n.op == Op::input && used_directly[static_cast<std::size_t>(id)]) {
      leaf_groups_[static_cast<std::size_t>(id)] = enter_input(n, id);
    }
  }
}

double InputGroups::range_of(const Node& n) const {
  const dsl::Parameter& p = parameter_of(n);
  return p.range.value_or(INFINITY) * (p.bounded ? 2 : 1);
}

/// Groups are told apart by kind and index: a name may be that of two (a parameter may be called d_x).
int InputGroups::enter(InputGroup::Kind kind, int index, std::string name, GroupMember member, double range) {
  if (one_group_ && kind != InputGroup::Kind::bounded) {
    kind = InputGroup::Kind::all;
    index = 0;
    name = "b";
  }
  auto group = std::find_if(groups_.begin(), groups_.end(),
                            [&](const InputGroup& g) { return g.kind == kind && g.index == index; });
  if (group == groups_.end()) {
    groups_.emplace_back();
    group = groups_.end() - 1;
    group->kind = kind;
    group->index = index;
    group->name = std::move(name);
  }
  group->members.push_back(member);
  group->range = std::max(group->range, range);
  return static_cast<int>(group - groups_.begin());
}

int InputGroups::enter_input(const Node& n, NodeId id) {
  const dsl::Parameter& p = parameter_of(n);
  const dsl::Slot& slot = slot_of(n);
  if (p.bounded) {
    const NodeId bound = graph_.input(n.index + static_cast<std::int32_t>(predicate_.slots.size()));
    return enter(InputGroup::Kind::bounded, slot.parameter, p.name, {id, bound}, range_of(n));
  }
  if (p.dimension == 1) return enter(InputGroup::Kind::scalar, slot.parameter, p.name, {id, no_node}, range_of(n));
  const std::string name = std::string("v_") + axis_names[slot.component];
  return enter(InputGroup::Kind::vectors, slot.component, name, {id, no_node}, range_of(n));
}

int InputGroups::enter_difference(const Node& n, NodeId id) {
  const Node& x = graph_[n.a];
  const Node& y = graph_[n.b];
  const int axis = slot_of(x).component;
  const bool one_axis = axis == slot_of(y).component && parameter_of(x).dimension > 1 && parameter_of(y).dimension > 1;
  const double range = (range_of(x) + range_of(y)) * (1 + 0x1p-10);
  return enter(InputGroup::Kind::differences, one_axis ? axis : -1,
               one_axis ? std::string("d_") + axis_names[axis] : "d", {id, no_node}, range);
}

int InputGroups::enter_computed(const std::string& name, NodeId value, NodeId bound) {
  const int index = static_cast<int>(predicate_.parameters.size()) + computed_++;
  return enter(InputGroup::Kind::bounded, index, name + "_" + std::to_string(computed_), {value, bound}, INFINITY);
}

std::vector<std::string> InputGroups::names() const {
  std::vector<std::string> result;
  for (const InputGroup& g : groups_) result.push_back(g.name);
  return result;
}

std::vector<double> InputGroups::ranges() const {
  std::vector<double> result;
  for (const InputGroup& g : groups_) result.push_back(g.range);
  return result;
}

/// A NaN member may get lost here (never the members before it): whatever is computed from the NaN input is NaN itself
/// and has no sign, and no other bound needs it.
NodeId InputGroups::maximum(int group, BoundExpressions& r) {
  InputGroup& g = groups_[static_cast<std::size_t>(group)];
  if (g.maximum != no_node) return g.maximum;
  for (const GroupMember& member : g.members) {
    const NodeId size = r.plus(graph_.abs(member.value), member.bound);
    g.maximum = g.maximum == no_node ? size : r.larger(g.maximum, size);
  }
  return g.maximum;
}

/// A NaN among the bounds must not get lost, its value may be a number.
NodeId InputGroups::relative_bound(int group, BoundExpressions& r) {
  InputGroup& g = groups_[static_cast<std::size_t>(group)];
  if (g.relative_bound != no_node) return g.relative_bound;
  NodeId bound = no_node;
  for (const GroupMember& member : g.members) {
    bound = bound == no_node ? member.bound : r.maximum(bound, member.bound);
  }
  g.relative_bound = r.quotient(bound, r.larger(maximum(group, r), r.least()));
  return g.relative_bound;
}

NodeId InputGroups::overall_maximum(BoundExpressions& r) {
  if (overall_maximum_ == no_node) overall_maximum_ = r.constant(1);
  for (int& g = groups_in_overall_maximum_; g < size(); ++g) {
    overall_maximum_ = r.larger(overall_maximum_, maximum(g, r));
  }
  return overall_maximum_;
}

}  // namespace tightrope::codegen
