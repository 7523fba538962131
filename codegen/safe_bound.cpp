#include "codegen/safe_bound.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "codegen/bound_expression.h"
#include "codegen/magnitude_polynomial.h"
#include "codegen/precision.h"

namespace tightrope::codegen {

namespace {

using dsl::Graph;
using dsl::no_node;
using dsl::Node;
using dsl::NodeId;
using dsl::Op;

/// A set of inputs, or of differences of inputs, that share one run-time maximum.
struct Group {
  std::string name;                 ///< "d_x"
  std::vector<NodeId> members;      ///< values whose magnitudes count
  std::vector<NodeId> bounds;       ///< bounded inputs: the incoming bounds, as members
  double range = INFINITY;          ///< compile-time limit of B, from declared ranges
  NodeId maximum = no_node;         ///< B's node
  NodeId relative_bound = no_node;  ///< rho's node; bounded groups only
  bool bounded() const { return !bounds.empty(); }
};

/// The pair of one value, and the rest of the header's formula.
struct Pair {
  MagnitudePolynomial B;
  int k = 0;
  std::map<int, int> bounded_degrees;  ///< d of every bounded group
  double underflow = 0;                ///< with ranges: A in units of eta; else C
  int underflow_degree = 0;            ///< p
  bool rounded = false;                ///< has any error at all
  bool may_overflow = false;           ///< some value that this one is computed from, or itself, may be infinite
  std::vector<NodeId> guards;          ///< operands of max and min, where an infinity could get lost
};

constexpr std::size_t most_monomials = 96;

class SafeBounds {
 public:
  SafeBounds(const dsl::Predicate& predicate, Precision precision, Weakening weakening, bool one_group, bool use_ranges,
             dsl::Diagnostics& diagnostics, Graph& graph)
      : predicate_(predicate),
        precision_(precision),
        format_(format(precision)),
        weakening_(weakening),
        one_group_(one_group),
        use_ranges_(use_ranges),
        diagnostics_(diagnostics),
        graph_(graph) {}

  void run(BoundedPredicate& result);
  bool too_many_monomials() const { return too_many_monomials_; }
  double largest_floor() const { return largest_floor_; }

 private:
  void find_leaves();
  int group_of(const std::string& name);
  int input_group(const Node& n, NodeId id);
  int difference_group(const Node& n, NodeId id);
  void enter(int group, NodeId value, double range);

  Pair leaf(int group, bool rounded) const;
  Pair rule(NodeId id, const Node& n, const dsl::Output* reporter);
  Pair sum(const Pair& a, const Pair& b) const;
  Pair product(const Pair& a, const Pair& b) const;
  Pair scaled(const Pair& a, double factor, bool may_underflow) const;
  static Pair merged(const Pair& a, const Pair& b);

  NodeId constant(double value) { return graph_.constant(round_up(value, precision_)); }
  NodeId group_maximum(int group);
  NodeId relative_bound(int group);
  NodeId overall_maximum();
  NodeId power(NodeId x, int exponent);
  NodeId evaluate(const MagnitudePolynomial& B, double factor);
  NodeId output_bound(NodeId id, const Pair& pair);
  NodeId underflow_bound(const Pair& pair);
  NodeId with_guards(NodeId bound, NodeId id, const Pair& pair);
  double limit(const MagnitudePolynomial& B) const;
  double slot_range(const Node& n) const;
  const dsl::Parameter& parameter_of(const Node& n) const {
    return predicate_
        .parameters[static_cast<std::size_t>(predicate_.slots[static_cast<std::size_t>(n.index)].parameter)];
  }
  const dsl::Slot& slot_of(const Node& n) const { return predicate_.slots[static_cast<std::size_t>(n.index)]; }
  const Pair& pair(NodeId id) const { return pairs_[static_cast<std::size_t>(id)]; }
  bool weakened(Weakening w) const { return weakening_ == w; }

