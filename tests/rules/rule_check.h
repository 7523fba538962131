#pragma once
/// The exhaustive check: one rule case, in one mode, on all operands and error bounds that a MiniFloat has.

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "codegen/precision.h"
#include "dsl/evaluate.h"
#include "tests/rules/judge.h"
#include "tests/rules/mini_float.h"
#include "tests/rules/rule_cases.h"

namespace tightrope::rules {

/// How the bound is evaluated. MATH 4.3: in the format itself, with a slack that pays for the bound's own roundings
/// (the form that generated code has); or exactly, with no slack at all, on the values that the format computed.
enum class Form { computed, ideal };

struct Check {
  codegen::BoundMode mode = codegen::BoundMode::tight;
  Form form = Form::computed;
  codegen::Weakening weakening = codegen::Weakening::none;
  double most_samples = 1e7;         ///< more than that, and operands are thinned, see thinned()
  std::int64_t most_violations = 1;  ///< stops after that many
};

struct Tally {
  bool refused = false;      ///< the mode has no rule for this case, or the format is too small for its roundings
  double slack = 0;          ///< of the computed form
  int thinning = 0;          ///< 0: all numbers of the format
  std::int64_t samples = 0;  ///< operands with their bounds
  std::int64_t certain = 0;  ///< of these, finite bounds: the ones that claim anything
  std::int64_t violations = 0;
  std::string counterexample;
};

/// The numbers of a format that stand for all where there are too many combinations. Level 1 keeps the first two and
/// the last number of every binade (where roundings change their size), level 2 the first and the last, level 3 the
/// first two and the last of every second binade, level 4 the first of every second, level 5 of every fourth, and so
/// on; 0 and the largest always stay.
inline constexpr int most_thinning = 6;

template <class Mini>
std::vector<Mini> thinned(int level) {
  std::vector<Mini> kept;
  constexpr int size = 1 << (Mini::digits - 1);
  for (const Mini x : Mini::magnitudes()) {
    const int place = x.magnitude() % size;
    const int binade = x.magnitude() / size;
    const bool first = place == 0;
    const bool last = place == size - 1;
    const bool near = first || place == 1 || last;
    const bool keep = level == 0 || (level == 1 && near) || (level == 2 && (first || last)) ||
                      (level == 3 && binade % 2 == 0 && near) ||
                      (level >= 4 && binade % (1 << (level - 3)) == 0 && first) || x.code() == Mini::largest().code();
    if (keep) kept.push_back(x);
  }
  return kept;
}

/// The largest slack that the linear condition slack >= 2 D u of the compiler may choose: beyond it, (1 + 2 D u) does
/// not make up for (1 - u)^D.
inline double largest_honest_slack(double u) {
  double slack = 0;
  for (double d = 1; d * u < 4 && (1 + 2 * d * u) * std::pow(1 - u, d) >= 1; ++d) slack = 2 * d * u;
  return slack;
}

template <class Mini>
class RuleCheck {
 public:
  RuleCheck(const RuleCase& rule, const Check& check)
      : rule_(rule), check_(check), predicate_(predicate_of(rule)), judge_(predicate_, rule.turns_at_zero, true) {}

  /// Whether the weakening changes anything here: whether the rule has such a term.
  bool has_term() {
    if (!add_bounds()) return false;
    const std::string weakened = dsl::print(bounded_.graph);
    const dsl::NodeId bound = result_.bound;
    const codegen::Weakening weakening = std::exchange(check_.weakening, codegen::Weakening::none);
    add_bounds();
    check_.weakening = weakening;
    return weakened != dsl::print(bounded_.graph) || bound != result_.bound;
  }

  Tally run() {
    if (!add_bounds()) return tally_;
    choose_operands();
    sort_nodes();
    slots_.assign(2 * predicate_.slots.size(), Mini());
    ideal_slots_.assign(slots_.size(), 0);
    values_.assign(static_cast<std::size_t>(bounded_.graph.size()), Mini());
    ideal_values_.assign(values_.size(), 0);
    operands_.assign(predicate_.slots.size(), Interval{});
    evaluate(0);
    descend(0, true);
    return tally_;
  }

