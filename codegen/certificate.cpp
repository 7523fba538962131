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

/// "x_a_t0_1" for slot expression "a_t0[1]": no other name of a script starts with x.
std::string input_name(const std::string& slot) {
  std::string name = "x_";
  for (const char c : slot) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (plain) {
      name += c;
    } else if (name.back() != '_') {
      name += '_';
    }
  }
  while (name.back() == '_') name.pop_back();
  return name;
}

std::string number(double value) {
  const std::string text = literal(std::abs(value), Precision::binary64);
  return value < 0 ? "(-" + text + ")" : text;
}

class ScriptPrinter {
 public:
  ScriptPrinter(const dsl::Predicate& predicate, const Graph& graph)
      : predicate_(predicate), graph_(graph), slots_(slot_expressions(predicate)) {}

  std::optional<std::string> print(const Claim& claim, Precision precision);

 private:
  void line(const std::string& text) { (out_ += text) += '\n'; }
  void define_input(NodeId id, const Node& n);
  bool define(NodeId id, const Node& n);
  /// Operand as computed or exact; inputs and constants are spelled where they are used.
  std::string operand(NodeId id, char kind) const;

  const dsl::Predicate& predicate_;
  const Graph& graph_;
  std::vector<std::string> slots_;
  std::vector<std::string> hypotheses_;
  std::string out_;
};

std::string ScriptPrinter::operand(NodeId id, char kind) const {
  const Node& n = graph_[id];
  if (n.op == Op::constant) return number(n.value);
  return fmt::format("{}{}", kind, id);
}

void ScriptPrinter::define_input(NodeId id, const Node& n) {
  const dsl::Slot& slot = predicate_.slots[static_cast<std::size_t>(n.index)];
  const dsl::Parameter& p = predicate_.parameters[static_cast<std::size_t>(slot.parameter)];
  const std::string name = input_name(slots_[static_cast<std::size_t>(n.index)]);
  line(fmt::format("v{} = rnd({});", id, name));
  const std::string range = literal(*p.range, Precision::binary64);
  hypotheses_.push_back(fmt::format("|v{}| <= {}", id, range));
  if (p.bounded) {
    line(fmt::format("e{} = {}_exact;", id, name));
    hypotheses_.push_back(fmt::format("|v{0} - e{0}| <= {1}", id, range));
  } else {
    line(fmt::format("e{0} = v{0};", id));
  }
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
      line(rounded && kind == 'v' ? fmt::format("v{} = rnd({});", id, expression)
                                  : fmt::format("{}{} = {};", kind, id, expression));
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
      return define_as(fmt::format("{{a}} * 1b{}", n.index), true);
    case Op::div:
      return define_as("{a} / {b}", true);
    case Op::sqrt:
      return define_as("sqrt({a})", true);
    case Op::abs:
      return define_as("|{a}|", false);
    case Op::fma:
      return define_as("{a} * {b} + {c}", true);
    case Op::certain_nonzero:  // the guards pass on what the ranges make certain
    case Op::certain_nonnegative:
      return define_as("{a}", false);
    case Op::min:
    case Op::max:
    case Op::max_magnitude:
      return false;
  }
  return false;
}

std::optional<std::string> ScriptPrinter::print(const Claim& claim, Precision precision) {
  for (std::size_t begin = 0; begin < claim.comment.size();) {
    const std::size_t end = std::min(claim.comment.find('\n', begin), claim.comment.size());
    line("# " + comment_text(std::string_view(claim.comment).substr(begin, end - begin)));
    begin = end + 1;
  }
  line(fmt::format("@rnd = float<ieee_{}, ne>;", precision == Precision::binary64 ? 64 : 32));
  std::vector<bool> needed(static_cast<std::size_t>(graph_.size()), false);
  needed[static_cast<std::size_t>(claim.value)] = true;
  for (NodeId id = claim.value; id >= 0; --id) {
    if (!needed[static_cast<std::size_t>(id)]) continue;
    const Node& n = graph_[id];
    const bool guard = n.op == Op::certain_nonzero || n.op == Op::certain_nonnegative;
    for (const NodeId operand : {n.a, guard ? dsl::no_node : n.b, n.c}) {
      if (operand != dsl::no_node) needed[static_cast<std::size_t>(operand)] = true;
    }
  }
  for (NodeId id = 0; id <= claim.value; ++id) {
    if (needed[static_cast<std::size_t>(id)] && !define(id, graph_[id])) return std::nullopt;
  }
  const std::string error = fmt::format("{} - {}", operand(claim.value, 'v'), operand(claim.value, 'e'));
  std::string goals;
  for (const double bound : claim.bounds) {
    goals += fmt::format("|{}| <= {} /\\ ", error, literal(bound, Precision::binary64));
  }
  line("{ " + fmt::format("{}", fmt::join(hypotheses_, " /\\\n  ")) + (hypotheses_.empty() ? "" : "\n  ->\n  ") +
       goals + error + " in ? }");
  return std::move(out_);
}

}  // namespace

std::optional<std::string> gappa_script(const dsl::Predicate& predicate, const Graph& graph, const Claim& claim,
                                        Precision precision) {
  return ScriptPrinter(predicate, graph).print(claim, precision);
}

}  // namespace tightrope::codegen
