#include "codegen/tight_bound.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "codegen/bound_expression.h"
#include "codegen/precision.h"

namespace tightrope::codegen {

namespace {

using dsl::Graph;
using dsl::no_node;
using dsl::Node;
using dsl::NodeId;
using dsl::Op;

/// One summand of r: coefficient * |node|, or coefficient * node for an expression that is already a (partial) r.
struct Term {
  NodeId node = no_node;
  bool magnitude = true;
  double coefficient = 1;
};

/// The error of one value: |computed - exact| <= u+ (sum of terms) + underflow, see lemmas A to C.
struct Error {
  std::vector<Term> terms;
  double underflow = 0;   ///< in units of eta; with ranges a bound of its own, else it becomes a term (4 eta / u each)
  double slack_used = 0;  ///< m of the header's last paragraph
  bool exact() const { return terms.empty() && underflow == 0; }
};

constexpr std::size_t longest_sum = 48;

/// Whether `id` is a rounded sum or difference of two inputs: what loses nothing but one rounding.
bool is_difference_of_inputs(const Graph& graph, const Node& n) {
  return (n.op == Op::sub || n.op == Op::add) && graph[n.a].op == Op::input && graph[n.b].op == Op::input;
}

class TightBounds {
 public:
  TightBounds(const dsl::Predicate& predicate, const FloatFormat& format, Weakening weakening, double slack,
              bool use_ranges, dsl::Diagnostics& diagnostics, Graph& graph)
      : predicate_(predicate),
        format_(format),
        weakening_(weakening),
        slack_(slack),
        unit_(format_.unit_roundoff * (weakening == Weakening::halve_unit_roundoff ? 0.5 : 1) * (1 + slack)),
        use_ranges_(use_ranges),
        diagnostics_(diagnostics),
        graph_(graph),
        r_(graph, format) {}

  void run(BoundedPredicate& result);
  double roundings() const { return roundings_; }  ///< the largest D + m of all outputs
  double largest_floor() const { return largest_floor_; }

 private:
  // The rules, one a kind of operation.
  Error leaf(const Node& n);
  Error sum(NodeId id, const Node& n);
  Error product(NodeId id, const Node& n);
  Error relative_product(NodeId id, double relative_a, double relative_b);
  Error half_relative_product(NodeId id, NodeId a, double relative_a, NodeId b, bool first);
  Error general_product(NodeId id, const Node& n);
  Error quotient(NodeId id, const Node& n);
  Error extremum(const Node& n);
  Error scaled(const Error& error, double factor) const;
  Error rule(NodeId id, const Node& n, const dsl::Output* reporter);
  double magnitude_limit(const Node& n) const;

  // Building r.
  std::optional<double> relative(NodeId id) const;
  void add_term(Error& error, Term term) const;
  void add_rounding(Error& error, NodeId id, double coefficient) const {
    add_term(error, {r_.base(id), true, coefficient});
  }
  void add_underflow(Error& error, double etas) const;
  NodeId materialise(const Error& error);
  void fold_if_shared(NodeId id);
  NodeId output_bound(NodeId id);
  bool overflow_shows(const Node& n) const;

  const Error& error(NodeId id) const { return errors_[static_cast<std::size_t>(id)]; }
  double limit(NodeId id) const { return limits_[static_cast<std::size_t>(id)]; }
  bool weakened(Weakening w) const { return weakening_ == w; }

