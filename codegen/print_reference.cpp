#include "codegen/print_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <vector>

#include "codegen/interface.h"

namespace tightrope::codegen {
namespace {

using dsl::Node;
using dsl::NodeId;
using dsl::Op;

/// Inputs that each test tries.
constexpr int fewest_cases = 100;
constexpr int most_cases = 2500;

std::string call(const Node& node, const std::vector<int>& line) {
  const auto at = [&](NodeId id) { return line[static_cast<std::size_t>(id)]; };
  switch (node.op) {
    case Op::input:
      return fmt::format("input({})", node.index);
    case Op::constant:
      return fmt::format("constant({})", literal(node.value, Precision::binary64));
    case Op::add:
      return fmt::format("add({}, {})", at(node.a), at(node.b));
    case Op::sub:
      return fmt::format("sub({}, {})", at(node.a), at(node.b));
    case Op::neg:
      return fmt::format("neg({})", at(node.a));
    case Op::mul:
      return fmt::format("mul({}, {})", at(node.a), at(node.b));
    case Op::mul_pow2:
      return fmt::format("scale({}, {})", at(node.a), node.index);
    case Op::div:
      return fmt::format("div({}, {})", at(node.a), at(node.b));
    case Op::sqrt:
      return fmt::format("sqrt({})", at(node.a));
    case Op::abs:
      return fmt::format("abs({})", at(node.a));
    case Op::min:
      return fmt::format("min({}, {})", at(node.a), at(node.b));
    case Op::max:
      return fmt::format("max({}, {})", at(node.a), at(node.b));
    case Op::fma:
      return fmt::format("fma({}, {}, {})", at(node.a), at(node.b), at(node.c));
    case Op::max_magnitude:
      return fmt::format("larger({}, {})", at(node.a), at(node.b));
    case Op::select:
      return fmt::format("select({}, {}, {})", at(node.a), at(node.b), at(node.c));
    case Op::certain_nonzero:
    case Op::certain_nonnegative:
    case Op::normalizer:
      break;
  }
  assert(false && "lowered predicates hold no operations of bounds");
  return {};
}

std::string parameter_names(const dsl::Predicate& predicate, const std::vector<int>& parameters) {
  std::string text;
  for (const int p : parameters) {
    text += (text.empty() ? "" : ", ") + predicate.parameters[static_cast<std::size_t>(p)].name;
  }
  return text;
}

/// Slot i of the permuted inputs is slot [i] of the inputs: each listed parameter takes the place of the one before.
std::vector<int> slot_permutation(const dsl::Predicate& predicate, const std::vector<int>& parameters) {
  std::vector<int> permutation(predicate.slots.size());
  for (std::size_t i = 0; i < permutation.size(); ++i) permutation[i] = static_cast<int>(i);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const dsl::Parameter& to = predicate.parameters[static_cast<std::size_t>(parameters[i])];
    const dsl::Parameter& from =
        predicate.parameters[static_cast<std::size_t>(parameters[(i + 1) % parameters.size()])];
    for (int k = 0; k < to.slots(); ++k) {
      permutation[static_cast<std::size_t>(to.first_slot + k)] = from.first_slot + k;
    }
  }
  return permutation;
}

class ReferencePrinter {
 public:
  ReferencePrinter(const dsl::Predicate& predicate, int budget) : predicate_(predicate), budget_(budget) {}

  std::string print(bool same_values) {
    print_operations();
    print_parameters();
    print_outputs();
    print_properties();
    print_table(same_values);
    return std::move(out_);
  }

 private:
  const std::string& name() const { return predicate_.name; }
  void line(std::string_view text) { (out_ += text) += '\n'; }

  /// `head` {a, b, c};
  void print_list(const std::string& head, std::vector<std::string> items) {
    for (std::size_t i = 0; i < items.size(); ++i) items[i] += i + 1 < items.size() ? "," : "};";
    if (items.empty()) return line(head + "{};");
    line(head + "{");
    line(wrap("    ", items));
  }

  void print_operations();
  void print_parameters();
  void print_outputs();
  void print_properties();
  void print_table(bool same_values);

