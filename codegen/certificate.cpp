#include "codegen/certificate.h"

#include <fmt/format.h>

#include <cassert>

#include "codegen/interface.h"

namespace tightrope::codegen {
namespace {

using dsl::Graph;
using dsl::Node;
using dsl::NodeId;
using dsl::Op;

std::string number(double value) {
  const std::string text = literal(std::abs(value), Precision::binary64);
  return value < 0 ? "(-" + text + ")" : text;
}

class ScriptPrinter {
 public:
  ScriptPrinter(const dsl::Predicate& predicate, const Graph& graph, Precision precision)
      : predicate_(predicate), graph_(graph), precision_(precision), slots_(slot_expressions(predicate)) {}

  std::optional<std::string> print(const Claim& claim);

 private:
  void line(const std::string& text) { (out_ += text) += '\n'; }
  void define_input(NodeId id, const Node& n);
  bool define(NodeId id, const Node& n);
  bool define_scaling(NodeId id, const Node& n);
  bool define_absolute(NodeId id, const Node& n);
  /// Operand as computed or exact; inputs and constants are spelled where they are used.
  std::string operand(NodeId id, char kind) const;
  std::string own(NodeId id) const { return std::to_string(numbers_[static_cast<std::size_t>(id)]); }
  std::vector<NodeId> cone(NodeId root);

