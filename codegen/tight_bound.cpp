#include "codegen/tight_bound.h"

#include <algorithm>
#include <cmath>

#include "codegen/alternatives.h"
#include "codegen/nonnegative.h"
#include "codegen/tight_rules.h"

namespace tightrope::codegen {

using dsl::no_node;
using dsl::Node;
using dsl::NodeId;
using dsl::Op;

namespace {
constexpr std::size_t longest_sum = 48;
}

TightBounds::TightBounds(const dsl::Predicate& predicate, const FloatFormat& format, Weakening weakening, double slack,
                         bool use_ranges, dsl::Diagnostics& diagnostics, dsl::Graph& graph)
    : predicate_(predicate),
      format_(format),
      weakening_(weakening),
      slack_(slack),
      unit_(format_.unit_roundoff * (weakening == Weakening::halve_unit_roundoff ? 0.5 : 1) * (1 + slack)),
      use_ranges_(use_ranges),
      diagnostics_(diagnostics),
      graph_(graph),
      r_(graph, format),
      nonnegative_(nonnegative_nodes(predicate.graph)) {}

// ------------------------------------------------------------------ sums of terms

void TightBounds::add_term(Error& error, Term term) {
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
  if (!use_ranges_ && error(id).underflow > 0) return std::nullopt;
  return relative_but_for_underflow(id);
}

/// The same where a constant for underflow comes on top.
std::optional<double> TightBounds::relative_but_for_underflow(NodeId id) const {
  const Error& e = error(id);
  if (e.terms.empty()) return 0;
  if (e.terms.size() == 1 && e.terms[0].magnitude && e.terms[0].node == r_.base(value(id))) {
    return e.terms[0].coefficient;
  }
  return std::nullopt;
}

/// Where no limit of what an underflow will be multiplied with is known (a quotient has none), the compile-time bound
/// of it becomes a part of r, which the rules amplify as it is due.
void TightBounds::make_run_time(NodeId id) {
  Error& e = errors_[static_cast<std::size_t>(id)];
  if (!use_ranges_ || e.underflow == 0) return;
  e.terms.push_back({r_.constant(mul_up(e.underflow, format_.eta / format_.unit_roundoff)), false, 1});
  e.underflow = 0;
}

/// A long r that several users will need is computed once.
void TightBounds::fold_if_shared(NodeId id) {
  Error& e = errors_[static_cast<std::size_t>(id)];
  const bool shared = uses_[static_cast<std::size_t>(id)] > 1 && e.terms.size() > 2;
  if (!shared && e.terms.size() <= longest_sum) return;
  const double underflow = use_ranges_ ? e.underflow : 0;
  e = Error{{{materialise(e), false, 1}}, underflow, e.slack_used};
}

/// The node that computes `n`, behind guards where it has preconditions.
NodeId TightBounds::make_value(const Node& n) {
  if (n.op == Op::div && node(n.b).op != Op::constant) {
    return graph_.binary(Op::div, value(n.a), guarded_divisor(n.b));
  }
  if (n.op == Op::sqrt) return graph_.unary(Op::sqrt, guarded_radicand(n.a));
  return plain_value(n);
}

NodeId TightBounds::plain_value(const Node& n) {
  const auto at = [&](NodeId id) { return id == no_node ? no_node : value(id); };
  return graph_.intern({n.op, at(n.a), at(n.b), at(n.c), n.index, n.value});
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
      const double size = parameter.range.value_or(INFINITY) * (parameter.bounded ? 2 : 1);
      return parameter.normalized >= 0 ? size * inflation : size;
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
    case Op::div:  // by a run-time value: nothing is known
      if (node(n.b).op != Op::constant) return INFINITY;
      return limit(n.a) / std::abs(node(n.b).value) * inflation + 8 * format_.eta;
    case Op::fma:
      return (limit(n.a) * limit(n.b) + limit(n.c)) * inflation + 8 * format_.eta;
    case Op::sqrt:  // value and bound are at most sqrt(Ma) each, for the radicand's bound is at most Ma
      return 2 * std::sqrt(limit(n.a) + error(n.a).underflow * format_.eta) * inflation;
    case Op::min:
    case Op::max:
    case Op::certain_nonzero:
    case Op::certain_nonnegative:
    case Op::normalizer:
    case Op::max_magnitude:
      return std::max(limit(n.a), limit(n.b));
    case Op::select:
      return std::max(limit(n.b), limit(n.c));
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
    case Op::normalizer:
    case Op::max_magnitude:
      return shows(n.a) && shows(n.b);
    case Op::select:
      return shows(n.b) && shows(n.c);
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

/// Whether the value may be the infinity of a scaling upwards (scaled down again or not) that its bound does not show.
/// max and min would forget it: they get a guard. (An infinite input is the infinity it says.)
bool TightBounds::hides_overflow(NodeId id) const {
  if (overflow_shows_[static_cast<std::size_t>(id)]) return false;
  const Node& n = node(id);
  if (n.op == Op::mul_pow2 && n.index > 0 && !(use_ranges_ && limit(id) < format_.largest / 2)) return true;
  if (n.op == Op::select) return hides_overflow(n.b) || hides_overflow(n.c);
  return (n.op == Op::mul_pow2 || n.op == Op::neg || n.op == Op::abs) && hides_overflow(n.a);
}

/// R as one node: of an output, or of an operand that a guard tests.
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
    const NodeId finite = r_.zero_if_finite(value(id));
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
  const std::vector<bool> has_bound = value_nodes(predicate_);
  for (NodeId id = 0; id < count; ++id) {
    if (!has_bound[static_cast<std::size_t>(id)]) continue;
    for (const NodeId operand : {node(id).a, node(id).b, node(id).c}) {
      if (operand != no_node) ++uses_[static_cast<std::size_t>(operand)];
    }
  }
  const auto reporters = outputs_of_nodes(predicate_);
  errors_.reserve(static_cast<std::size_t>(count));
  for (NodeId id = 0; id < count; ++id) {
    const Node& n = node(id);
    if (use_ranges_) limits_.push_back(magnitude_limit(n));
    overflow_shows_.push_back(overflow_shows(n));
    if (!has_bound[static_cast<std::size_t>(id)]) {  // decides what is selected: any number will do
      values_.push_back(plain_value(n));
      errors_.emplace_back();
      continue;
    }
    values_.push_back(make_value(n));
    Error e = rule(id, n, reporters[static_cast<std::size_t>(id)]);
    errors_.push_back(std::move(e));
    fold_if_shared(id);
  }
  for (const auto& stage : predicate_.stages) {
    BoundedStage& bounded = result.stages.emplace_back();
    for (const auto& output : stage.outputs) {
      OutputBound& entry = bounded.outputs.emplace_back();
      for (const NodeId id : output.nodes) entry.elements.push_back({value(id), output_bound(id)});
      if (use_ranges_) entry.assumption = "inputs within their declared ranges";
    }
  }
}

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
