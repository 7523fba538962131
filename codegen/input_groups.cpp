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
  const auto count = static_cast<NodeId>(predicate.graph.size());
  leaf_groups_.assign(static_cast<std::size_t>(count), -1);
  std::vector<std::optional<Leaf>> leaves = find_leaves();
  const std::vector<bool> needed = needed_leaves(leaves);
  for (const bool inputs : {false, true}) {
    for (NodeId id = 0; id < count; ++id) {
      const auto i = static_cast<std::size_t>(id);
      if (!needed[i] || (graph_[id].op == Op::input) != inputs) continue;
      Leaf leaf = inputs ? input(graph_[id]) : std::move(*leaves[i]);
      const NodeId bound = leaf.group.bounded()
                               ? graph_.input(graph_[id].index + static_cast<std::int32_t>(predicate_.slots.size()))
                               : no_node;
      leaf_groups_[i] = enter(std::move(leaf.group), {id, bound}, leaf.range);
    }
  }
}

/// By node: what may be a leaf, negatives of leaves included. Of inputs only exact ones are here.
std::vector<std::optional<InputGroups::Leaf>> InputGroups::find_leaves() {
  std::vector<std::optional<Leaf>> leaves(static_cast<std::size_t>(predicate_.graph.size()));
  for (NodeId id = 0; id < predicate_.graph.size(); ++id) {
    const Node n = graph_[id];
    std::optional<Leaf>& leaf = leaves[static_cast<std::size_t>(id)];
    const auto at = [&](NodeId operand) -> const std::optional<Leaf>& {
      return leaves[static_cast<std::size_t>(operand)];
    };
    if (exact_input(id)) leaf = input(n);
    if ((n.op == Op::add || n.op == Op::sub) && exact_input(n.a) && exact_input(n.b)) leaf = difference(n);
    if (n.op == Op::neg) leaf = at(n.a);
    if (n.op == Op::select && at(n.b) && at(n.c)) leaf = selection(*at(n.b), *at(n.c));
  }
  return leaves;
}

/// Which leaves outputs are computed from, not counting those within other leaves.
std::vector<bool> InputGroups::needed_leaves(const std::vector<std::optional<Leaf>>& leaves) const {
  std::vector<bool> needed(leaves.size(), false);
  for (const auto& stage : predicate_.stages) {
    for (const auto& output : stage.outputs) {
      for (const NodeId id : output.nodes) needed[static_cast<std::size_t>(id)] = true;
    }
  }
  for (auto id = static_cast<NodeId>(leaves.size()) - 1; id >= 0; --id) {
    const auto i = static_cast<std::size_t>(id);
    const Node& n = graph_[id];
    if (!needed[i] || n.op == Op::input || (leaves[i] && n.op != Op::neg)) continue;
    needed[i] = false;
    for (const NodeId operand : {n.op == Op::select ? no_node : n.a, n.b, n.c}) {
      if (operand != no_node) needed[static_cast<std::size_t>(operand)] = true;
    }
  }
  return needed;
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
  if (wanted.kind == InputGroup::Kind::selected) {
    auto vector = std::find(selected_vectors_.begin(), selected_vectors_.end(), wanted.inputs);
    if (vector == selected_vectors_.end()) vector = selected_vectors_.insert(vector, wanted.inputs);
    wanted.name.insert(1, std::to_string(vector - selected_vectors_.begin() + 1));
  } else {
    wanted.inputs.clear();
  }
  if (wanted.list >= 0) wanted.name += "_group_" + std::to_string(wanted.list + 1);
  auto group = std::find_if(groups_.begin(), groups_.end(), [&](const InputGroup& g) {
    return g.kind == wanted.kind && g.index == wanted.index && g.list == wanted.list &&
           g.displacements == wanted.displacements && g.inputs == wanted.inputs;
  });
  const bool normalized = wanted.normalized;
  if (group == groups_.end()) group = groups_.insert(groups_.end(), std::move(wanted));
  group->members.push_back(member);
  group->range = std::max(group->range, range);
  group->normalized = group->normalized || normalized;
  return static_cast<int>(group - groups_.begin());
}

InputGroups::Leaf InputGroups::input(const Node& n) {
  const dsl::Parameter& p = parameter_of(n);
  const dsl::Slot& slot = slot_of(n);
  InputGroup group;
  if (p.bounded) {
    group.kind = InputGroup::Kind::bounded;
    group.index = slot.parameter;
    group.name = p.name;
    return {std::move(group), range_of(n)};
  }
  group.list = list_of(slot.parameter);
  group.inputs = {slot.parameter, slot.element};
  group.normalized = p.normalized >= 0;
  const bool scalar = p.dimension == 1;
  group.kind = scalar ? InputGroup::Kind::scalar : InputGroup::Kind::vectors;
  group.index = !scalar ? slot.component : group.list >= 0 ? -1 : slot.parameter;  // a list's scalars are one group
  group.name = !scalar ? std::string("v_") + axis_names[slot.component] : group.list >= 0 ? "b" : p.name;
  return {std::move(group), range_of(n)};
}

InputGroups::Leaf InputGroups::difference(const Node& n) const {
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
  group.inputs = {sx.parameter, sx.element, sy.parameter, sy.element};
  group.normalized = parameter_of(x).normalized >= 0 || parameter_of(y).normalized >= 0;
  group.name = group.displacements ? "s" : "d";
  if (one_axis) group.name += std::string("_") + axis_names[sx.component];
  return {std::move(group), (range_of(x) + range_of(y)) * (1 + 0x1p-10)};
}

InputGroups::Leaf InputGroups::selection(const Leaf& first, const Leaf& second) const {
  const auto axis = [](const InputGroup& g) { return g.kind == InputGroup::Kind::scalar ? -1 : g.index; };
  InputGroup group;
  group.kind = InputGroup::Kind::selected;
  group.index = axis(first.group) == axis(second.group) ? axis(first.group) : -1;
  group.list = first.group.list == second.group.list ? first.group.list : -1;
  group.normalized = first.group.normalized || second.group.normalized;
  group.inputs = first.group.inputs;
  group.inputs.insert(group.inputs.end(), second.group.inputs.begin(), second.group.inputs.end());
  group.displacements = first.group.displacements && second.group.displacements;
  group.name = group.index >= 0 ? std::string("c_") + axis_names[group.index] : "c";
  return {std::move(group), std::max(first.range, second.range)};
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
