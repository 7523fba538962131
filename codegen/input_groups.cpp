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

int InputGroups::list_of(int parameter) const {
  const auto& lists = predicate_.grouping.lists;
  for (std::size_t i = 0; i < lists.size(); ++i) {
    if (std::find(lists[i].begin(), lists[i].end(), parameter) != lists[i].end()) return static_cast<int>(i);
  }
  return -1;
}

/// Groups are told apart by what they hold: a name may be that of two (a parameter may be called d_x).
int InputGroups::enter(InputGroup wanted, GroupMember member, double range) {
  if (!wanted.bounded() && (one_group_ || predicate_.grouping.all)) {
    wanted.kind = InputGroup::Kind::all;
    wanted.index = 0;
    wanted.name = wanted.displacements ? "s" : "b";
  }
  if (one_group_ && !wanted.bounded()) {
    wanted.list = -1;
    wanted.displacements = false;
    wanted.name = "b";
  }
  if (wanted.list >= 0) wanted.name += "_group_" + std::to_string(wanted.list + 1);
  auto group = std::find_if(groups_.begin(), groups_.end(), [&](const InputGroup& g) {
    return g.kind == wanted.kind && g.index == wanted.index && g.list == wanted.list &&
           g.displacements == wanted.displacements;
  });
  if (group == groups_.end()) group = groups_.insert(groups_.end(), std::move(wanted));
  group->members.push_back(member);
  group->range = std::max(group->range, range);
  return static_cast<int>(group - groups_.begin());
}

int InputGroups::enter_input(const Node& n, NodeId id) {
  const dsl::Parameter& p = parameter_of(n);
  const dsl::Slot& slot = slot_of(n);
  InputGroup group;
  if (p.bounded) {
    const NodeId bound = graph_.input(n.index + static_cast<std::int32_t>(predicate_.slots.size()));
    group.kind = InputGroup::Kind::bounded;
    group.index = slot.parameter;
    group.name = p.name;
    return enter(std::move(group), {id, bound}, range_of(n));
  }
  group.list = list_of(slot.parameter);
  const bool scalar = p.dimension == 1;
  group.kind = scalar ? InputGroup::Kind::scalar : InputGroup::Kind::vectors;
  group.index = !scalar ? slot.component : group.list >= 0 ? -1 : slot.parameter;  // a list's scalars are one group
  group.name = !scalar ? std::string("v_") + axis_names[slot.component] : group.list >= 0 ? "b" : p.name;
  return enter(std::move(group), {id, no_node}, range_of(n));
}

int InputGroups::enter_difference(const Node& n, NodeId id) {
  const Node& x = graph_[n.a];
  const Node& y = graph_[n.b];
  const dsl::Slot& sx = slot_of(x);
  const dsl::Slot& sy = slot_of(y);
  const bool one_axis = sx.component == sy.component && parameter_of(x).dimension > 1 && parameter_of(y).dimension > 1;
  InputGroup group;
  group.kind = InputGroup::Kind::differences;
  group.index = one_axis ? sx.component : -1;
  group.list = list_of(sx.parameter) == list_of(sy.parameter) ? list_of(sx.parameter) : -1;
  group.displacements = predicate_.grouping.displacements && sx.parameter == sy.parameter && sx.element == sy.element &&
                        sx.component == sy.component && sx.time != sy.time;
  group.name = group.displacements ? "s" : "d";
  if (one_axis) group.name += std::string("_") + axis_names[sx.component];
  const double range = (range_of(x) + range_of(y)) * (1 + 0x1p-10);
  return enter(std::move(group), {id, no_node}, range);
}

int InputGroups::enter_computed(const std::string& name, NodeId value, NodeId bound) {
  InputGroup group;
  group.kind = InputGroup::Kind::bounded;
  group.index = static_cast<int>(predicate_.parameters.size()) + computed_++;
  group.name = name + "_" + std::to_string(computed_);
  return enter(std::move(group), {value, bound}, INFINITY);
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