 private:
  /// One input slot that runs through numbers; nodes are evaluated as soon as the last slot they need is set.
  struct Loop {
    std::size_t slot = 0;
    bool bound = false;
    std::vector<Mini> numbers;
  };

  bool try_bounds(double slack) {
    dsl::Diagnostics diagnostics;
    bounded_ = codegen::add_bounds(predicate_, check_.mode, Mini::format(slack), diagnostics, check_.weakening);
    return !diagnostics.has_errors() && !bounded_.stages.empty();
  }

  /// With the least slack that the compiler accepts.
  bool add_bounds() {
    const double u = Mini::format(0).unit_roundoff;
    bool made = check_.form == Form::ideal && try_bounds(0);
    if (check_.form == Form::computed) {
      for (double slack = 2 * u; slack <= largest_honest_slack(u) && !made; slack += 2 * u) {
        made = try_bounds(slack);
        tally_.slack = slack;
      }
    }
    tally_.refused = !made;
    if (!made) return false;
    result_ = bounded_.stages[0].outputs[0].elements[0];
    return true;
  }

  void choose_operands() {
    for (int level = 0;; ++level) {
      loops_.clear();
      double samples = 1;
      for (std::size_t i = 0; i < predicate_.slots.size(); ++i) {
        add_loop(i, false, level);
        samples *= static_cast<double>(loops_.back().numbers.size());
        if (!rule_.operands[i].bounded) continue;
        add_loop(i, true, level);
        samples *= static_cast<double>(loops_.back().numbers.size());
      }
      tally_.thinning = level;
      if (samples <= check_.most_samples || level == most_thinning) return;
    }
  }

  /// Non-finite inputs and bounds too, unless they are out of a declared range.
  void add_loop(std::size_t operand, bool bound, int level) {
    const auto range = rule_.operands[operand].range;
    Loop loop{operand + (bound ? predicate_.slots.size() : 0), bound, {}};
    for (const Mini x : thinned<Mini>(level)) {
      if (range && x.to_double() > *range) continue;
      loop.numbers.push_back(x);
      if (!bound) loop.numbers.push_back(-x);
    }
    if (!range) {
      loop.numbers.push_back(Mini::infinity());
      loop.numbers.push_back(Mini::quiet_NaN());
      if (!bound) loop.numbers.push_back(-Mini::infinity());
    }
    loops_.push_back(std::move(loop));
  }

  /// Which nodes belong to which loop, and which are values (not of the bound): those are never evaluated exactly.
  void sort_nodes() {
    const dsl::Graph& g = bounded_.graph;
    nodes_.assign(loops_.size() + 1, {});
    std::vector<std::size_t> level(static_cast<std::size_t>(g.size()), 0);
    is_value_.assign(level.size(), false);
    is_value_[static_cast<std::size_t>(result_.value)] = true;
    for (dsl::NodeId id = g.size() - 1; id >= 0; --id) {
      const dsl::Node& n = g[id];
      if (!is_value_[static_cast<std::size_t>(id)]) continue;
      const bool guard = n.op == dsl::Op::certain_nonzero || n.op == dsl::Op::certain_nonnegative;
      for (const dsl::NodeId operand : {n.a, guard ? dsl::no_node : n.b, n.c}) {
        if (operand != dsl::no_node) is_value_[static_cast<std::size_t>(operand)] = true;
      }
    }
    for (dsl::NodeId id = 0; id < g.size(); ++id) {
      const dsl::Node& n = g[id];
      std::size_t& l = level[static_cast<std::size_t>(id)];
      for (const dsl::NodeId operand : {n.a, n.b, n.c}) {
        if (operand != dsl::no_node) l = std::max(l, level[static_cast<std::size_t>(operand)]);
      }
      for (std::size_t i = 0; n.op == dsl::Op::input && i < loops_.size(); ++i) {
        if (loops_[i].slot == static_cast<std::size_t>(n.index)) l = i + 1;
      }
      nodes_[l].push_back(id);
    }
  }

