/// Every rule with one of its terms left out: the exhaustive check must find violations. Prints the table.

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/rules/rule_check.h"

namespace tightrope::rules {
namespace {

using codegen::BoundMode;
using codegen::Weakening;

/// The operation of a case's result, and whether it is the only one.
struct Operation {
  dsl::Op op;
  bool alone;
};

Operation operation(const RuleCase& rule) {
  const dsl::Predicate p = predicate_of(rule);
  int operations = 0;
  for (dsl::NodeId id = 0; id < p.graph.size(); ++id) operations += dsl::operand_count(p.graph[id].op) > 0 ? 1 : 0;
  return {p.graph[p.stages[0].outputs[0].nodes[0]].op, operations == 1};
}

struct Found {
  bool has_term = false;
  std::string where;  ///< the first counterexample
};

template <class Mini>
void look_for_violation(const RuleCase& rule, const Check& check, Found& found) {
  if (!found.where.empty() || !RuleCheck<Mini>(rule, check).has_term()) return;
  found.has_term = true;
  const Tally tally = RuleCheck<Mini>(rule, check).run();
  if (tally.violations > 0) found.where = fmt::format("<{}> {}", Mini::digits, tally.counterexample);
}

/// Looks in the cases of one operation first, then in the compositions that end with it: whether a one-operation rule
/// has the term, and where leaving it out shows.
Found find(dsl::Op op, BoundMode mode, Weakening weakening) {
  Found found;
  for (const bool alone : {true, false}) {
    for (const RuleCase& rule : rule_cases()) {
      const Operation of_case = operation(rule);
      if (of_case.op != op || of_case.alone != alone || (!alone && !found.has_term)) continue;
      for (const Form form : {Form::ideal, Form::computed}) {
        Check check;
        check.mode = mode;
        check.form = form;
        check.weakening = weakening;
        check.most_samples = 1e6;
        look_for_violation<MiniFloat<4, 5>>(rule, check, found);
        look_for_violation<MiniFloat<4, 3>>(rule, check, found);
      }
    }
  }
  return found;
}

/// Terms that a rule has and that no violation shows, each with the reason.
const std::map<std::string, std::string>& reserves() {
  static const std::map<std::string, std::string> all = {
      {"safe add drop_underflow", "a sum does not underflow; the term is for the evaluation of B"},
      {"safe sub drop_underflow", "a sum does not underflow; the term is for the evaluation of B"},
      {"safe neg drop_underflow", "exact; the term is for the evaluation of B"},
      {"safe abs drop_underflow", "exact; the term is for the evaluation of B"},
      {"safe min drop_underflow", "exact; the term is for the evaluation of B"},
      {"safe max drop_underflow", "exact; the term is for the evaluation of B"},
      {"safe select drop_underflow", "exact; the term is for the evaluation of B"},
  };
  return all;
}

class WeakenedRule : public ::testing::TestWithParam<BoundMode> {};

TEST_P(WeakenedRule, IsNoticed) {
  std::set<dsl::Op> operations;
  for (const RuleCase& rule : rule_cases()) operations.insert(operation(rule).op);
  for (int i = 1; *name(static_cast<Weakening>(i)) != 0; ++i) {
    for (const dsl::Op op : operations) {
      const Found found = find(op, GetParam(), static_cast<Weakening>(i));
      if (!found.has_term) continue;
      const std::string pair =
          fmt::format("{} {} {}", name(GetParam()), dsl::op_name(op), name(static_cast<Weakening>(i)));
      const auto reserve = reserves().find(pair);
      const bool expected = reserve == reserves().end();
      fmt::print("{:48} {}\n", pair, found.where.empty() ? expected ? "-" : reserve->second : found.where);
      EXPECT_TRUE(!expected || !found.where.empty()) << pair;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Modes, WeakenedRule,
                         ::testing::Values(BoundMode::tight, BoundMode::safe, BoundMode::fixed, BoundMode::interval),
                         [](const auto& mode) { return std::string(name(mode.param)); });

}  // namespace
}  // namespace tightrope::rules
