#include "tests/rules/rule_cases.h"

#include <utility>

namespace tightrope::rules {

namespace {

using dsl::Graph;
using dsl::NodeId;
using dsl::Op;
using Operands = std::span<const NodeId>;

constexpr Operand exact{};
constexpr Operand bounded{true, {}};

std::vector<Operand> with_range(std::vector<Operand> operands, double range) {
  for (Operand& operand : operands) operand.range = range;
  return operands;
}

RuleCase binary(std::string name, Op op, Operand a, Operand b, int lemma_factors = 0) {
  RuleCase rule{std::move(name), {a, b}, {}};
  rule.build = [op](Graph& g, Operands x) { return g.binary(op, x[0], x[1]); };
  rule.lemma_factors = lemma_factors;
  rule.forgets_infinities = op == Op::min || op == Op::max;
  return rule;
}

RuleCase unary(std::string name, Operand a, std::function<NodeId(Graph&, NodeId)> build, bool turns_at_zero = false) {
  RuleCase rule{std::move(name), {a}, {}};
  rule.build = [build = std::move(build)](Graph& g, Operands x) { return build(g, x[0]); };
  rule.turns_at_zero = turns_at_zero;
  return rule;
}

RuleCase composed(std::string name, std::vector<Operand> operands, std::function<NodeId(Graph&, Operands)> build,
                  int lemma_factors = 0, bool turns_at_zero = false) {
  RuleCase rule{std::move(name), std::move(operands), std::move(build)};
  rule.turns_at_zero = turns_at_zero;
  rule.lemma_factors = lemma_factors;
  return rule;
}

NodeId difference(Graph& g, Operands x, std::size_t first) { return g.sub(x[first], x[first + 1]); }

std::vector<RuleCase> sums() {
  return {
      binary("a + b, exact", Op::add, exact, exact),       binary("a - b, exact", Op::sub, exact, exact),
      binary("a + b, bounded", Op::add, bounded, bounded), binary("a - b, bounded", Op::sub, bounded, bounded),
      binary("a - b, b bounded", Op::sub, exact, bounded),
  };
}

std::vector<RuleCase> products() {
  return {
      binary("a b, exact", Op::mul, exact, exact, 4),
      binary("a b, bounded", Op::mul, bounded, bounded),
      binary("a b, a bounded", Op::mul, bounded, exact, 4),
      binary("a b, b bounded", Op::mul, exact, bounded, 4),
      composed(
          "(a - b)(c - d), exact", {exact, exact, exact, exact},
          [](Graph& g, Operands x) { return g.mul(difference(g, x, 0), difference(g, x, 2)); }, 5),
      composed(
          "(a - b) c, exact", {exact, exact, exact},
          [](Graph& g, Operands x) { return g.mul(difference(g, x, 0), x[2]); }, 4),
      composed(
          "(a - b) c, c bounded", {exact, exact, bounded},
          [](Graph& g, Operands x) { return g.mul(difference(g, x, 0), x[2]); }, 5),
      composed(
          "a (b - c), a bounded", {bounded, exact, exact},
          [](Graph& g, Operands x) { return g.mul(x[0], difference(g, x, 1)); }, 5),
  };
}

std::vector<RuleCase> constants_and_scalings() {
  const auto times = [](double c) { return [c](Graph& g, NodeId x) { return g.mul(x, g.constant(c)); }; };
  const auto over = [](double c) { return [c](Graph& g, NodeId x) { return g.binary(Op::div, x, g.constant(c)); }; };
  const auto scaled = [](int k) { return [k](Graph& g, NodeId x) { return g.mul_pow2(x, k); }; };
  std::vector<RuleCase> cases;
  for (const Operand a : {exact, bounded}) {
    const std::string kind = a.bounded ? ", bounded" : ", exact";
    for (const double c : {3.0, -5.0, 0.75}) {
      const std::string number = c == 3 ? "3" : c == -5 ? "-5" : "0.75";
      cases.push_back(unary(number + " a" + kind, a, times(c)));
      cases.push_back(unary("a / " + number + kind, a, over(c)));
      for (RuleCase* rule : {&cases.back(), &*(cases.end() - 2)}) rule->lemma_factors = 4;
    }
    for (const int k : {3, -1, -3}) cases.push_back(unary("2^" + std::to_string(k) + " a" + kind, a, scaled(k)));
    cases.push_back(unary("-a" + kind, a, [](Graph& g, NodeId x) { return g.neg(x); }));
    cases.push_back(unary(
        "|a|" + kind, a, [](Graph& g, NodeId x) { return g.abs(x); }, true));
  }
  const auto of_difference = [](auto last) {
    return [last](Graph& g, Operands x) { return last(g, difference(g, x, 0)); };
  };
  cases.push_back(composed("3 (a - b), exact", {exact, exact}, of_difference(times(3)), 4));
  cases.push_back(composed("(a - b) / 3, exact", {exact, exact}, of_difference(over(3)), 4));
  cases.push_back(composed("2^3 (a - b), exact", {exact, exact}, of_difference(scaled(3))));
  cases.push_back(composed("2^-3 (a - b), exact", {exact, exact}, of_difference(scaled(-3))));
  return cases;
}

std::vector<RuleCase> extrema() {
  std::vector<RuleCase> cases;
  for (const auto& [op, name] : {std::pair{Op::min, "min"}, std::pair{Op::max, "max"}}) {
    cases.push_back(binary(std::string(name) + "(a, b), exact", op, exact, exact));
    cases.push_back(binary(std::string(name) + "(a, b), bounded", op, bounded, bounded));
    cases.push_back(binary(std::string(name) + "(a, b), b bounded", op, exact, bounded));
  }
  return cases;
}

/// Operand 0 is the condition: finite and exact, so that what is selected is the same in exact arithmetic.
RuleCase selection(std::string name, std::vector<Operand> operands, std::function<NodeId(Graph&, Operands)> build) {
  operands.front().range = 1;
  RuleCase rule = composed(std::move(name), std::move(operands), std::move(build), 4);
  rule.forgets_nans = true;
  return rule;
}

std::vector<RuleCase> selections() {
  const auto of_two = [](Graph& g, Operands x) { return g.select(x[0], x[1], x[2]); };
  return {
      selection("c >= 0 ? a : b, exact", {exact, exact, exact}, of_two),
      selection("c >= 0 ? a : b, bounded", {exact, bounded, bounded}, of_two),
      selection("c >= 0 ? a : b, b bounded", {exact, exact, bounded}, of_two),
      selection("c >= 0 ? a - b : b", {exact, exact, exact},
                [](Graph& g, Operands x) { return g.select(x[0], difference(g, x, 1), x[2]); }),
      selection("c >= 0 ? a : 3 b, exact", {exact, exact, exact},
                [](Graph& g, Operands x) { return g.select(x[0], x[1], g.mul(g.constant(3), x[2])); }),
      selection("(c >= 0 ? a - b : a) b, exact", {exact, exact, exact},
                [](Graph& g, Operands x) { return g.mul(g.select(x[0], difference(g, x, 1), x[1]), x[2]); }),
  };
}

std::vector<RuleCase> quotients_roots_fma() {
  const auto root_of = [](std::string name, Operand a) {
    RuleCase rule = unary(std::move(name), a, [](Graph& g, NodeId x) { return g.unary(Op::sqrt, x); });
    rule.lemma_factors = 2;
    return rule;
  };
  const auto fma = [](Graph& g, Operands x) { return g.fma(x[0], x[1], x[2]); };
  return {
      binary("a / b, exact", Op::div, exact, exact, 4),
      binary("a / b, bounded", Op::div, bounded, bounded, 4),
      binary("a / b, a bounded", Op::div, bounded, exact, 4),
      binary("a / b, b bounded", Op::div, exact, bounded, 4),
      composed(
          "1 / a, bounded", {bounded}, [](Graph& g, Operands x) { return g.binary(Op::div, g.constant(1), x[0]); }, 4),
      root_of("sqrt(a), exact", exact),
      root_of("sqrt(a), bounded", bounded),
      composed("fma(a, b, c), exact", {exact, exact, exact}, fma, 4),
      composed("fma(a, b, c), bounded", {bounded, bounded, bounded}, fma, 4),
      composed("fma(a, b, c), b bounded", {exact, bounded, exact}, fma, 4),
      composed("fma(a, b, c), c bounded", {exact, exact, bounded}, fma, 4),
  };
}

std::vector<RuleCase> compositions() {
  RuleCase larger = composed(
      "max(a b, c), exact", {exact, exact, exact},
      [](Graph& g, Operands x) { return g.binary(Op::max, g.mul(x[0], x[1]), x[2]); }, 4);
  larger.forgets_infinities = true;
  const auto sum_of_products = [](Graph& g, Operands x) { return g.add(g.mul(x[0], x[1]), g.mul(x[2], x[3])); };
  const auto square_sum = [](Graph& g, Operands x) { return g.add(g.mul(x[0], x[0]), g.mul(x[1], x[1])); };
  return {
      composed("a b + c d, exact", {exact, exact, exact, exact}, sum_of_products, 5),
      composed(
          "(a + b)(c + d), bounded a", {bounded, exact, exact, exact},
          [](Graph& g, Operands x) { return g.mul(g.add(x[0], x[1]), g.add(x[2], x[3])); }, 5),
      composed(
          "(a b) c, exact", {exact, exact, exact}, [](Graph& g, Operands x) { return g.mul(g.mul(x[0], x[1]), x[2]); },
          9),
      composed(
          "a b + c, bounded c", {exact, exact, bounded},
          [](Graph& g, Operands x) { return g.add(g.mul(x[0], x[1]), x[2]); }, 4),
      composed(
          "(a - b) / c, exact", {exact, exact, exact},
          [](Graph& g, Operands x) { return g.binary(Op::div, difference(g, x, 0), x[2]); }, 5),
      composed(
          "a / (b - c), exact", {exact, exact, exact},
          [](Graph& g, Operands x) { return g.binary(Op::div, x[0], difference(g, x, 1)); }, 5),
      composed(
          "(a / b) c, exact", {exact, exact, exact},
          [](Graph& g, Operands x) { return g.mul(g.binary(Op::div, x[0], x[1]), x[2]); }, 9),
      composed(
          "a / b + c, exact", {exact, exact, exact},
          [](Graph& g, Operands x) { return g.add(g.binary(Op::div, x[0], x[1]), x[2]); }, 4),
      larger,
      composed(
          "sqrt(a a + b b), exact", {exact, exact},
          [square_sum](Graph& g, Operands x) { return g.unary(Op::sqrt, square_sum(g, x)); }, 5, true),
      composed(
          "sqrt(a - b), bounded a", {bounded, exact},
          [](Graph& g, Operands x) { return g.unary(Op::sqrt, difference(g, x, 0)); }, 2),
      composed(
          "b sqrt(a), exact", {exact, exact}, [](Graph& g, Operands x) { return g.mul(x[1], g.unary(Op::sqrt, x[0])); },
          4),
      composed(
          "sqrt(a) - b, exact", {exact, exact},
          [](Graph& g, Operands x) { return g.sub(g.unary(Op::sqrt, x[0]), x[1]); }, 2),
      composed(
          "sqrt(|a - b|), exact", {exact, exact},
          [](Graph& g, Operands x) { return g.unary(Op::sqrt, g.abs(difference(g, x, 0))); }, 3),
  };
}

/// The same rules where every operand has a declared range, so that underflow is a compile-time floor (lemma C).
std::vector<RuleCase> ranged() {
  std::vector<RuleCase> cases;
  for (const auto& group : {sums(), products(), extrema(), selections(), quotients_roots_fma(), compositions()}) {
    for (const RuleCase& rule : group) {
      if (rule.operands.size() > 3) continue;
      cases.push_back(rule);
      cases.back().operands = with_range(rule.operands, 2);
      cases.back().name += ", range 2";
    }
  }
  for (const RuleCase& rule : constants_and_scalings()) {
    cases.push_back(rule);
    cases.back().operands = with_range(rule.operands, 1);
    cases.back().name += ", range 1";
  }
  return cases;
}

}  // namespace

const std::vector<RuleCase>& rule_cases() {
  static const std::vector<RuleCase> all = [] {
    std::vector<RuleCase> cases;
    for (const auto& group : {sums(), products(), constants_and_scalings(), extrema(), selections(),
                              quotients_roots_fma(), compositions(), ranged()}) {
      cases.insert(cases.end(), group.begin(), group.end());
    }
    return cases;
  }();
  return all;
}

dsl::Predicate predicate_of(const RuleCase& rule) {
  dsl::Predicate p;
  p.name = "rule";
  std::vector<NodeId> inputs;
  for (std::size_t i = 0; i < rule.operands.size(); ++i) {
    dsl::Parameter parameter;
    parameter.name = std::string(1, static_cast<char>('a' + i));
    parameter.bounded = rule.operands[i].bounded;
    parameter.range = rule.operands[i].range;
    parameter.first_slot = static_cast<int>(i);
    p.parameters.push_back(parameter);
    p.slots.push_back({static_cast<int>(i), 0, 0, 0});
    inputs.push_back(p.graph.input(static_cast<std::int32_t>(i)));
  }
  dsl::Output output;
  output.name = "out";
  output.nodes = {rule.build(p.graph, inputs)};
  p.stages.push_back({"evaluate", {output}});
  return p;
}

}  // namespace tightrope::rules
