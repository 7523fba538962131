#include "codegen/safe_bound.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "codegen/alternatives.h"
#include "codegen/bound_expression.h"
#include "codegen/input_groups.h"
#include "codegen/magnitude_polynomial.h"
#include "codegen/nonnegative.h"
#include "codegen/precision.h"
#include "codegen/quotient_bound.h"
#include "codegen/raised_maxima.h"

namespace tightrope::codegen {

namespace {

using dsl::Graph;
using dsl::no_node;
using dsl::Node;
using dsl::NodeId;
using dsl::Op;

/// The pair of one value, and the rest of the header's formula.
struct Pair {
  MagnitudePolynomial B;
  int k = 0;
  std::map<int, int> bounded_degrees;  ///< d of every bounded group
  double underflow = 0;                ///< with ranges: A in units of eta; else C
  int underflow_degree = 0;            ///< p
  double underflow_count = 0;          ///< N of the raised maxima
  double least_sum = INFINITY;         ///< c of the raised maxima
  bool rounded = false;                ///< has any error at all
  bool may_overflow = false;           ///< some value that this one is computed from, or itself, may be infinite
  std::vector<NodeId> guards;          ///< operands of max and min, where an infinity could get lost
};

constexpr std::size_t most_monomials = 96;

class SafeBounds {
 public:
  SafeBounds(const dsl::Predicate& predicate, const FloatFormat& format, Weakening weakening, bool one_group,
             bool use_ranges, dsl::Diagnostics& diagnostics, Graph& graph)
      : predicate_(predicate),
        format_(format),
        weakening_(weakening),
        one_group_(one_group),
        use_ranges_(use_ranges),
        diagnostics_(diagnostics),
        graph_(graph),
        r_(graph, format),
        groups_(predicate, one_group, graph),
        nonnegative_(nonnegative_nodes(predicate.graph)),
        unit_(format_.unit_roundoff * (weakening == Weakening::halve_unit_roundoff ? 0.5 : 1)) {}

  void run(BoundedPredicate& result);
  bool too_many_monomials() const { return too_many_monomials_; }
  double largest_floor() const { return largest_floor_; }
  /// The most roundings that the slack has to pay for in one output.
  double roundings() const { return roundings_; }

 private:
  Pair leaf(int group, bool rounded) const;
  Pair rule(NodeId id, const Node& n, const dsl::Output* reporter);
  NodeId make_value(const Node& n);
  Pair sum(const Pair& a, const Pair& b) const;
  Pair product(const Pair& a, const Pair& b) const;
  Pair fused(const Node& n) const;
  Pair computed_leaf(NodeId id, const Node& n);
  Pair scaled(const Pair& a, double factor, bool may_underflow) const;
  static Pair merged(const Pair& a, const Pair& b);

  NodeId evaluate(const MagnitudePolynomial& B, double factor);
  double evaluation_loss(const MagnitudePolynomial& B, double factor) const;
  NodeId exact_input_bound(const Pair& pair, double& loss);
  NodeId raised_bound(const Pair& pair);
  NodeId bounded_input_bound(const Pair& pair, double& loss);
  NodeId underflow_bound(const Pair& pair, double loss);
  NodeId output_bound(NodeId id);
  NodeId with_guards(NodeId bound, NodeId computed, const Pair& pair);
  double limit(const MagnitudePolynomial& B) const { return B.at(groups_.ranges()); }
  NodeId value(NodeId id) const { return values_[static_cast<std::size_t>(id)]; }
  const Pair& pair(NodeId id) const { return pairs_[static_cast<std::size_t>(id)]; }
  bool weakened(Weakening w) const { return weakening_ == w; }