  const dsl::Predicate& predicate_;
  const Graph& graph_;
  Precision precision_;
  std::vector<std::string> slots_;
  std::vector<int> numbers_;  ///< by node, in the script
  std::vector<std::string> hypotheses_;
  std::string hints_;  ///< rewriting rules: identities that Gappa checks but does not find
  std::string out_;
};

std::string ScriptPrinter::operand(NodeId id, char kind) const {
  const Node& n = graph_[id];
  if (n.op == Op::constant) return number(n.value);
  return fmt::format("{}{}", kind, numbers_[static_cast<std::size_t>(id)]);
}

/// The nodes that `root` needs, operands first, numbered as a walk from the root meets them: outputs that differ in
/// their inputs alone get the same script.
std::vector<NodeId> ScriptPrinter::cone(NodeId root) {
  numbers_.assign(static_cast<std::size_t>(graph_.size()), -1);
  std::vector<NodeId> order;
  std::vector<std::pair<NodeId, bool>> open = {{root, false}};
  while (!open.empty()) {
    const auto [id, operands_done] = open.back();
    open.pop_back();
    int& number = numbers_[static_cast<std::size_t>(id)];
    if (number >= 0) continue;
    if (operands_done) {
      number = static_cast<int>(order.size());
      order.push_back(id);
      continue;
    }
    open.emplace_back(id, true);
    const Node& n = graph_[id];
    const bool guard = n.op == Op::certain_nonzero || n.op == Op::certain_nonnegative;
    for (const NodeId operand : {n.c, guard ? dsl::no_node : n.b, n.a}) {
      if (operand != dsl::no_node) open.emplace_back(operand, false);
    }
  }
  return order;
}

void ScriptPrinter::define_input(NodeId id, const Node& n) {
  const dsl::Slot& slot = predicate_.slots[static_cast<std::size_t>(n.index)];
  const dsl::Parameter& p = predicate_.parameters[static_cast<std::size_t>(slot.parameter)];
  const std::string k = own(id);
  const std::string range = literal(*p.range, Precision::binary64);
  line(fmt::format("v{} = rnd(x{});  # {}", k, k, slots_[static_cast<std::size_t>(n.index)]));
  hypotheses_.push_back(fmt::format("|v{}| <= {}", k, range));
  if (p.bounded) {
    line(fmt::format("e{} = y{};", k, k));
    hypotheses_.push_back(fmt::format("|v{0} - e{0}| <= {1}", k, range));
  } else {
    line(fmt::format("e{0} = v{0};", k));
  }
}

/// A scaling is exact but for an error of at most eta / 2 where its result is subnormal, an unknown d of the script:
/// Gappa would charge rnd(v * 1b-1) a full rounding.
bool ScriptPrinter::define_scaling(NodeId id, const Node& n) {
  const std::string scaled = fmt::format("{} * 1b{}", operand(n.a, 'v'), n.index);
  if (n.index >= 0) {
    line(fmt::format("v{} = {};", own(id), scaled));
  } else {
    line(fmt::format("v{0} = {1} + d{0};", own(id), scaled));
    hypotheses_.push_back(fmt::format("|d{}| <= 1b{}", own(id), precision_ == Precision::binary64 ? -1075 : -150));
    hints_ += fmt::format("v{0} - e{0} -> ({1} - {2}) * 1b{3} + d{0};\n", own(id), operand(n.a, 'v'), operand(n.a, 'e'),
                          n.index);
  }
  line(fmt::format("e{} = {} * 1b{};", own(id), operand(n.a, 'e'), n.index));
  return true;
}

/// ||a^| - |a|| <= |a^ - a|, which Gappa does not know: |a^| = |a| + s (a^ - a) for some s in [-1, 1].
bool ScriptPrinter::define_absolute(NodeId id, const Node& n) {
  const std::string error = fmt::format("({} - {})", operand(n.a, 'v'), operand(n.a, 'e'));
  line(fmt::format("e{} = |{}|;", own(id), operand(n.a, 'e')));
  line(fmt::format("v{0} = e{0} + s{0} * {1};", own(id), error));
  hypotheses_.push_back(fmt::format("|s{}| <= 1", own(id)));
  hints_ += fmt::format("v{0} - e{0} -> s{0} * {1};\n", own(id), error);
  return true;
}

/// False if Gappa has no such operation.
bool ScriptPrinter::define(NodeId id, const Node& n) {
  const auto define_as = [&](const std::string& form, bool rounded) {
    for (const char kind : {'v', 'e'}) {
      const std::string a = n.a == dsl::no_node ? "" : operand(n.a, kind);
      const std::string b = n.b == dsl::no_node ? "" : operand(n.b, kind);
      const std::string c = n.c == dsl::no_node ? "" : operand(n.c, kind);
      const std::string expression =
          fmt::format(fmt::runtime(form), fmt::arg("a", a), fmt::arg("b", b), fmt::arg("c", c));
      line(rounded && kind == 'v' ? fmt::format("v{} = rnd({});", own(id), expression)
                                  : fmt::format("{}{} = {};", kind, own(id), expression));
    }
    return true;
  };
  switch (n.op) {
    case Op::input:
      define_input(id, n);
      return true;
    case Op::constant:
      return true;
    case Op::add:
      return define_as("{a} + {b}", true);
    case Op::sub:
      return define_as("{a} - {b}", true);
    case Op::neg:
      return define_as("-{a}", false);
    case Op::mul:
      return define_as("{a} * {b}", true);
    case Op::mul_pow2:
      return define_scaling(id, n);
    case Op::div:
      return define_as("{a} / {b}", true);
    case Op::sqrt:
      return define_as("sqrt({a})", true);
    case Op::abs:
      return define_absolute(id, n);
    case Op::fma:
      return define_as("{a} * {b} + {c}", true);
    case Op::certain_nonzero:  // the guards pass on what the ranges make certain
    case Op::certain_nonnegative:
      return define_as("{a}", false);
    case Op::min:
    case Op::max:
    case Op::max_magnitude:
    case Op::normalizer:
    case Op::select:
      return false;
  }
  return false;
}

std::optional<std::string> ScriptPrinter::print(const Claim& claim) {
  for (std::size_t begin = 0; begin < claim.comment.size();) {
    const std::size_t end = std::min(claim.comment.find('\n', begin), claim.comment.size());
    line("# " + comment_text(std::string_view(claim.comment).substr(begin, end - begin)));
    begin = end + 1;
  }
  line(fmt::format("@rnd = float<ieee_{}, ne>;", precision_ == Precision::binary64 ? 64 : 32));
  for (const NodeId id : cone(claim.value)) {
    if (!define(id, graph_[id])) return std::nullopt;
  }
  const std::string error = fmt::format("{} - {}", operand(claim.value, 'v'), operand(claim.value, 'e'));
  std::string goals;
  for (const double bound : claim.bounds) {
    goals += fmt::format("|{}| <= {} /\\ ", error, literal(bound, Precision::binary64));
  }
  line("{ " + fmt::format("{}", fmt::join(hypotheses_, " /\\\n  ")) + (hypotheses_.empty() ? "" : "\n  ->\n  ") +
       goals + error + " in ? }");
  out_ += hints_;
  return std::move(out_);
}

}  // namespace

std::optional<std::string> gappa_script(const dsl::Predicate& predicate, const Graph& graph, const Claim& claim,
                                        Precision precision) {
  return ScriptPrinter(predicate, graph, precision).print(claim);
}

}  // namespace tightrope::codegen
