/// Every bound rule on every number of miniature formats: no bound below the error, in any mode.
///
/// The environment variable TIGHTROPE_RULE_SAMPLES says up to how many combinations of operands nothing is left out.

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "tests/rules/rule_check.h"

namespace tightrope::rules {
namespace {

using codegen::BoundMode;

/// Nothing is left out in the smallest format where four exact operands, or two with their bounds, are combined: 59^4
/// (but in mode interval) and 59^2 30^2.
double most_samples_of_the_smallest(const RuleCase& rule, BoundMode mode) {
  const bool bounded =
      std::any_of(rule.operands.begin(), rule.operands.end(), [](const Operand& x) { return x.bounded; });
  return bounded || mode == BoundMode::interval ? 3.2e6 : 1.3e7;
}

double most_samples() {
  const char* wanted = std::getenv("TIGHTROPE_RULE_SAMPLES");
  return wanted ? std::atof(wanted) : 1e5;
}

struct Sums {
  int checks = 0;
  double samples = 0;
  double certain = 0;
  std::set<std::string> covered;  ///< cases that were checked in some form
};

template <class Mini>
void check_all(BoundMode mode, Form form, double most, Sums& sums) {
  for (const RuleCase& rule : rule_cases()) {
    Check check;
    check.mode = mode;
    check.form = form;
    check.most_samples = most;
    if constexpr (Mini::magnitude_bits == 5)
      check.most_samples = std::max(most, most_samples_of_the_smallest(rule, mode));
    const Tally tally = RuleCheck<Mini>(rule, check).run();
    if (tally.refused) continue;
    EXPECT_EQ(tally.violations, 0) << tally.counterexample;
    ++sums.checks;
    sums.samples += static_cast<double>(tally.samples);
    sums.certain += static_cast<double>(tally.certain);
    sums.covered.insert(rule.name);
  }
}

/// Whether the mode has a rule for this case at all, in double precision.
bool has_rule(const RuleCase& rule, BoundMode mode) {
  dsl::Diagnostics diagnostics;
  const auto bounded = codegen::add_bounds(predicate_of(rule), mode, codegen::Precision::binary64, diagnostics);
  return !diagnostics.has_errors() && !bounded.stages.empty();
}

class EveryRule : public ::testing::TestWithParam<BoundMode> {};

TEST_P(EveryRule, HoldsForAllNumbersOfMiniatureFormats) {
  const BoundMode mode = GetParam();
  Sums ideal, computed;
  check_all<MiniFloat<3, 3>>(mode, Form::ideal, most_samples(), ideal);
  check_all<MiniFloat<4, 3>>(mode, Form::ideal, most_samples(), ideal);
  check_all<MiniFloat<4, 5>>(mode, Form::ideal, most_samples(), ideal);
  check_all<MiniFloat<4, 3>>(mode, Form::computed, most_samples(), computed);
  check_all<MiniFloat<4, 4>>(mode, Form::computed, most_samples(), computed);
  check_all<MiniFloat<4, 5>>(mode, Form::computed, most_samples(), computed);
  for (const RuleCase& rule : rule_cases()) {
    if (!has_rule(rule, mode)) continue;
    EXPECT_TRUE(ideal.covered.count(rule.name) + computed.covered.count(rule.name) > 0)
        << rule.name << " has a rule in mode " << name(mode) << " that no miniature format can check";
  }
  for (const auto& [form, sums] : {std::pair{"ideal", &ideal}, std::pair{"computed", &computed}}) {
    fmt::print("{:8} {:8} {} cases in {} checks, {:.3g} combinations, {:.0f} % with a bound\n", name(mode), form,
               sums->covered.size(), sums->checks, sums->samples, 100 * sums->certain / std::max(1.0, sums->samples));
    EXPECT_TRUE(sums->checks == 0 || sums->certain > 0.1 * sums->samples);
  }
}

INSTANTIATE_TEST_SUITE_P(Modes, EveryRule,
                         ::testing::Values(BoundMode::tight, BoundMode::safe, BoundMode::fixed, BoundMode::interval),
                         [](const auto& mode) { return std::string(name(mode.param)); });

/// A predicate of the operation alone, over inputs that are bounded or exact, with ranges or without.
bool has_rule(dsl::Op op, BoundMode mode) {
  for (const bool bounded : {false, true}) {
    for (const bool ranges : {false, true}) {
      RuleCase rule;
      rule.operands.assign(3, Operand{bounded, ranges ? std::optional(4.0) : std::nullopt});
      rule.build = [op](dsl::Graph& g, std::span<const dsl::NodeId> x) {
        dsl::Node node{.op = op, .a = x[0], .b = x[1], .c = x[2]};
        const int operands = dsl::operand_count(op);
        if (operands < 3) node.c = dsl::no_node;
        if (operands < 2) node.b = dsl::no_node;
        if (op == dsl::Op::mul_pow2) node.index = 3;
        return g.intern(node);
      };
      if (has_rule(rule, mode)) return true;
    }
  }
  return false;
}

/// No rule is accepted without an exhaustive check: an operation that some mode bounds has a case of its own.
TEST(EveryRule, HasACase) {
  std::set<dsl::Op> with_case;
  for (const RuleCase& rule : rule_cases()) {
    const dsl::Predicate p = predicate_of(rule);
    with_case.insert(p.graph[p.stages[0].outputs[0].nodes[0]].op);
  }
  for (int i = 0; *dsl::op_name(static_cast<dsl::Op>(i)) != 0; ++i) {
    const auto op = static_cast<dsl::Op>(i);
    if (dsl::operand_count(op) == 0) continue;
    for (const BoundMode mode : {BoundMode::tight, BoundMode::safe, BoundMode::fixed, BoundMode::interval}) {
      EXPECT_TRUE(with_case.count(op) == 1 || !has_rule(op, mode)) << dsl::op_name(op) << " in mode " << name(mode);
    }
  }
}

}  // namespace
}  // namespace tightrope::rules