  const dsl::Predicate& predicate_;
  Precision precision_;
  const FloatFormat& format_;
  Weakening weakening_;
  bool one_group_;
  bool use_ranges_;
  dsl::Diagnostics& diagnostics_;
  Graph& graph_;
  std::vector<Group> groups_;
  std::vector<int> leaf_groups_;  ///< per node: its group if it is a leaf, else -1
  std::vector<Pair> pairs_;
  NodeId overall_maximum_ = no_node;
  bool too_many_monomials_ = false;
  double largest_floor_ = 0;
};

// ------------------------------------------------------------------ groups

int SafeBounds::group_of(const std::string& name) {
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    if (groups_[i].name == name) return static_cast<int>(i);
  }
  groups_.push_back({});
  groups_.back().name = name;
  groups_.back().range = 0;
  return static_cast<int>(groups_.size()) - 1;
}

void SafeBounds::enter(int group, NodeId value, double range) {
  Group& g = groups_[static_cast<std::size_t>(group)];
  g.members.push_back(value);
  g.range = std::max(g.range, range);
}

double SafeBounds::slot_range(const Node& n) const {
  const dsl::Parameter& p = parameter_of(n);
  return p.range.value_or(INFINITY) * (p.bounded ? 2 : 1);
}

constexpr const char* axis_names[] = {"x", "y", "z"};

int SafeBounds::input_group(const Node& n, NodeId id) {
  const dsl::Parameter& p = parameter_of(n);
  const dsl::Slot& slot = slot_of(n);
  if (p.bounded) {
    const int group = group_of(p.name);
    enter(group, id, slot_range(n));
    groups_[static_cast<std::size_t>(group)].bounds.push_back(
        graph_.input(n.index + static_cast<std::int32_t>(predicate_.slots.size())));
    return group;
  }
  const int group = one_group_         ? group_of("b")
                    : p.dimension == 1 ? group_of(p.name)
                                       : group_of(std::string("v_") + axis_names[slot.component]);
  enter(group, id, slot_range(n));
  return group;
}

int SafeBounds::difference_group(const Node& n, NodeId id) {
  const Node& x = graph_[n.a];
  const Node& y = graph_[n.b];
  const int axis = slot_of(x).component;
  const bool one_axis = axis == slot_of(y).component && parameter_of(x).dimension > 1 && parameter_of(y).dimension > 1;
  const int group = one_group_ ? group_of("b") : group_of(one_axis ? std::string("d_") + axis_names[axis] : "d");
  enter(group, id, (slot_range(x) + slot_range(y)) * (1 + 0x1p-10));
  return group;
}

/// Leaves: rounded sums and differences of two exact inputs, and inputs that are used in any other way.
void SafeBounds::find_leaves() {
  const NodeId count = predicate_.graph.size();
  leaf_groups_.assign(static_cast<std::size_t>(count), -1);
  const auto exact_input = [&](NodeId id) { return graph_[id].op == Op::input && !parameter_of(graph_[id]).bounded; };
  std::vector<bool> used_directly(static_cast<std::size_t>(count), false);
  for (const auto& stage : predicate_.stages) {
    for (const auto& output : stage.outputs) {
      for (const NodeId id : output.nodes) used_directly[static_cast<std::size_t>(id)] = true;
    }
  }
  for (NodeId id = 0; id < count; ++id) {
    const Node n = graph_[id];
    if ((n.op == Op::add || n.op == Op::sub) && exact_input(n.a) && exact_input(n.b)) {
      leaf_groups_[static_cast<std::size_t>(id)] = difference_group(n, id);
      continue;
    }
    for (const NodeId operand : {n.a, n.b, n.c}) {
      if (operand != no_node) used_directly[static_cast<std::size_t>(operand)] = true;
    }
  }
  for (NodeId id = 0; id < count; ++id) {
    const Node n = graph_[id];
    if (n.op == Op::input && used_directly[static_cast<std::size_t>(id)]) {
      leaf_groups_[static_cast<std::size_t>(id)] = input_group(n, id);
    }
  }
}

// ------------------------------------------------------------------ the rules

Pair SafeBounds::leaf(int group, bool rounded) const {
  Pair p;
  p.B = MagnitudePolynomial::variable(group);
  if (rounded) p.k = weakened(Weakening::drop_rounding_of_differences) ? 0 : 1;
  p.rounded = rounded;
  if (groups_[static_cast<std::size_t>(group)].bounded()) {
    p.bounded_degrees[group] = weakened(Weakening::drop_input_bound) ? 0 : 1;
    p.rounded = true;
  }
  return p;
}

Pair SafeBounds::merged(const Pair& a, const Pair& b) {
  Pair p;
  p.k = std::max(a.k, b.k);
  p.bounded_degrees = a.bounded_degrees;
  for (const auto& [group, degree] : b.bounded_degrees) {
    int& d = p.bounded_degrees[group];
    d = std::max(d, degree);
  }
  p.underflow_degree = std::max(a.underflow_degree, b.underflow_degree);
  p.rounded = a.rounded || b.rounded;
  p.may_overflow = a.may_overflow || b.may_overflow;
  p.guards = a.guards;
  for (const NodeId g : b.guards) {
    if (std::find(p.guards.begin(), p.guards.end(), g) == p.guards.end()) p.guards.push_back(g);
  }
  return p;
}

/// The largest B within the declared ranges.
double SafeBounds::limit(const MagnitudePolynomial& B) const {
  std::vector<double> ranges;
  for (const Group& g : groups_) ranges.push_back(g.range);
  return B.at(ranges);
}

Pair SafeBounds::sum(const Pair& a, const Pair& b) const {
  Pair p = merged(a, b);
  p.B = a.B + b.B;
  if (!weakened(Weakening::drop_rounding_of_sums)) ++p.k;
  p.underflow = add_up(a.underflow, b.underflow) * (1 + 0x1p-10);  // the rounding acts on A as well
  p.rounded = true;
  return p;
}

Pair SafeBounds::product(const Pair& a, const Pair& b) const {
  Pair p = merged(a, b);
  p.B = a.B * b.B;
  p.k = a.k + b.k + (weakened(Weakening::drop_rounding_of_products) ? 0 : 1);
  p.bounded_degrees = a.bounded_degrees;
  for (const auto& [group, degree] : b.bounded_degrees) p.bounded_degrees[group] += degree;
  p.rounded = true;
  // |f^| <= B F + A: the inflation by 2^-10 stands for F, the last term for A A; eta / 2 is the product's own
  // underflow. A bounded group's factor F may be as large as 2^d.
  double spread = 1 + 0x1p-10;
  for (const auto& [group, degree] : p.bounded_degrees) spread *= std::exp2(degree);
  double size_a = 0;
  double size_b = 0;
  if (use_ranges_) {
    size_a = limit(a.B);
    size_b = limit(b.B);
    p.underflow_degree = 0;
  } else {
    size_a = a.B.coefficient_sum();
    size_b = b.B.coefficient_sum();
    p.underflow_degree = std::max(a.underflow_degree + b.B.degree(), b.underflow_degree + a.B.degree());
  }
  p.underflow = add_up(add_up(mul_up(size_a, b.underflow), mul_up(size_b, a.underflow)) * spread,
                       add_up(mul_up(mul_up(a.underflow, b.underflow), format_.eta), 1));
  if (weakened(Weakening::drop_underflow)) p.underflow = 0;
  return p;
}

Pair SafeBounds::scaled(const Pair& a, double factor, bool may_underflow) const {
  Pair p = a;
  p.B = a.B.scaled(factor);
  p.underflow = mul_up(a.underflow, factor);
  if (may_underflow && !weakened(Weakening::drop_underflow)) {
    p.underflow = add_up(p.underflow, 1);
    p.rounded = true;
  }
  return p;
}

Pair SafeBounds::rule(NodeId id, const Node& n, const dsl::Output* reporter) {
  if (const int group = leaf_groups_[static_cast<std::size_t>(id)]; group >= 0) return leaf(group, n.op != Op::input);
  switch (n.op) {
    case Op::input:
      return {};  // only used in differences, which are leaves
    case Op::constant: {
      Pair p;
      p.B = MagnitudePolynomial::constant(std::abs(n.value));
      return p;
    }
    case Op::add:
    case Op::sub:
      return sum(pair(n.a), pair(n.b));
    case Op::neg:
    case Op::abs:
      return pair(n.a);
    case Op::mul:
      return product(pair(n.a), pair(n.b));
    case Op::mul_pow2:
      return scaled(pair(n.a), std::max(std::ldexp(1.0, n.index), 0x1p-1074), n.index < 0);
    case Op::min:
    case Op::max: {
      Pair p = merged(pair(n.a), pair(n.b));
      p.B = MagnitudePolynomial::max(pair(n.a).B, pair(n.b).B);
      p.underflow = std::max(pair(n.a).underflow, pair(n.b).underflow);
      for (const NodeId operand : {n.a, n.b}) {
        if (pair(operand).may_overflow) p.guards.push_back(operand);
      }
      return p;
    }
    case Op::div:
      if (graph_[n.b].op == Op::constant) {
        Pair p = scaled(pair(n.a), div_up(1, std::abs(graph_[n.b].value)), true);
        if (!weakened(Weakening::drop_division_rounding)) ++p.k;
        p.rounded = true;
        return p;
      }
      [[fallthrough]];
    case Op::sqrt:
    case Op::fma:
    case Op::max_magnitude:
      break;
  }
  report_unbounded(n, *reporter, BoundMode::safe, diagnostics_);
  return {};
}

// ------------------------------------------------------------------ B and the bound as nodes

/// max |member|, of a bounded group max(|value| + bound). A NaN member may get lost here (never the members before it):
/// whatever is computed from the NaN input is NaN itself and has no sign, and no other bound needs it.
NodeId SafeBounds::group_maximum(int group) {
  Group& g = groups_[static_cast<std::size_t>(group)];
  if (g.maximum != no_node) return g.maximum;
  for (std::size_t i = 0; i < g.members.size(); ++i) {
    NodeId size = graph_.abs(g.members[i]);
    if (g.bounded()) size = graph_.add(size, g.bounds[i]);
    g.maximum = g.maximum == no_node ? size : graph_.binary(Op::max_magnitude, g.maximum, size);
  }
  return g.maximum;
}

NodeId SafeBounds::relative_bound(int group) {
  Group& g = groups_[static_cast<std::size_t>(group)];
  if (g.relative_bound != no_node) return g.relative_bound;
  NodeId bound = no_node;
  // A NaN among the bounds must not get lost, its value may be a number. Inputs within their ranges have none.
  const Op larger = use_ranges_ ? Op::max_magnitude : Op::max;
  for (const NodeId b : g.bounds) bound = bound == no_node ? b : graph_.binary(larger, bound, b);
  // B = 0 gives a NaN, hence no sign. The quotient's own underflow is in output_bound's constant.
  g.relative_bound = graph_.binary(Op::div, bound, group_maximum(group));
  return g.relative_bound;
}

NodeId SafeBounds::overall_maximum() {
  if (overall_maximum_ != no_node) return overall_maximum_;
  overall_maximum_ = constant(1);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    overall_maximum_ = graph_.binary(Op::max_magnitude, overall_maximum_, group_maximum(static_cast<int>(g)));
  }
  return overall_maximum_;
}

