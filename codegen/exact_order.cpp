#include "codegen/exact_order.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace tightrope::codegen {
namespace {

/// Beyond these, integers of one or two words an input make more code than they save time.
constexpr std::size_t most_nodes[] = {3000, 800};
constexpr int most_words[] = {24, 16};

/// What a tier should leave for inputs: a double's significand and some difference in exponents.
constexpr int fewest_bits[] = {57, 110};
constexpr int most_bits[] = {62, 126};

bool is_leaf(const ExactNode& n) { return n.op == ExactOp::input || n.op == ExactOp::whole; }

std::vector<ExactId> roots_of(const ExactElement& element, ExactPart part) {
  std::vector<ExactId> roots;
  for (const ExactGuard& guard : element.guards) roots.push_back(guard.node);
  if (part == ExactPart::signs) {
    roots.push_back(element.sign);
  } else {
    roots.push_back(element.numerator.node);
    if (element.denominator != -1) roots.push_back(element.denominator);
  }
  return roots;
}

class Walk {
 public:
  Walk(const ExactGraph& graph, ExactOrder& result) : graph_(graph), result_(result) {
    visited_.assign(static_cast<std::size_t>(graph.size()), false);
  }

  /// Depth first. Among the nodes that an element adds, those that more elements need stand first, so that nodes of one
  /// mask follow each other; operands stay first, because an operand's mask contains its users'.
  void add(const std::vector<ExactId>& roots) {
    const auto begin = static_cast<std::ptrdiff_t>(result_.nodes.size());
    for (const ExactId root : roots) visit(root);
    std::stable_sort(result_.nodes.begin() + begin, result_.nodes.end(),
                     [&](ExactId x, ExactId y) { return users(x) > users(y); });
  }

 private:
  int users(ExactId id) const { return std::popcount(result_.wanted[static_cast<std::size_t>(id)]); }

  void visit(ExactId root) {
    std::vector<std::pair<ExactId, std::size_t>> stack = {{root, 0}};
    while (!stack.empty()) {
      auto& [id, next] = stack.back();
      const ExactNode& n = graph_[id];
      if (next == 0 && visited_[static_cast<std::size_t>(id)]) {
        stack.pop_back();
        continue;
      }
      visited_[static_cast<std::size_t>(id)] = true;
      const ExactId operands[] = {n.a, n.b, n.c};
      if (next < 3) {
        const ExactId operand = operands[next++];
        if (operand != -1) stack.push_back({operand, 0});
        continue;
      }
      if (!is_leaf(n)) result_.nodes.push_back(id);
      if (n.op == ExactOp::raised) result_.raises = true;
      stack.pop_back();
    }
  }

  const ExactGraph& graph_;
  ExactOrder& result_;
  std::vector<bool> visited_;
};

}  // namespace

std::size_t element_count(const dsl::Stage& stage) {
  std::size_t count = 0;
  for (const dsl::Output& output : stage.outputs) count += output.nodes.size();
  return count;
}

int wanted_bit(std::size_t element, std::size_t count) {
  return static_cast<int>(count <= 64 ? element : element * 64 / count);
}

void for_each_element(const dsl::Stage& stage, const ExactStage& exact, ExactPart part, const ExactVisitor& visit) {
  std::size_t index = 0;
  for (std::size_t o = 0; o < stage.outputs.size(); ++o) {
    for (const ExactElement& element : exact.outputs[o].elements) {
      const bool wanted = part == ExactPart::signs ? stage.outputs[o].sign : element.rational;
      if (wanted) visit(index, stage.outputs[o], element);
      ++index;
    }
  }
}

ExactOrder exact_order(const dsl::Stage& stage, const ExactProgram& program, std::size_t index, ExactPart part) {
  const ExactGraph& graph = program.graph;
  ExactOrder result;
  result.wanted.assign(static_cast<std::size_t>(graph.size()), 0);
  const std::size_t count = element_count(stage);
  std::uint64_t all = 0;
  const auto each = [&](const ExactVisitor& visit) { for_each_element(stage, program.stages[index], part, visit); };
  each([&](std::size_t i, const dsl::Output&, const ExactElement& element) {
    const auto bit = std::uint64_t{1} << wanted_bit(i, count);
    all |= bit;
    for (const ExactId root : roots_of(element, part)) result.wanted[static_cast<std::size_t>(root)] |= bit;
    result.slots.insert(result.slots.end(), element.slots.begin(), element.slots.end());
  });
  for (ExactId id = graph.size() - 1; id >= 0; --id) {
    const std::uint64_t mask = result.wanted[static_cast<std::size_t>(id)];
    if (mask == 0) continue;
    for (const ExactId operand : {graph[id].a, graph[id].b, graph[id].c}) {
      if (operand != -1) result.wanted[static_cast<std::size_t>(operand)] |= mask;
    }
  }
  Walk walk(graph, result);
  each([&](std::size_t, const dsl::Output&, const ExactElement& element) { walk.add(roots_of(element, part)); });
  std::sort(result.slots.begin(), result.slots.end());
  result.slots.erase(std::unique(result.slots.begin(), result.slots.end()), result.slots.end());
  result.several = std::any_of(result.nodes.begin(), result.nodes.end(),
                               [&](ExactId id) { return result.wanted[static_cast<std::size_t>(id)] != all; });
  return result;
}

int widest_words(const ExactGraph& graph, const ExactOrder& order, int input_bits) {
  int words = input_bits / 64 + 1;
  for (const ExactId id : order.nodes) {
    words = std::max(words, (graph[id].degree * input_bits + growth_bits(graph[id])) / 64 + 1);
  }
  return words;
}

int fixed_input_bits(const ExactGraph& graph, const ExactOrder& order, int words) {
  const auto tier = static_cast<std::size_t>(words - 1);
  if (order.nodes.size() > most_nodes[tier]) return 0;
  int bits = most_bits[tier];
  for (const ExactId id : order.nodes) {
    const ExactNode& n = graph[id];
    if (n.growth > largest_growth) return 0;
    if (n.degree > 0) bits = std::min(bits, (64 * words * n.degree - 1 - growth_bits(n)) / n.degree);
  }
  bits = std::max(bits, fewest_bits[tier]);
  return widest_words(graph, order, bits) <= most_words[tier] ? bits : 0;
}

}  // namespace tightrope::codegen