  const dsl::Predicate& predicate_;
  const FloatFormat& format_;
  Weakening weakening_;
  bool one_group_;
  bool use_ranges_;
  dsl::Diagnostics& diagnostics_;
  Graph& graph_;
  BoundExpressions r_;
  InputGroups groups_;
  std::vector<bool> nonnegative_;
  std::vector<NodeId> values_;  ///< by node of the predicate: the node of the bounded graph that computes it
  double unit_;
  std::vector<Pair> pairs_;
  bool too_many_monomials_ = false;
  double largest_floor_ = 0;
  double roundings_ = 0;
};

// ------------------------------------------------------------------ the rules

Pair SafeBounds::leaf(int group, bool rounded) const {
  Pair p;
  p.B = MagnitudePolynomial::variable(group);
  if (groups_[group].normalized && !weakened(Weakening::drop_underflow)) {  // what s x may have lost (normalize.h)
    p.underflow = p.underflow_count = 2;
    p.least_sum = 1;
    p.rounded = true;
  }
  if (rounded) p.k = weakened(Weakening::drop_rounding_of_differences) ? 0 : 1;
  p.rounded = p.rounded || rounded;
  if (groups_[group].bounded()) {
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
  p.underflow_count = std::max(a.underflow_count, b.underflow_count);
  p.least_sum = std::min(a.least_sum, b.least_sum);
  p.rounded = a.rounded || b.rounded;
  p.may_overflow = a.may_overflow || b.may_overflow;
  p.guards = a.guards;
  for (const NodeId g : b.guards) {
    if (std::find(p.guards.begin(), p.guards.end(), g) == p.guards.end()) p.guards.push_back(g);
  }
  return p;
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
  p.underflow_count = a.underflow_count + b.underflow_count + 2;
  p.least_sum = std::min(p.least_sum, p.B.coefficient_sum());
  // |f^| <= B F + A: the inflation by 2^-9 stands for F, the last term for A A; eta / 2 is the product's own
  // underflow. A bounded group's factor F may be as large as 2^d.
  double spread = 1 + 0x1p-9;
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

/// The product's rounding is the sum's: |f^ g^ + h^ - (f g + h)| <= (Bf Bg + Bh) (F - 1) before it.
Pair SafeBounds::fused(const Node& n) const {
  Pair unrounded = product(pair(n.a), pair(n.b));
  unrounded.k = pair(n.a).k + pair(n.b).k;
  Pair p = sum(unrounded, pair(n.c));
  p.k = std::max(unrounded.k, pair(n.c).k) + (weakened(Weakening::drop_fma_rounding) ? 0 : 1);
  return p;
}

/// A quotient or root by run-time operands: as an input that comes with a bound.
Pair SafeBounds::computed_leaf(NodeId id, const Node& n) {
  const auto bounded = [&](NodeId operand) {
    return BoundedValue{value(operand), pair(operand).rounded ? output_bound(operand) : no_node};
  };
  const QuotientContext context{graph_, r_, format_, unit_, weakening_};
  const bool is_root = n.op == Op::sqrt;
  const BoundedValue made = is_root
                                ? bounded_root(context, bounded(n.a), nonnegative_[static_cast<std::size_t>(n.a)])
                                : bounded_quotient(context, bounded(n.a), bounded(n.b), r_.zero_if_finite(value(n.b)));
  values_[static_cast<std::size_t>(id)] = made.value;
  // The slack of R has paid for its roundings: it is a bound as it stands.
  roundings_ = std::max(roundings_, r_.roundings(made.bound) + 12);
  r_.settle(made.bound);
  return leaf(groups_.enter_computed(is_root ? "root" : "quotient", made.value, made.bound), false);
}

Pair SafeBounds::scaled(const Pair& a, double factor, bool may_underflow) const {
  Pair p = a;
  p.B = a.B.scaled(factor);
  p.underflow = mul_up(a.underflow, factor);
  if (may_underflow && !weakened(Weakening::drop_underflow)) {
    p.underflow = add_up(p.underflow, 1);
    p.underflow_count += 1;
    p.least_sum = std::min(p.least_sum, p.B.coefficient_sum());
    p.rounded = true;
  }
  return p;
}

Pair SafeBounds::rule(NodeId id, const Node& n, const dsl::Output* reporter) {
  if (const int group = groups_.of(id); group >= 0) return leaf(group, n.op != Op::input);
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
        if (pair(operand).may_overflow) p.guards.push_back(value(operand));
      }
      return p;
    }
    case Op::div:
      if (predicate_.graph[n.b].op == Op::constant) {
        Pair p = scaled(pair(n.a), div_up(1, std::abs(predicate_.graph[n.b].value)), true);
        if (!weakened(Weakening::drop_division_rounding)) ++p.k;
        p.rounded = true;
        return p;
      }
      return computed_leaf(id, n);
    case Op::sqrt:
      return computed_leaf(id, n);
    case Op::select: {
      if (weakened(Weakening::drop_second_alternative)) return pair(n.b);
      Pair p = merged(pair(n.b), pair(n.c));
      p.B = MagnitudePolynomial::max(pair(n.b).B, pair(n.c).B);
      p.underflow = std::max(pair(n.b).underflow, pair(n.c).underflow);
      return p;
    }
    case Op::fma:
      return fused(n);
    case Op::certain_nonzero:
    case Op::certain_nonnegative:
    case Op::normalizer:
    case Op::max_magnitude:
      break;
  }
  report_unbounded(n, *reporter, BoundMode::safe, diagnostics_);
  return {};
}

// ------------------------------------------------------------------ B and the bound as nodes

/// B~ (F (1 + N theta) - 1) by raised maxima (header); no_node where they do not do: the threshold t would be felt, or
/// the bound itself could underflow.
NodeId SafeBounds::raised_bound(const Pair& p) {
  if (use_ranges_ || p.k == 0 || p.underflow_count == 0 || weakened(Weakening::drop_underflow)) return no_node;
  constexpr int least_threshold = 30;  // t = 2^-30 or below: inputs of that size are still told apart
  const int E = -format_.min_exponent - format_.significand_bits - 8;
  const int exponent = E / std::max(1, p.B.degree());
  const double theta = format_.eta / (p.least_sum * (1 - 0x1p-9)) * std::ldexp(1.0, E);
  const double loss = 2 * p.underflow_count * theta;  // F < 2
  double least_coefficient = INFINITY;
  for (const auto& [monomial, coefficient] : p.B.monomials()) {
    least_coefficient = std::min(least_coefficient, coefficient);
  }
  const bool fits = exponent >= least_threshold && p.underflow_count * loss < unit_ && least_coefficient >= 0x1p-8;
  if (!fits) return no_node;
  const double ku = p.k * unit_;
  return evaluate_raised(p.B, add_up(div_up(ku, 1 - ku), loss) * (1 + format_.slack), std::ldexp(1.0, -exponent),
                         groups_, r_);
}

/// factor * B: the factor goes into the coefficients, which are multiplied last.
NodeId SafeBounds::evaluate(const MagnitudePolynomial& B, double factor) {
  NodeId total = no_node;
  for (const auto& [monomial, coefficient] : B.monomials()) {
    NodeId product = no_node;
    for (std::size_t g = 0; g < monomial.size(); ++g) {
      if (monomial[g] == 0) continue;
      const NodeId p = r_.power(groups_.maximum(static_cast<int>(g), r_), monomial[g]);
      product = product == no_node ? p : r_.times(product, p);
    }
    const NodeId c = r_.constant(mul_up(coefficient, factor));
    total = r_.plus(total, product == no_node ? c : r_.times(product, c));
  }
  return total;
}

/// What `evaluate` may lose to underflow, in units of eta. Of a monomial of degree n with coefficient c, n - 1 products
/// of maxima lose at most eta / 2 each, which c and at most n - 1 further maxima amplify; the product with c loses as
/// much again. With ranges the maxima are at most max(1, range); without, the result is to be multiplied by m^(degree -
/// 1).
double SafeBounds::evaluation_loss(const MagnitudePolynomial& B, double factor) const {
  const std::vector<double> ranges = groups_.ranges();
  double loss = 0;
  for (const auto& [monomial, coefficient] : B.monomials()) {
    double degree = 0;
    double amplification = 1;
    double smallest = INFINITY;
    for (std::size_t g = 0; g < monomial.size(); ++g) {
      degree += monomial[g];
      if (monomial[g] == 0 || !use_ranges_) continue;
      const double most = std::max(1.0, ranges[g]);
      smallest = std::min(smallest, most);
      for (int e = 0; e < monomial[g]; ++e) amplification = mul_up(amplification, most);
    }
    if (smallest < INFINITY) amplification = div_up(amplification, smallest);
    loss = add_up(loss, add_up(mul_up(mul_up(mul_up(coefficient, factor), amplification), degree), 1));
  }
  return loss;
}

/// B ((1 + u)^k - 1) <= B k u / (1 - k u), where all inputs are exact.
NodeId SafeBounds::exact_input_bound(const Pair& p, double& loss) {
  if (p.k == 0) return no_node;
  const double ku = p.k * unit_;
  const double factor = div_up(ku, 1 - ku) * (1 + format_.slack);
  loss = evaluation_loss(p.B, factor);
  return evaluate(p.B, factor);
}

/// B F (k u + sum d rho) with F = (1 + slack) prod (1 + rho)^d. The constant in the sum also holds what rho, d rho and
/// the product with F may lose to underflow.
NodeId SafeBounds::bounded_input_bound(const Pair& p, double& loss) {
  int degrees = 0;
  for (const auto& [group, degree] : p.bounded_degrees) degrees += degree;
  NodeId x = r_.constant(add_up(p.k * unit_, 4 * degrees * format_.eta));
  NodeId spread = no_node;
  for (const auto& [group, degree] : p.bounded_degrees) {
    if (degree == 0) continue;
    const NodeId rho = groups_.relative_bound(group, r_);
    x = r_.plus(x, r_.times_constant(rho, degree));
    const NodeId factor = r_.power(r_.plus(rho, r_.constant(1)), degree);
    spread = spread == no_node ? factor : r_.times(spread, factor);
  }
  const NodeId B = evaluate(p.B, 1 + format_.slack);
  if (B == no_node) return no_node;
  // rho <= 1, so that F <= 2^d and the sum is at most k u + d.
  const double amplification = mul_up(std::exp2(degrees), add_up(p.k * unit_, degrees)) * (1 + 0x1p-9);
  loss = add_up(mul_up(evaluation_loss(p.B, 1 + format_.slack), amplification), 1);
  return r_.times(B, spread == no_node ? x : r_.times(spread, x));
}

/// A of the header, plus what the evaluation of the bound itself loses.
NodeId SafeBounds::underflow_bound(const Pair& p, double loss) {
  if ((p.underflow == 0 && loss == 0) || weakened(Weakening::drop_underflow)) return no_node;
  const double floor = mul_up(mul_up(add_up(p.underflow, loss) + 4 + p.B.degree(), format_.eta), 1 + 0x1p-9);
  if (use_ranges_) {
    largest_floor_ = std::max(largest_floor_, floor);
    return r_.constant(floor);
  }
  if (!(floor < 1)) roundings_ = INFINITY;  // reported as too many: degrees beyond all use
  const int degree = std::max(p.underflow_degree, p.B.degree() - 1);
  // Not a subnormal number: to multiply by one takes processors more than a hundred cycles.
  const NodeId c = r_.constant(std::max(floor, std::ldexp(1.0, format_.min_exponent)));
  return degree <= 0 ? c : r_.times(c, r_.power(groups_.overall_maximum(r_), degree));
}

NodeId SafeBounds::output_bound(NodeId id) {
  const Pair& p = pair(id);
  if (!p.rounded) return r_.zero_if_finite(value(id));
  NodeId bound = p.bounded_degrees.empty() ? raised_bound(p) : no_node;
  if (bound == no_node) {
    double loss = 0;
    bound = p.bounded_degrees.empty() ? exact_input_bound(p, loss) : bounded_input_bound(p, loss);
    bound = r_.plus(bound, underflow_bound(p, loss));
  }
  // The slack pays for the roundings in the bound, for 1 + 2u on every difference in B, and for (1 + u)^k in F.
  if (bound != no_node) roundings_ = std::max(roundings_, r_.roundings(bound) + 2 * p.B.degree() + p.k);
  return with_guards(bound, value(id), p);
}

/// Where a value may overflow, its B times k u may still be finite, and an infinity minus a large number has the wrong
/// sign as easily as the right one. x - x is 0 for a finite x, else NaN: an infinite value, or one that came from an
/// infinite operand of max or min, gets no sign.
NodeId SafeBounds::with_guards(NodeId bound, NodeId computed, const Pair& p) {
  const auto guard = [&](NodeId x) { bound = r_.plus(bound, r_.zero_if_finite(x)); };
  if (p.may_overflow || bound == no_node) guard(computed);
  for (const NodeId g : p.guards) guard(g);
  return bound;
}

/// The node that computes `n`; another where an operand stands behind a guard (and see computed_leaf).
NodeId SafeBounds::make_value(const Node& n) {
  const auto at = [&](NodeId id) { return id == no_node ? no_node : value(id); };
  return graph_.intern({n.op, at(n.a), at(n.b), at(n.c), n.index, n.value});
}

void SafeBounds::run(BoundedPredicate& result) {
  const NodeId count = predicate_.graph.size();
  const auto reporters = outputs_of_nodes(predicate_);
  const std::vector<bool> has_bound = value_nodes(predicate_);
  for (NodeId id = 0; id < count && !too_many_monomials_; ++id) {
    values_.push_back(make_value(predicate_.graph[id]));
    if (!has_bound[static_cast<std::size_t>(id)]) {  // decides what is selected: any number will do
      pairs_.emplace_back();
      continue;
    }
    pairs_.push_back(rule(id, predicate_.graph[id], reporters[static_cast<std::size_t>(id)]));
    Pair& p = pairs_.back();
    // 2^d is the most that F of the bounded groups can be.
    double spread = 2;
    for (const auto& [group, degree] : p.bounded_degrees) spread *= std::exp2(degree);
    p.may_overflow = p.may_overflow || !use_ranges_ || !(limit(p.B) * spread < format_.largest / 2);
    too_many_monomials_ = pairs_.back().B.terms() > most_monomials && !one_group_;
  }
  if (too_many_monomials_) return;
  for (const auto& stage : predicate_.stages) {
    BoundedStage& bounded = result.stages.emplace_back();
    for (const auto& output : stage.outputs) {
      OutputBound& entry = bounded.outputs.emplace_back();
      const Pair* widest = nullptr;
      for (const NodeId id : output.nodes) {
        entry.elements.push_back({value(id), output_bound(id)});
        if (!widest || pair(id).k > widest->k) widest = &pair(id);
      }
      entry.roundings = widest->k;
      entry.magnitude = widest->B.text(groups_.names());
      if (use_ranges_) entry.assumption = "inputs within their declared ranges";
    }
  }
}

}  // namespace

void add_safe_bounds(const dsl::Predicate& predicate, const FloatFormat& format, dsl::Diagnostics& diagnostics,
                     Weakening weakening, BoundedPredicate& result) {
  bool one_group = false;
  bool use_ranges = all_inputs_have_ranges(predicate);
  for (;;) {
    BoundedPredicate attempt;
    attempt.graph = predicate.graph;
    dsl::Diagnostics found;
    SafeBounds bounds(predicate, format, weakening, one_group, use_ranges, found, attempt.graph);
    bounds.run(attempt);
    if (found.has_errors()) {
      for (const auto& d : found.entries()) diagnostics.error(d.span, d.message, d.hint);
      return;
    }
    if (bounds.too_many_monomials()) {
      one_group = true;
    } else if (use_ranges && bounds.largest_floor() > format.floor_limit) {
      use_ranges = false;
    } else if (format.slack > 0 && 2 * bounds.roundings() * format.unit_roundoff > format.slack) {
      diagnostics.error(predicate.stages.front().outputs.front().span,
                        "the error bound of this predicate takes too many roundings for the precision");
      return;
    } else {
      result = std::move(attempt);
      return;
    }
  }
}

}  // namespace tightrope::codegen