NodeId SafeBounds::power(NodeId x, int exponent) {
  if (exponent == 1) return x;
  const NodeId half = power(x, exponent / 2);
  const NodeId square = graph_.mul(half, half);
  return exponent % 2 == 0 ? square : graph_.mul(square, x);
}

/// factor * B: the factor goes into the coefficients.
NodeId SafeBounds::evaluate(const MagnitudePolynomial& B, double factor) {
  NodeId total = no_node;
  for (const auto& [monomial, coefficient] : B.monomials()) {
    NodeId product = no_node;
    for (std::size_t g = 0; g < monomial.size(); ++g) {
      if (monomial[g] == 0) continue;
      const NodeId p = power(group_maximum(static_cast<int>(g)), monomial[g]);
      product = product == no_node ? p : graph_.mul(product, p);
    }
    const NodeId c = constant(mul_up(coefficient, factor));
    product = product == no_node ? c : graph_.mul(product, c);
    total = total == no_node ? product : graph_.add(total, product);
  }
  return total;
}

NodeId SafeBounds::underflow_bound(const Pair& p) {
  if (p.underflow == 0) return no_node;
  const double floor = mul_up(mul_up(p.underflow + 4 + p.B.degree(), format_.eta), 1 + 0x1p-10);
  if (use_ranges_) {
    largest_floor_ = std::max(largest_floor_, floor);
    return constant(floor);
  }
  const NodeId c = constant(floor);
  return p.underflow_degree == 0 ? c : graph_.mul(c, power(overall_maximum(), p.underflow_degree));
}