  const dsl::Predicate& predicate_;
  int budget_;
  int operations_ = 0;
  std::string out_;
};

/// The nodes that outputs need, renumbered.
void ReferencePrinter::print_operations() {
  const dsl::Graph& graph = predicate_.graph;
  std::vector<bool> needed(static_cast<std::size_t>(graph.size()), false);
  for (const dsl::Stage& stage : predicate_.stages) {
    for (const dsl::Output& output : stage.outputs) {
      for (const NodeId id : output.nodes) needed[static_cast<std::size_t>(id)] = true;
    }
  }
  for (NodeId id = graph.size() - 1; id >= 0; --id) {
    if (!needed[static_cast<std::size_t>(id)]) continue;
    for (const NodeId operand : {graph[id].a, graph[id].b, graph[id].c}) {
      if (operand != dsl::no_node) needed[static_cast<std::size_t>(operand)] = true;
    }
  }
  std::vector<int> numbers(needed.size(), -1);
  std::vector<std::string> calls;
  for (NodeId id = 0; id < graph.size(); ++id) {
    if (!needed[static_cast<std::size_t>(id)]) continue;
    numbers[static_cast<std::size_t>(id)] = static_cast<int>(calls.size());
    calls.push_back(call(graph[id], numbers));
  }
  operations_ = static_cast<int>(calls.size());
  std::vector<std::string> results;
  for (const dsl::Stage& stage : predicate_.stages) {
    for (const dsl::Output& output : stage.outputs) {
      for (const NodeId id : output.nodes) results.push_back(std::to_string(numbers[static_cast<std::size_t>(id)]));
    }
  }
  line(fmt::format("\n// {}: the exact values, direct products, nothing simplified.\n// clang-format off", name()));
  print_list(fmt::format("constexpr Operation {}_operations[] = ", name()), std::move(calls));
  print_list(fmt::format("constexpr int {}_results[] = ", name()), std::move(results));
}

void ReferencePrinter::print_parameters() {
  std::vector<std::string> items;
  for (const dsl::Parameter& p : predicate_.parameters) {
    const double range = p.range.value_or(std::numeric_limits<double>::infinity());
    const std::string normalized = p.normalized < 0 ? "" : fmt::format(", {}", p.normalized);
    items.push_back(fmt::format("{{\"{}\", {}, {}, {}, {}, {}, {}{}}}", p.name, p.elements(), p.moving ? 2 : 1,
                                p.dimension, p.bounded, p.point, literal(range, Precision::binary64), normalized));
  }
  print_list(fmt::format("const std::vector<Parameter> {}_parameters = ", name()), std::move(items));
}

void ReferencePrinter::print_outputs() {
  std::vector<std::string> items;
  for (const dsl::Stage& stage : predicate_.stages) {
    for (const dsl::Output& output : stage.outputs) {
      items.push_back(fmt::format("{{\"{}\", {{{}}}, {}}}", output.name, fmt::join(output.extents, ", "), output.sign));
    }
  }
  print_list(fmt::format("const std::vector<Output> {}_outputs = ", name()), std::move(items));
}

void ReferencePrinter::print_properties() {
  std::vector<std::vector<int>> first_element;  // by stage, by output
  int element = 0;
  for (const dsl::Stage& stage : predicate_.stages) {
    first_element.emplace_back();
    for (const dsl::Output& output : stage.outputs) {
      first_element.back().push_back(element);
      element += static_cast<int>(output.nodes.size());
    }
  }
  std::vector<std::string> items;
  for (const dsl::Property& p : predicate_.properties) {
    std::vector<int> elements;
    for (const auto& [stage, output] : p.outputs) {
      const auto s = static_cast<std::size_t>(stage);
      const auto o = static_cast<std::size_t>(output);
      for (std::size_t i = 0; i < predicate_.stages[s].outputs[o].nodes.size(); ++i) {
        elements.push_back(first_element[s][o] + static_cast<int>(i));
      }
    }
    std::string_view kind = "permutation";
    if (p.kind == dsl::Property::Kind::translation_invariant) kind = "translation";
    if (p.kind == dsl::Property::Kind::scale) kind = "scale";
    const int factor = p.kind == dsl::Property::Kind::antisymmetric ? -1 : 1;
    std::vector<int> permutation;
    if (kind == "permutation") permutation = slot_permutation(predicate_, p.parameters);
    items.push_back(fmt::format("{{\"{}\", Property::Kind::{}, {}, {}, {{{}}}, {{{}}}}}", property_text(predicate_, p),
                                kind, factor, p.exponent, fmt::join(permutation, ", "), fmt::join(elements, ", ")));
  }
  print_list(fmt::format("const std::vector<Property> {}_properties = ", name()), std::move(items));
}

void ReferencePrinter::print_table(bool same_values) {
  const int cases = std::clamp(budget_ / std::max(1, operations_), fewest_cases, most_cases);
  std::vector<std::string> items = {fmt::format("\"{}\"", name())};
  for (const std::string_view part : {"operations", "parameters", "outputs", "results", "properties"}) {
    items.push_back(fmt::format("{}_{}", name(), part));
  }
  items.push_back(fmt::format("{}", same_values));
  items.push_back(fmt::format("{}", cases));
  print_list(fmt::format("const Reference {}_reference = ", name()), std::move(items));
  line("// clang-format on");
}

}  // namespace

std::string property_text(const dsl::Predicate& predicate, const dsl::Property& p) {
  const std::string names = parameter_names(predicate, p.parameters);
  switch (p.kind) {
    case dsl::Property::Kind::antisymmetric:
      return fmt::format("antisymmetric({})", names);
    case dsl::Property::Kind::symmetric:
      return fmt::format("symmetric({})", names);
    case dsl::Property::Kind::cyclic:
      return fmt::format("cyclic({})", names);
    case dsl::Property::Kind::translation_invariant:
      return "translation_invariant";
    case dsl::Property::Kind::scale:
      return fmt::format("scale({})", p.exponent);
  }
  return {};
}

std::string print_reference(const dsl::Predicate& predicate, bool same_values, int budget) {
  return ReferencePrinter(predicate, budget).print(same_values);
}

}  // namespace tightrope::codegen
