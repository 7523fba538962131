#pragma once
/// The groups of inputs that share one run-time maximum in SafeBound (safe_bound.h), and their maxima as nodes.

#include <optional>
#include <string>
#include <vector>

#include "codegen/bound_expression.h"

namespace tightrope::codegen {

/// One value of a group: an exact input, a rounded sum or difference of two, or a bounded input with its bound.
struct GroupMember {
  dsl::NodeId value = dsl::no_node;
  dsl::NodeId bound = dsl::no_node;  ///< bounded inputs only
};

struct InputGroup {
  enum class Kind { differences, vectors, scalar, bounded, selected, all } kind = Kind::all;
  int index = 0;  ///< differences, vectors, selected: the axis (-1: not along one axis); scalar, bounded: the
                  ///< parameter, or a number beyond
  int list = -1;  ///< of `group (a, b), (c)`: the list that all its inputs are in, or -1
  bool displacements = false;  ///< of `group displacements`: differences of one input at two times
  std::vector<int> inputs;     ///< selected: the parameters (and elements) that the vectors to select from are made of
  std::string name;            ///< for people: "d_x"
  std::vector<GroupMember> members;
  bool normalized = false;  ///< some of its inputs are (normalize.h)
  double range = 0;         ///< no exact member exceeds it, by the declared ranges; else infinity
  dsl::NodeId maximum = dsl::no_node;
  dsl::NodeId relative_bound = dsl::no_node;
  bool bounded() const { return kind == Kind::bounded; }
};

/// Sorts what a predicate's polynomials are made of into groups, as its `group` statement says. `one_group`: all exact
/// leaves share one maximum.
class InputGroups {
 public:
  InputGroups(const dsl::Predicate& predicate, bool one_group, dsl::Graph& graph);

  int size() const { return static_cast<int>(groups_.size()); }
  const InputGroup& operator[](int group) const { return groups_[static_cast<std::size_t>(group)]; }
  /// The group of a node if it is a leaf, else -1. Leaves: sums and differences of two exact inputs, and inputs that
  /// are used in any other way; selections among these (and their negatives): each selected vector has groups of its
  /// own, with the maximum of the values taken, and those not taken need not be in any.
  int of(dsl::NodeId id) const { return leaf_groups_[static_cast<std::size_t>(id)]; }
  std::vector<std::string> names() const;
  std::vector<double> ranges() const;

  /// Makes a bounded group of a computed value with a bound of its own (a quotient or a root); returns its number.
  int enter_computed(const std::string& name, dsl::NodeId value, dsl::NodeId bound);

  /// max |member|, of a bounded group max(|value| + bound).
  dsl::NodeId maximum(int group, BoundExpressions& r);
  /// rho = max(bound) / maximum; 0 if that is 0.
  dsl::NodeId relative_bound(int group, BoundExpressions& r);
  /// max(1, the maxima of all groups there are by now).
  dsl::NodeId overall_maximum(BoundExpressions& r);

 private:
  int enter(InputGroup group, GroupMember member, double range);
  int list_of(int parameter) const;
  /// A group as it would be made for one leaf alone, and how large that leaf can be.
  struct Leaf {
    InputGroup group;
    double range = 0;
  };
  Leaf input(const dsl::Node& n);
  Leaf difference(const dsl::Node& n) const;
  Leaf selection(const Leaf& first, const Leaf& second) const;
  std::vector<std::optional<Leaf>> find_leaves();
  std::vector<bool> needed_leaves(const std::vector<std::optional<Leaf>>& leaves) const;
  bool exact_input(dsl::NodeId id) const {
    return graph_[id].op == dsl::Op::input && !parameter_of(graph_[id]).bounded;
  }
  const dsl::Slot& slot_of(const dsl::Node& n) const { return predicate_.slots[static_cast<std::size_t>(n.index)]; }
  const dsl::Parameter& parameter_of(const dsl::Node& n) const {
    return predicate_.parameters[static_cast<std::size_t>(slot_of(n).parameter)];
  }
  double range_of(const dsl::Node& n) const;

  const dsl::Predicate& predicate_;
  bool one_group_;
  dsl::Graph& graph_;
  std::vector<InputGroup> groups_;
  std::vector<int> leaf_groups_;
  dsl::NodeId overall_maximum_ = dsl::no_node;
  int groups_in_overall_maximum_ = 0;
  std::vector<std::vector<int>> selected_vectors_;  ///< InputGroup::inputs of the groups that there are
  int computed_ = 0;                                ///< groups made by enter_computed
};

}  // namespace tightrope::codegen