NodeId SafeBounds::output_bound(NodeId id, const Pair& p) {
  if (!p.rounded) return graph_.sub(id, id);  // 0, or NaN for an infinite input
  const double u = format_.unit_roundoff * (weakened(Weakening::halve_unit_roundoff) ? 0.5 : 1);
  NodeId bound = no_node;
  if (p.bounded_degrees.empty()) {
    const double ku = p.k * u;
    bound = p.k == 0 ? no_node : evaluate(p.B, div_up(ku, 1 - ku) * (1 + format_.slack));
  } else {
    // B F (k u + sum d rho), F = (1 + slack) prod (1 + rho)^d.
    int degrees = 0;
    for (const auto& [group, degree] : p.bounded_degrees) degrees += degree;
    NodeId x = constant(add_up(p.k * u, 4 * degrees * format_.eta));
    NodeId spread = no_node;
    for (const auto& [group, degree] : p.bounded_degrees) {
      if (degree == 0) continue;
      const NodeId rho = relative_bound(group);
      x = graph_.add(x, graph_.mul(rho, constant(degree)));
      const NodeId factor = power(graph_.add(rho, constant(1)), degree);
      spread = spread == no_node ? factor : graph_.mul(spread, factor);
    }
    const NodeId B = evaluate(p.B, 1 + format_.slack);
    if (B != no_node) bound = graph_.mul(B, spread == no_node ? x : graph_.mul(spread, x));
  }
  const NodeId floor = underflow_bound(p);
  if (bound == no_node)
    bound = floor;
  else if (floor != no_node)
    bound = graph_.add(bound, floor);
  return with_guards(bound, id, p);
}

