#include "codegen/schedule.h"

#include <gtest/gtest.h>

#include <random>

#include "codegen/count.h"
#include "tests/unit/codegen/test_program.h"

namespace tightrope::codegen {
namespace {

using dsl::Graph;
using dsl::NodeId;
using dsl::Op;

/// A random predicate of `stages` stages whose bounds are just other nodes.
BoundedPredicate random_predicate(std::uint64_t seed, int stages) {
  std::mt19937_64 random(seed);
  BoundedPredicate result;
  const auto pick = [&] { return static_cast<NodeId>(random() % static_cast<std::uint64_t>(result.graph.size())); };
  for (int i = 0; i < 4; ++i) result.graph.input(i);
  result.graph.constant(3);
  for (int i = 0; i < 60; ++i) {
    switch (random() % 5) {
      case 0:
        result.graph.add(pick(), pick());
        break;
      case 1:
        result.graph.sub(pick(), pick());
        break;
      case 2:
        result.graph.mul(pick(), pick());
        break;
      case 3:
        result.graph.abs(pick());
        break;
      default:
        result.graph.mul_pow2(pick(), 3);
        break;
    }
  }
  for (int s = 0; s < stages; ++s) {
    OutputBound output;
    for (int e = 0; e < 3; ++e) output.elements.push_back({pick(), e == 0 ? dsl::no_node : pick()});
    result.stages.push_back({{output}});
  }
  return result;
}

/// "" if the schedule computes every output of every stage from what is at hand, each node in one stage only.
std::string violation(const BoundedPredicate& predicate, const Schedule& schedule) {
  const Graph& graph = predicate.graph;
  const auto size = static_cast<std::size_t>(graph.size());
  std::vector<bool> computed(size, false);
  std::vector<bool> loaded_ever(size, false);
  if (schedule.stages.size() != predicate.stages.size()) return "number of stages";
  for (std::size_t s = 0; s < schedule.stages.size(); ++s) {
    std::vector<bool> here(size, false);
    const auto at_hand = [&](NodeId id) {
      return id == dsl::no_node || graph[id].op == Op::input || graph[id].op == Op::constant ||
             here[static_cast<std::size_t>(id)];
    };
    std::size_t outputs = 0;
    for (const Step& step : schedule.stages[s].steps) {
      const auto i = static_cast<std::size_t>(step.node);
      switch (step.kind) {
        case Step::Kind::load:
          if (!computed[i] || here[i]) return "loads what is not there";
          loaded_ever[i] = here[i] = true;
          break;
        case Step::Kind::compute:
          if (computed[i]) return "computed twice";
          for (const NodeId operand : {graph[step.node].a, graph[step.node].b, graph[step.node].c}) {
            if (!at_hand(operand)) return "operand not at hand";
          }
          computed[i] = here[i] = true;
          break;
        case Step::Kind::output: {
          const auto& element = predicate.stages[s]
                                    .outputs[static_cast<std::size_t>(step.output)]
                                    .elements[static_cast<std::size_t>(step.element)];
          if (step.node != element.value || !at_hand(element.value) || !at_hand(element.bound))
            return "output too soon";
          ++outputs;
          break;
        }
      }
    }
    if (outputs != predicate.stages[s].outputs[0].elements.size()) return "number of outputs";
  }
  return schedule.saved == loaded_ever ? "" : "saves something else than what is loaded";
}

TEST(Schedule, ComputesEveryNodeOnceAfterItsOperandsAndSavesWhatLaterStagesLoad) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const BoundedPredicate predicate = random_predicate(seed, 1 + static_cast<int>(seed % 4));
    EXPECT_EQ(violation(predicate, schedule(predicate)), "") << "seed " << seed;
  }
}

TEST(Schedule, TheCheckAboveNoticesAMissingStep) {
  int noticed = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const BoundedPredicate predicate = random_predicate(seed, 2);
    Schedule broken = schedule(predicate);
    if (broken.stages[0].steps.size() < 4) continue;
    broken.stages[0].steps.erase(broken.stages[0].steps.begin());
    EXPECT_NE(violation(predicate, broken), "") << "seed " << seed;
    ++noticed;
  }
  EXPECT_GT(noticed, 30);
}

TEST(Schedule, HeavierOperandComesFirst) {
  BoundedPredicate p;
  Graph& g = p.graph;
  const NodeId a = g.input(0);
  const NodeId b = g.input(1);
  const NodeId light = g.add(a, b);
  const NodeId heavy = g.mul(g.sub(a, b), g.sub(b, a));
  const NodeId root = g.sub(light, heavy);
  p.stages = {{{OutputBound{{{root, dsl::no_node}}, 0, "", ""}}}};
  const auto steps = schedule(p).stages[0].steps;
  ASSERT_EQ(steps.size(), 6U);
  EXPECT_EQ(steps[2].node, heavy);
  EXPECT_EQ(steps[3].node, light);
  EXPECT_EQ(steps[4].node, root);
  EXPECT_EQ(steps[5].kind, Step::Kind::output);
}

TEST(Schedule, ChainOfAMillionNodesNeedsNoCallStack) {
  BoundedPredicate p;
  NodeId x = p.graph.input(0);
  const NodeId one = p.graph.constant(1);
  for (int i = 0; i < 1'000'000; ++i) x = p.graph.add(x, one);
  p.stages = {{{OutputBound{{{x, dsl::no_node}}, 0, "", ""}}}};
  EXPECT_EQ(schedule(p).stages[0].steps.size(), 1'000'001U);
}

TEST(Count, SharedNodesAreCountedInTheirFirstStageAndValuesApartFromBounds) {
  BoundedPredicate p;
  Graph& g = p.graph;
  const NodeId product = g.mul(g.input(0), g.input(1));
  const NodeId size = g.abs(product);
  const NodeId sum = g.add(product, g.input(2));
  p.stages = {{{OutputBound{{{product, size}}, 0, "", ""}}}, {{OutputBound{{{sum, size}}, 0, "", ""}}}};
  const auto costs = stage_costs(p, schedule(p));
  ASSERT_EQ(costs.size(), 2U);
  EXPECT_EQ(text(costs[0].value), "1 (1 product)");
  EXPECT_EQ(text(costs[0].bound), "1 (1 exact)");
  EXPECT_EQ(text(costs[1].value), "1 (1 sum)");
  EXPECT_EQ(text(costs[1].bound), "0");
  const Cost alone = output_cost(p, p.stages[1].outputs[0]);
  EXPECT_EQ(text(alone.value), "2 (1 sum, 1 product)");
  EXPECT_EQ(text(alone.bound), "1 (1 exact)");
}

}  // namespace
}  // namespace tightrope::codegen