  const dsl::Predicate& predicate_;
  const FloatFormat& format_;
  Weakening weakening_;
  double slack_;
  double unit_;
  bool use_ranges_;
  dsl::Diagnostics& diagnostics_;
  Graph& graph_;
  BoundExpressions r_;
  std::vector<Error> errors_;
  std::vector<double> limits_;  ///< M of lemma C, per value node; only with ranges
  std::vector<int> uses_;
  std::vector<bool> overflow_shows_;
  double roundings_ = 0;
  double largest_floor_ = 0;
};

// ------------------------------------------------------------------ sums of terms

void TightBounds::add_term(Error& error, Term term) const {
  if (term.coefficient == 0) return;
  for (Term& t : error.terms) {
    if (t.node == term.node && t.magnitude == term.magnitude) {
      t.coefficient = add_up(t.coefficient, term.coefficient);
      return;
    }
  }
  error.terms.push_back(term);
}

void TightBounds::add_underflow(Error& error, double etas) const {
  if (!weakened(Weakening::drop_underflow)) error.underflow = add_up(error.underflow, etas);
}

/// r as one node: terms of equal coefficient are added before they are multiplied. no_node if there is nothing to add.
NodeId TightBounds::materialise(const Error& error) {
  std::vector<Term> terms = error.terms;
  std::stable_sort(terms.begin(), terms.end(),
                   [](const Term& x, const Term& y) { return x.coefficient > y.coefficient; });
  NodeId total = no_node;
  for (std::size_t i = 0; i < terms.size();) {
    NodeId group = no_node;
    const double coefficient = terms[i].coefficient;
    for (; i < terms.size() && terms[i].coefficient == coefficient; ++i) {
      group = r_.plus(group, terms[i].magnitude ? r_.magnitude(terms[i].node) : terms[i].node);
    }
    total = r_.plus(total, r_.times_constant(group, coefficient));
  }
  if (!use_ranges_ && error.underflow > 0) {
    total = r_.plus(total, r_.constant(mul_up(error.underflow, format_.eta / format_.unit_roundoff)));
  }
  return total;
}

/// pa of lemma B: the error in units of u+ |value|, if it is known at compile time.
std::optional<double> TightBounds::relative(NodeId id) const {
  const Error& e = error(id);
  if (!use_ranges_ && e.underflow > 0) return std::nullopt;
  if (e.terms.empty()) return 0;
  if (e.terms.size() == 1 && e.terms[0].magnitude && e.terms[0].node == r_.base(id)) return e.terms[0].coefficient;
  return std::nullopt;
}

/// A long r that several users will need is computed once.
void TightBounds::fold_if_shared(NodeId id) {
  Error& e = errors_[static_cast<std::size_t>(id)];
  const bool shared = uses_[static_cast<std::size_t>(id)] > 1 && e.terms.size() > 2;
  if (!shared && e.terms.size() <= longest_sum) return;
  const double underflow = use_ranges_ ? e.underflow : 0;
  e = Error{{{materialise(e), false, 1}}, underflow, e.slack_used};
}

// ------------------------------------------------------------------ the rules

/// A bounded input's bound R comes in without slack: (1 + 2^-20) R pays for what is computed with it (MATH 4.3).
Error TightBounds::leaf(const Node& n) {
  const dsl::Slot& slot = predicate_.slots[static_cast<std::size_t>(n.index)];
  if (!predicate_.parameters[static_cast<std::size_t>(slot.parameter)].bounded) return {};
  if (weakened(Weakening::drop_input_bound)) return {};
  const NodeId bound = graph_.input(n.index + static_cast<std::int32_t>(predicate_.slots.size()));
  Error e;
  const NodeId r = r_.times_constant(bound, (1 + slack_) / format_.unit_roundoff);
  e.terms.push_back({r, false, 1});
  return e;
}

Error TightBounds::sum(NodeId id, const Node& n) {
  Error e = error(n.a);
  const bool keep_second = !weakened(Weakening::drop_operand_error_of_sums);
  if (keep_second) {
    for (const Term& t : error(n.b).terms) add_term(e, t);
    e.slack_used = std::max(e.slack_used, error(n.b).slack_used);
    add_underflow(e, error(n.b).underflow);
  }
  const auto dropped =
      is_difference_of_inputs(graph_, n) ? Weakening::drop_rounding_of_differences : Weakening::drop_rounding_of_sums;
  if (!weakened(dropped)) add_rounding(e, id, 1);
  return e;
}

Error TightBounds::scaled(const Error& error, double factor) const {
  Error e = error;
  for (Term& t : e.terms) t.coefficient = mul_up(t.coefficient, factor);
  e.underflow = mul_up(e.underflow, factor);
  return e;
}

Error TightBounds::product(NodeId id, const Node& n) {
  Error e;
  const std::optional<double> relative_a = relative(n.a);
  const std::optional<double> relative_b = relative(n.b);
  if (relative_a && relative_b) {
    e = relative_product(id, *relative_a, *relative_b);
  } else if (relative_a) {
    e = half_relative_product(id, n.a, *relative_a, n.b, true);
  } else if (relative_b) {
    e = half_relative_product(id, n.b, *relative_b, n.a, false);
  } else {
    e = general_product(id, n);
  }
  e.slack_used += error(n.a).slack_used + error(n.b).slack_used;
  // Lemma C: |La Lb - ab| grows by |La| Ub + |Lb| Ua + Ua Ub with |La| + Ra <= Ma, and by the product's own underflow:
  // eta / 2, as much again from lemma B. 4 eta without ranges (MATH 4.4) pays for underflow inside r as well.
  if (use_ranges_) {
    e.underflow = 0;
    add_underflow(e, mul_up(limit(n.a), error(n.b).underflow));
    add_underflow(e, mul_up(limit(n.b), error(n.a).underflow));
    add_underflow(e, mul_up(mul_up(error(n.a).underflow, error(n.b).underflow), format_.eta));
    add_underflow(e, 2);
  } else {
    add_underflow(e, 4);
  }
  return e;
}

/// Lemma B, first half.
Error TightBounds::relative_product(NodeId id, double relative_a, double relative_b) {
  if (weakened(Weakening::drop_first_factor_error)) relative_a = 0;
  if (weakened(Weakening::drop_second_factor_error)) relative_b = 0;
  Error e;
  const double own = weakened(Weakening::drop_rounding_of_products) ? 0 : 1;
  add_rounding(e, id, add_up(add_up(relative_a, relative_b), own));
  e.slack_used = std::min(relative_a, relative_b) + 4;
  return e;
}

/// Lemma B, second half; `first` tells which operand the relative one (a) is. A constant's |La| is a coefficient.
Error TightBounds::half_relative_product(NodeId id, NodeId a, double relative_a, NodeId b, bool first) {
  const auto dropped_a = first ? Weakening::drop_first_factor_error : Weakening::drop_second_factor_error;
  const auto dropped_b = first ? Weakening::drop_second_factor_error : Weakening::drop_first_factor_error;
  Error e;
  if (!weakened(dropped_b)) {
    if (graph_[a].op == Op::constant) {
      e = scaled(error(b), std::abs(graph_[a].value));
      e.slack_used = 0;
    } else {
      add_term(e, {r_.times(r_.magnitude(a), materialise(error(b))), false, 1});
    }
  }
  if (weakened(dropped_a)) relative_a = 0;
  const double own = weakened(Weakening::drop_rounding_of_products) ? 0 : 1;
  add_rounding(e, id, add_up(relative_a, own));
  e.slack_used += relative_a + 4;
  return e;
}

Error TightBounds::general_product(NodeId id, const Node& n) {
  const NodeId ra = materialise(error(n.a));
  const NodeId rb = materialise(error(n.b));
  Error e;
  NodeId widened = r_.magnitude(n.b);  // |Lb| + u+ rb
  if (!weakened(Weakening::drop_product_of_errors)) widened = r_.plus(widened, r_.times_constant(rb, unit_));
  if (!weakened(Weakening::drop_second_factor_error)) add_term(e, {r_.times(r_.magnitude(n.a), rb), false, 1});
  if (!weakened(Weakening::drop_first_factor_error)) add_term(e, {r_.times(ra, widened), false, 1});
  if (!weakened(Weakening::drop_rounding_of_products)) add_rounding(e, id, 1);
  return e;
}

/// Division by an exact constant c. A relative error stays one: |La / c| <= (|L| + eta/2) / (1 - u).
Error TightBounds::quotient(NodeId id, const Node& n) {
  const double inverse = div_up(1, std::abs(graph_[n.b].value));
  Error e;
  if (const auto rho = relative(n.a)) {
    e.slack_used = error(n.a).slack_used + 3;
    add_rounding(e, id, *rho);
    e.underflow = use_ranges_ ? mul_up(error(n.a).underflow, inverse) : 0;
  } else {
    e = scaled(error(n.a), inverse);
  }
  if (!weakened(Weakening::drop_division_rounding)) add_rounding(e, id, 1);
  add_underflow(e, use_ranges_ ? 2 : 4);
  return e;
}

Error TightBounds::extremum(const Node& n) {
  const Error& ea = error(n.a);
  const Error& eb = error(n.b);
  if (ea.exact() && eb.exact()) return {};
  Error e;
  const NodeId ra = materialise(ea);
  const NodeId rb = materialise(eb);
  if (ra != no_node || rb != no_node) {
    e.terms.push_back({ra == no_node ? rb : rb == no_node ? ra : r_.maximum(ra, rb), false, 1});
  }
  e.underflow = use_ranges_ ? std::max(ea.underflow, eb.underflow) : 0;
  e.slack_used = std::max(ea.slack_used, eb.slack_used);
  return e;
}

Error TightBounds::rule(NodeId id, const Node& n, const dsl::Output* reporter) {
  switch (n.op) {
    case Op::input:
      return leaf(n);
    case Op::constant:
      return {};
    case Op::add:
    case Op::sub:
      return sum(id, n);
    case Op::neg:
    case Op::abs:
      return error(n.a);
    case Op::mul:
      return product(id, n);
    case Op::mul_pow2: {
      Error e = scaled(error(n.a), std::max(std::ldexp(1.0, n.index), 0x1p-1074));
      // The term of a relative error becomes the scaled value's own, so that it stays relative: |2^k a| = 2^k |a|.
      if (const auto rho = relative(n.a); rho && *rho > 0 && n.index > 0) e.terms = {{id, true, *rho}};
      if (n.index < 0) add_underflow(e, use_ranges_ ? 1 : 4);
      return e;
    }
    case Op::min:
    case Op::max:
      return extremum(n);
    case Op::div:
      if (graph_[n.b].op == Op::constant) return quotient(id, n);
      [[fallthrough]];
    case Op::sqrt:
    case Op::fma:
    case Op::certain_nonzero:
    case Op::certain_nonnegative:
    case Op::max_magnitude:
      break;
  }
  report_unbounded(n, *reporter, BoundMode::tight, diagnostics_);
  return {};
}

/// M of lemma C: |computed| + bound, inflated by 2^-10 an operation, which pays for every rounding in it, and by 8 eta
/// where something can underflow.
double TightBounds::magnitude_limit(const Node& n) const {
  constexpr double inflation = 1 + 0x1p-10;
  switch (n.op) {
    case Op::input: {
      const auto& parameter =
          predicate_
              .parameters[static_cast<std::size_t>(predicate_.slots[static_cast<std::size_t>(n.index)].parameter)];
      return parameter.range.value_or(INFINITY) * (parameter.bounded ? 2 : 1);
    }
    case Op::constant:
      return std::abs(n.value);
    case Op::add:
    case Op::sub:
      return (limit(n.a) + limit(n.b)) * inflation;
    case Op::neg:
    case Op::abs:
      return limit(n.a);
    case Op::mul:
      return limit(n.a) * limit(n.b) * inflation + 8 * format_.eta;
    case Op::mul_pow2:
      return std::ldexp(limit(n.a), n.index) * inflation + 8 * format_.eta;
    case Op::div:
      return limit(n.a) / std::abs(graph_[n.b].value) * inflation + 8 * format_.eta;
    case Op::min:
    case Op::max:
    case Op::certain_nonzero:
    case Op::certain_nonnegative:
    case Op::max_magnitude:
      return std::max(limit(n.a), limit(n.b));
    case Op::sqrt:
    case Op::fma:
      break;
  }
  return INFINITY;
}

// ------------------------------------------------------------------ outputs

/// Whether an infinite value always comes with an infinite or NaN bound: after a rounding, |L| is part of r.
bool TightBounds::overflow_shows(const Node& n) const {
  const auto shows = [&](NodeId id) { return overflow_shows_[static_cast<std::size_t>(id)]; };
  switch (n.op) {
    case Op::input:
    case Op::constant:
      return false;
    case Op::neg:
    case Op::abs:
    case Op::mul_pow2:
      return shows(n.a);
    case Op::min:
    case Op::max:
    case Op::certain_nonzero:
    case Op::certain_nonnegative:
    case Op::max_magnitude:
      return shows(n.a) && shows(n.b);
    case Op::add:
    case Op::sub:
    case Op::mul:
    case Op::div:
    case Op::sqrt:
    case Op::fma:
      break;
  }
  return true;
}

NodeId TightBounds::output_bound(NodeId id) {
  const Error& e = error(id);
  NodeId bound = no_node;
  if (const NodeId r = materialise(e); r != no_node) bound = r_.times_constant(r, unit_);
  if (use_ranges_ && e.underflow > 0) {
    const double floor = mul_up(mul_up(e.underflow + 2, format_.eta), 1 + 0x1p-10);
    largest_floor_ = std::max(largest_floor_, floor);
    bound = r_.plus(bound, r_.constant(floor));
  }
  roundings_ = std::max(roundings_, (bound == no_node ? 0 : r_.roundings(bound)) + e.slack_used);
  // x - x is 0 for a finite x, else NaN: an infinite input gives no sign.
  if (bound == no_node || !overflow_shows_[static_cast<std::size_t>(id)]) {
    const NodeId finite = r_.zero_if_finite(id);
    bound = bound == no_node ? finite : r_.plus(bound, finite);
  }
  return bound;
}

void TightBounds::run(BoundedPredicate& result) {
  const NodeId count = predicate_.graph.size();
  uses_.assign(static_cast<std::size_t>(count), 0);
  for (const auto& stage : predicate_.stages) {
    for (const auto& output : stage.outputs) {
      for (const NodeId id : output.nodes) ++uses_[static_cast<std::size_t>(id)];
    }
  }
  for (NodeId id = 0; id < count; ++id) {
    for (const NodeId operand : {graph_[id].a, graph_[id].b, graph_[id].c}) {
      if (operand != no_node) ++uses_[static_cast<std::size_t>(operand)];
    }
  }
  const auto reporters = outputs_of_nodes(predicate_);
  errors_.reserve(static_cast<std::size_t>(count));
  for (NodeId id = 0; id < count; ++id) {
    const Node n = graph_[id];
    if (use_ranges_) limits_.push_back(magnitude_limit(n));
    overflow_shows_.push_back(overflow_shows(n));
    Error e = rule(id, n, reporters[static_cast<std::size_t>(id)]);
    errors_.push_back(std::move(e));
    fold_if_shared(id);
  }
  for (const auto& stage : predicate_.stages) {
    BoundedStage& bounded = result.stages.emplace_back();
    for (const auto& output : stage.outputs) {
      OutputBound& entry = bounded.outputs.emplace_back();
      for (const NodeId id : output.nodes) entry.elements.push_back({id, output_bound(id)});
      if (use_ranges_) entry.assumption = "inputs within their declared ranges";
    }
  }
}

}  // namespace

void add_tight_bounds(const dsl::Predicate& predicate, const FloatFormat& format, dsl::Diagnostics& diagnostics,
                      Weakening weakening, BoundedPredicate& result) {
  const FloatFormat& f = format;
  const bool ideal = f.slack == 0;
  double slack = f.slack;
  bool use_ranges = all_inputs_have_ranges(predicate);
  for (;;) {
    BoundedPredicate attempt;
    attempt.graph = predicate.graph;
    dsl::Diagnostics found;
    TightBounds bounds(predicate, format, weakening, slack, use_ranges, found, attempt.graph);
    bounds.run(attempt);
    const double needed = 2 * bounds.roundings() * f.unit_roundoff;
    if (found.has_errors()) {
      for (const auto& d : found.entries()) diagnostics.error(d.span, d.message, d.hint);
      return;
    }
    if (use_ranges && bounds.largest_floor() > f.floor_limit) {
      use_ranges = false;  // ranges so wide that the floor would drown small values: run-time terms are sharper
    } else if (!ideal && needed > slack && needed > 0.125) {
      diagnostics.error(predicate.stages.front().outputs.front().span,
                        "the error bound of this predicate takes too many roundings for the precision");
      return;
    } else if (!ideal && needed > slack) {
      slack = std::exp2(std::ceil(std::log2(needed)));
    } else {
      result = std::move(attempt);
      return;
    }
  }
}

}  // namespace tightrope::codegen