/// Where a value may overflow, its B times k u may still be finite, and an infinity minus a large number has the wrong
/// sign as easily as the right one. x - x is 0 for a finite x, else NaN: an infinite value, or one that came from an
/// infinite operand of max or min, gets no sign.
NodeId SafeBounds::with_guards(NodeId bound, NodeId id, const Pair& p) {
  const auto guard = [&](NodeId x) {
    const NodeId finite = graph_.sub(x, x);
    bound = bound == no_node ? finite : graph_.add(bound, finite);
  };
  if (p.may_overflow || bound == no_node) guard(id);
  for (const NodeId g : p.guards) guard(g);
  return bound;
}

void SafeBounds::run(BoundedPredicate& result) {
  find_leaves();
  const NodeId count = predicate_.graph.size();
  const auto reporters = outputs_of_nodes(predicate_);
  for (NodeId id = 0; id < count && !too_many_monomials_; ++id) {
    pairs_.push_back(rule(id, predicate_.graph[id], reporters[static_cast<std::size_t>(id)]));
    Pair& p = pairs_.back();
    // 2^d is the most that F of the bounded groups can be.
    double spread = 2;
    for (const auto& [group, degree] : p.bounded_degrees) spread *= std::exp2(degree);
    p.may_overflow = p.may_overflow || !use_ranges_ || !(limit(p.B) * spread < format_.largest / 2);
    too_many_monomials_ = pairs_.back().B.terms() > most_monomials && !one_group_;
  }
  if (too_many_monomials_) return;
  std::vector<std::string> names;
  for (const Group& g : groups_) names.push_back(g.name);
  for (const auto& stage : predicate_.stages) {
    BoundedStage& bounded = result.stages.emplace_back();
    for (const auto& output : stage.outputs) {
      OutputBound& entry = bounded.outputs.emplace_back();
      const Pair* widest = nullptr;
      for (const NodeId id : output.nodes) {
        entry.elements.push_back({id, output_bound(id, pair(id))});
        if (!widest || pair(id).k > widest->k) widest = &pair(id);
      }
      entry.roundings = widest->k;
      if (widest->k * format_.unit_roundoff > 0.0625 || widest->B.terms() > 1024) {
        diagnostics_.error(output.span, "the error bound of this output takes too many roundings for the precision");
      }
      entry.magnitude = widest->B.text(names);
      if (use_ranges_) entry.assumption = "inputs within their declared ranges";
    }
  }
}

}  // namespace

void add_safe_bounds(const dsl::Predicate& predicate, Precision precision, dsl::Diagnostics& diagnostics,
                     Weakening weakening, BoundedPredicate& result) {
  bool one_group = false;
  bool use_ranges = all_inputs_have_ranges(predicate);
  for (;;) {
    BoundedPredicate attempt;
    attempt.graph = predicate.graph;
    dsl::Diagnostics found;
    SafeBounds bounds(predicate, precision, weakening, one_group, use_ranges, found, attempt.graph);
    bounds.run(attempt);
    if (found.has_errors()) {
      for (const auto& d : found.entries()) diagnostics.error(d.span, d.message, d.hint);
      return;
    }
    if (bounds.too_many_monomials()) {
      one_group = true;
    } else if (use_ranges && bounds.largest_floor() > format(precision).floor_limit) {
      use_ranges = false;
    } else {
      result = std::move(attempt);
      return;
    }
  }
}

}  // namespace tightrope::codegen