  void evaluate(std::size_t level) {
    const auto at = [this](dsl::NodeId id) { return values_[static_cast<std::size_t>(id)]; };
    const auto ideal_at = [this](dsl::NodeId id) { return ideal_values_[static_cast<std::size_t>(id)]; };
    for (const dsl::NodeId id : nodes_[level]) {
      const dsl::Node& n = bounded_.graph[id];
      const std::size_t i = static_cast<std::size_t>(id);
      if (check_.form == Form::computed) {
        values_[i] = dsl::evaluate_node<Mini>(n, slots_, at);
        continue;
      }
      if (is_value_[i]) values_[i] = value_beside_ideal_bounds(n, at);
      ideal_values_[i] = is_value_[i] ? values_[i].to_double() : dsl::evaluate_node<double>(n, ideal_slots_, ideal_at);
    }
  }

  /// Guards compare a computed value with an ideal bound.
  template <class Values>
  Mini value_beside_ideal_bounds(const dsl::Node& n, const Values& at) const {
    const bool strictly = n.op == dsl::Op::certain_nonzero;
    if (!strictly && n.op != dsl::Op::certain_nonnegative) return dsl::evaluate_node<Mini>(n, slots_, at);
    const Mini x = at(n.a);
    const double bound = ideal_values_[static_cast<std::size_t>(n.b)];
    const bool holds = strictly ? std::abs(x.to_double()) > bound : x.to_double() >= bound;
    return holds ? x : Mini::quiet_NaN();
  }

  void descend(std::size_t level, bool finite_inputs) {
    if (level == loops_.size()) return judge(finite_inputs);
    const Loop& loop = loops_[level];
    for (const Mini x : loop.numbers) {
      slots_[loop.slot] = x;
      ideal_slots_[loop.slot] = x.to_double();
      if (loop.bound) {
        operands_[loop.slot - predicate_.slots.size()].radius = x.to_double();
      } else {
        operands_[loop.slot].centre = x.to_double();
      }
      evaluate(level + 1);
      descend(level + 1, finite_inputs && x.is_finite());
      if (tally_.violations >= check_.most_violations) return;
    }
  }

  /// The ideal bound as a number that is not below it: its evaluation in double rounds in quotients and roots alone.
  double bound() const {
    if (check_.form == Form::computed) return values_[static_cast<std::size_t>(result_.bound)].to_double();
    const double u = std::ldexp(1.0, -Mini::digits);
    return ideal_values_[static_cast<std::size_t>(result_.bound)] * std::pow(1 + u, rule_.lemma_factors) *
           (1 + 0x1p-45);
  }

  /// A claim is a bound that is a number: it must hold. A value that is none, or comes from an input that is none, must
  /// have no sign.
  void judge(bool finite_inputs) {
    ++tally_.samples;
    const double limit = bound();
    if (!std::isfinite(limit)) return;
    const Mini result = values_[static_cast<std::size_t>(result_.value)];
    const double value = result.to_double();
    if (result.is_nan()) return;
    ++tally_.certain;
    const bool wrong = finite_inputs && result.is_finite() ? judge_.violated(operands_, value, limit)
                                                           : std::abs(value) > limit && !infinity_is_forgotten();
    if (!wrong || tally_.violations++ > 0) return;
    tally_.counterexample = fmt::format("{} = {} +- {} for", rule_.name, value, limit);
    for (const Interval& x : operands_) tally_.counterexample += fmt::format(" [{} +- {}]", x.centre, x.radius);
  }

  bool infinity_is_forgotten() const {
    if (rule_.forgets_nans) return true;
    return rule_.forgets_infinities && std::none_of(operands_.begin(), operands_.end(), [](const Interval& x) {
             return std::isnan(x.centre) || !std::isfinite(x.radius);
           });
  }

  const RuleCase& rule_;
  Check check_;
  dsl::Predicate predicate_;
  Judge<double> judge_;
  codegen::BoundedPredicate bounded_;
  codegen::BoundedNode result_;
  std::vector<Loop> loops_;
  std::vector<std::vector<dsl::NodeId>> nodes_;  ///< by level: 0 constants, i + 1 after loop i
  std::vector<bool> is_value_;
  std::vector<Mini> slots_, values_;
  std::vector<double> ideal_slots_, ideal_values_;
  std::vector<Interval> operands_;
  Tally tally_;
};

}  // namespace tightrope::rules
