#include "codegen/print_exact.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "codegen/exact_order.h"

namespace tightrope::codegen {
namespace {

constexpr std::string_view sign_type = "::tightrope::ExactSign";
constexpr std::string_view dyadic = "::tightrope::Dyadic";

bool is_dyadic(const ExactElement& e) { return e.denominator == -1 && e.numerator.factor.odd_denominator() == 1; }

/// A whole number of at most 126 bits.
std::string whole(dsl::Int128 value) {
  return fmt::format("q::whole({:#x}U, {:#x}U)", static_cast<std::uint64_t>(value >> 64),
                     static_cast<std::uint64_t>(value));
}

class ExactPrinter {
 public:
  ExactPrinter(const ExactPredicate& exact, Precision precision)
      : predicate_(*exact.predicate),
        program_(*exact.program),
        real_(codegen::name(precision)),
        arguments_(codegen::arguments(predicate_)),
        slots_(slot_expressions(predicate_)),
        several_stages_(predicate_.stages.size() > 1) {
    for (std::size_t i = 0; i < predicate_.slots.size(); ++i) {
      const auto parameter = static_cast<std::size_t>(predicate_.slots[i].parameter);
      if (!predicate_.parameters[parameter].bounded) continue;
      bounded_ = true;
      slots_[i].resize(slots_[i].size() - std::string_view(".value").size());
    }
  }

  std::string print() {
    line("template <class Bound, class Real>");
    line(fmt::format("struct {};\n\ntemplate <>", predicate_.name));
    line(fmt::format("struct {}<bound::exact, {}> {{", predicate_.name, real_));
    line(fmt::format("  using real = {};", real_));
    if (several_stages_) line("\n  // Nothing: every stage starts from the inputs.\n  struct State {};");
    for (std::size_t s = 0; s < predicate_.stages.size(); ++s) {
      stage_ = s;
      print_results();
      print_stage();
      print_values();
      print_signs();
    }
    line("};");
    return std::move(out_);
  }

 private:
  void line(std::string_view text) { (out_ += text) += '\n'; }
  const dsl::Stage& source() const { return predicate_.stages[stage_]; }
  const ExactStage& exact() const { return program_.stages[stage_]; }
  const std::string& name() const { return source().name; }
  const ExactNode& node(ExactId id) const { return program_.graph[id]; }
  std::size_t count() const { return element_count(source()); }

  std::string parameters(const std::string& more) const;
  std::string names(const std::string& more) const;
  std::string value_type(const ExactOutput& output) const;
  /// "N::template sum<2, 3>"
  std::string of_size(std::string_view what, ExactId id) const {
    return fmt::format("N::template {}<{}, {}>", what, node(id).degree, growth_bits(node(id)));
  }
  std::string operand(ExactId id, const ExactOrder& order) const;
  std::string expression(ExactId id, const ExactOrder& order) const;
  std::string broken_guards(const ExactElement& element, const ExactOrder& order) const;
  std::string value(const ExactElement& element, const std::string& type, const ExactOrder& order) const;

  void print_results();
  void print_stage();
  void print_values();
  void print_signs();
  void print_signs_of(const ExactOrder& order);
  void print_nodes(const ExactOrder& order);
  void print_tier(const ExactOrder& order, int words, std::string_view function, std::string_view next);
  void print_unbounded(const ExactOrder& order, const std::vector<std::string>& inputs);
  void print_inputs(const std::vector<std::string>& inputs);
  void print_uses(const ExactOrder& order, ExactPart part);

  const dsl::Predicate& predicate_;
  const ExactProgram& program_;
  std::string real_;
  std::vector<Argument> arguments_;
  std::vector<std::string> slots_;
  bool several_stages_;
  bool bounded_ = false;
  std::size_t stage_ = 0;
  std::string out_;
};

/// The stage's parameters and more; bounded inputs are Dyadic numbers.
std::string ExactPrinter::parameters(const std::string& more) const {
  std::string text;
  for (const Argument& a : arguments_) {
    const std::string number = a.bounded ? std::string(dyadic) : real_;
    const std::string type = a.pointer   ? fmt::format("const {}*", number)
                             : a.bounded ? fmt::format("const {}&", number)
                                         : number;
    text += fmt::format("{}[[maybe_unused]] {} {}", text.empty() ? "" : ", ", type, a.name);
  }
  return text.empty() || more.empty() ? text + more : text + ", " + more;
}

std::string ExactPrinter::names(const std::string& more) const {
  std::string text;
  for (const Argument& a : arguments_) text += (text.empty() ? "" : ", ") + a.name;
  return text.empty() || more.empty() ? text + more : text + ", " + more;
}

std::string ExactPrinter::value_type(const ExactOutput& output) const {
  return std::all_of(output.elements.begin(), output.elements.end(), is_dyadic) ? "Dyadic" : "DyadicRatio";
}

std::string ExactPrinter::operand(ExactId id, const ExactOrder& order) const {
  const ExactNode& n = node(id);
  if (n.op == ExactOp::whole) return fmt::format("{}({})", of_size("unit", id), n.value);
  if (n.op != ExactOp::input) return fmt::format("v{}", id);
  const auto place = std::lower_bound(order.slots.begin(), order.slots.end(), static_cast<int>(n.value));
  return fmt::format("x[{}]", place - order.slots.begin());
}

std::string ExactPrinter::expression(ExactId id, const ExactOrder& order) const {
  const ExactNode& n = node(id);
  const auto text = [&](ExactId operand_id) { return operand_id == -1 ? "" : operand(operand_id, order); };
  const auto call = [&](std::string_view function, const std::string& list) {
    return fmt::format("{}({})", of_size(function, id), list);
  };
  const std::string a = text(n.a);
  const std::string ab = a + ", " + text(n.b);
  switch (n.op) {
    case ExactOp::input:
    case ExactOp::whole:
      return operand(id, order);
    case ExactOp::sum:
      return call("sum", ab);
    case ExactOp::difference:
      return call("difference", ab);
    case ExactOp::negated:
      return call("negated", a);
    case ExactOp::product:
      return call("product", ab);
    case ExactOp::multiple:
      return call("multiple", fmt::format("{}, {}", a, n.value));
    case ExactOp::shifted:
      return call("shifted", fmt::format("{}, {}", a, n.value));
    case ExactOp::raised:
      return call("shifted", n.value == 1 ? a + ", unit" : fmt::format("{}, {} * unit", a, n.value));
    case ExactOp::magnitude:
      return call("magnitude", a);
    case ExactOp::signed_by:
      return call("signed_by", ab);
    case ExactOp::selected:
      return call("selected", text(n.c) + ", " + ab);
    case ExactOp::root_sign:
      return call("root_sign", ab + ", " + text(n.c));
  }
  return {};
}

void ExactPrinter::print_results() {
  const auto print_struct = [&](std::string_view suffix, bool values) {
    line(fmt::format("\n  struct {}{} {{", name(), suffix));
    for (std::size_t o = 0; o < source().outputs.size(); ++o) {
      const dsl::Output& output = source().outputs[o];
      const auto& elements = exact().outputs[o].elements;
      if (values && !std::all_of(elements.begin(), elements.end(), [](const auto& e) { return e.rational; })) continue;
      const std::string type = !values && output.sign
                                   ? std::string(sign_type)
                                   : fmt::format("::std::optional<::tightrope::{}>", value_type(exact().outputs[o]));
      line(fmt::format("    {} {}{};", type, output.name, extents_text(output.extents)));
    }
    line("  };");
  };
  print_struct("_result", false);
  print_struct("_values_result", true);
}

/// The stage's function: all signs, and the values of `value` outputs.
void ExactPrinter::print_stage() {
  const std::string state = !several_stages_                         ? ""
                            : stage_ + 1 == predicate_.stages.size() ? "const State& /*state*/"
                                                                     : "State& /*state*/";
  line(fmt::format("\n  static {0}_result {0}({1}) {{", name(), parameters(state)));
  line(fmt::format("    {}_result result;", name()));
  line(fmt::format("    {} signs[{}];", sign_type, count()));
  line(fmt::format("    {}_signs({});", name(), names("~::std::uint64_t{0}, signs")));
  const auto& outputs = source().outputs;
  if (std::any_of(outputs.begin(), outputs.end(), [](const dsl::Output& output) { return !output.sign; })) {
    line(fmt::format("    {0}_values_result inputs = {0}_values({1});", name(), names("")));
  }
  std::size_t index = 0;
  for (const dsl::Output& output : outputs) {
    for (std::size_t e = 0; e < output.nodes.size(); ++e, ++index) {
      const std::string place = output.name + subscripts(output.extents, static_cast<int>(e));
      line(output.sign ? fmt::format("    result.{} = signs[{}];", place, index)
                       : fmt::format("    result.{0} = ::std::move(inputs.{0});", place));
    }
  }
  line("    return result;\n  }");
}

/// A condition that is true where an element has no value; empty if it always has.
std::string ExactPrinter::broken_guards(const ExactElement& element, const ExactOrder& order) const {
  std::string text;
  for (const ExactGuard& guard : element.guards) {
    text += fmt::format("{}q::sign_of({}) {} 0", text.empty() ? "" : " || ", operand(guard.node, order),
                        guard.kind == ExactGuard::Kind::nonzero ? "==" : "<");
  }
  return text;
}

/// The nodes, one a line; where elements need different ones, under tests of `wanted`.
void ExactPrinter::print_nodes(const ExactOrder& order) {
  if (!order.several) {
    for (const ExactId id : order.nodes) line(fmt::format("    const auto v{} = {};", id, expression(id, order)));
    return;
  }
  for (const ExactId id : order.nodes) line(fmt::format("    typename {} v{}{{}};", of_size("number", id), id));
  std::uint64_t open = 0;
  for (const ExactId id : order.nodes) {
    const std::uint64_t mask = order.wanted[static_cast<std::size_t>(id)];
    if (mask != open) {
      if (open != 0) line("    }");
      line(fmt::format("    if ((wanted & {:#x}U) != 0) {{", mask));
      open = mask;
    }
    line(fmt::format("      v{} = {};", id, expression(id, order)));
  }
  if (open != 0) line("    }");
}

/// The signs over any kind of numbers.
void ExactPrinter::print_signs_of(const ExactOrder& order) {
  const std::string_view unused = "[[maybe_unused]] ";
  line("\n  template <class N>");
  line(fmt::format("  static void {}_signs_of({}const typename N::input* x, {}int unit,", name(), unused, unused));
  line(fmt::format("      {}::std::uint64_t wanted, {}* signs) {{", unused, sign_type));
  line("    namespace q = ::tightrope::exact_arithmetic;");
  print_nodes(order);
  for_each_element(source(), exact(), ExactPart::signs,
                   [&](std::size_t i, const dsl::Output&, const ExactElement& element) {
                     const std::string guards = broken_guards(element, order);
                     std::string sign = fmt::format("q::exact_sign({})", operand(element.sign, order));
                     if (!guards.empty()) sign = fmt::format("{} ? {}::invalid : {}", guards, sign_type, sign);
                     const auto bit = std::uint64_t{1} << wanted_bit(i, count());
                     const std::string test = order.several ? fmt::format("if ((wanted & {:#x}U) != 0) ", bit) : "";
                     line(fmt::format("    {}signs[{}] = {};", test, i, sign));
                   });
  line("  }");
}

/// `inputs[]`, the inputs as Dyadic numbers, and `broken`, those that are not finite.
void ExactPrinter::print_inputs(const std::vector<std::string>& inputs) {
  const std::size_t n = inputs.size();
  line(fmt::format("    ::std::uint64_t broken[{}] = {{}};", (n + 63) / 64));
  std::vector<std::string> words;
  for (std::size_t i = 0; i < n; ++i) {
    words.push_back(fmt::format("::tightrope::exact_arithmetic::dyadic_of({}, broken, {}){}", inputs[i], i,
                                i + 1 < n ? "," : "};"));
  }
  line(wrap_call(fmt::format("    const {} inputs[] = {{", dyadic), words));
}

/// `uses[]`, the inputs that each element depends on.
void ExactPrinter::print_uses(const ExactOrder& order, ExactPart part) {
  const std::size_t width = (order.slots.size() + 63) / 64;
  std::vector<std::string> rows(count(), "{}");
  for_each_element(source(), exact(), part, [&](std::size_t index, const dsl::Output&, const ExactElement& element) {
    std::vector<std::uint64_t> mask(width, 0);
    for (const int slot : element.slots) {
      const auto place = std::lower_bound(order.slots.begin(), order.slots.end(), slot) - order.slots.begin();
      mask[static_cast<std::size_t>(place) / 64] |= std::uint64_t{1} << (place % 64);
    }
    rows[index] = fmt::format("{{{:#x}U}}", fmt::join(mask, "U, "));
  });
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] += i + 1 < rows.size() ? "," : "};";
  line(wrap_call(fmt::format("    static constexpr ::std::uint64_t uses[{}][{}] = {{", rows.size(), width), rows));
}

/// Dyadic numbers: any inputs, whatever their exponents.
void ExactPrinter::print_unbounded(const ExactOrder& order, const std::vector<std::string>& inputs) {
  if (inputs.empty()) {
    line(fmt::format("    {}_signs_of<::tightrope::DyadicNumbers>(nullptr, 0, wanted, signs);\n  }}", name()));
    return;
  }
  print_inputs(inputs);
  print_uses(order, ExactPart::signs);
  line(fmt::format("    {}_signs_of<::tightrope::DyadicNumbers>(inputs, 0, wanted, signs);", name()));
  line(fmt::format("    for (int i = 0; i < {}; ++i) {{", count()));
  line(fmt::format("      if (::tightrope::exact_arithmetic::intersect(uses[i], broken)) signs[i] = {}::invalid;",
                   sign_type));
  line("    }\n  }");
}

/// Integers of fixed width for inputs that fit them; others go on to `next`.
void ExactPrinter::print_tier(const ExactOrder& order, int words, std::string_view function, std::string_view next) {
  const int bits = fixed_input_bits(program_.graph, order, words);
  const std::size_t n = order.slots.size() + (order.raises ? 1 : 0);
  line(fmt::format("\n  TIGHTROPE_OUT_OF_LINE static void {}_signs_{}(const {} (&x)[{}], ::std::uint64_t wanted,",
                   name(), function, real_, n));
  line(fmt::format("      {}* signs) {{", sign_type));
  line("    int unit = 0;");
  line(fmt::format("    ::tightrope::Integer<{}> scaled[{}];", words, n));
  line(fmt::format("    if (!::tightrope::exact_arithmetic::scale_inputs<{}>(x, scaled, unit)) {{", bits));
  line(fmt::format("      return {}_signs_{}(x, wanted, signs);\n    }}", name(), next));
  line(fmt::format("    {}_signs_of<::tightrope::FixedNumbers<{}>>(scaled, unit, wanted, signs);\n  }}", name(), bits));
}

void ExactPrinter::print_signs() {
  const ExactOrder order = exact_order(source(), program_, stage_, ExactPart::signs);
  std::vector<std::string> inputs;
  for (const int slot : order.slots) inputs.push_back(slots_[static_cast<std::size_t>(slot)]);
  const bool fixed = !bounded_ && !inputs.empty() && fixed_input_bits(program_.graph, order, 1) != 0;
  const bool wide = fixed && fixed_input_bits(program_.graph, order, 2) != 0;
  print_signs_of(order);
  if (fixed) {
    const std::size_t n = inputs.size() + (order.raises ? 1 : 0);
    line(fmt::format("\n  TIGHTROPE_OUT_OF_LINE static void {}_signs_dyadic(const {} (&x)[{}], ::std::uint64_t wanted,",
                     name(), real_, n));
    line(fmt::format("      {}* signs) {{", sign_type));
    std::vector<std::string> places;
    for (std::size_t i = 0; i < inputs.size(); ++i) places.push_back(fmt::format("x[{}]", i));
    print_unbounded(order, places);
    if (wide) print_tier(order, 2, "wide", "dyadic");
    print_tier(order, 1, "scaled", wide ? "wide" : "dyadic");
  }
  line("\n  // The signs of the output elements whose bits are set in `wanted`.");
  const std::string more = fmt::format("::std::uint64_t wanted, {}* signs", sign_type);
  line(fmt::format("  static void {}_signs({}) {{", name(), parameters(more)));
  if (!fixed) return print_unbounded(order, inputs);
  if (order.raises) inputs.emplace_back("1");
  for (std::size_t i = 0; i < inputs.size(); ++i) inputs[i] += i + 1 < inputs.size() ? "," : "};";
  line(wrap_call(fmt::format("    const {} inputs[] = {{", real_), inputs));
  line(fmt::format("    {}_signs_scaled(inputs, wanted, signs);\n  }}", name()));
}

/// numerator / denominator as a number of `type`.
std::string ExactPrinter::value(const ExactElement& element, const std::string& type, const ExactOrder& order) const {
  const dsl::Rational& factor = element.numerator.factor;
  std::string numerator = operand(element.numerator.node, order);
  if (factor.odd_numerator() != 1) numerator += " * " + whole(factor.odd_numerator());
  if (factor.exponent() != 0) numerator = fmt::format("mul_pow2({}, {})", numerator, factor.exponent());
  if (type == "Dyadic") return numerator;
  std::string denominator = element.denominator == -1 ? "" : operand(element.denominator, order);
  if (factor.odd_denominator() != 1 || denominator.empty()) {
    denominator += (denominator.empty() ? "" : " * ") + whole(factor.odd_denominator());
  }
  return fmt::format("::tightrope::DyadicRatio({}, {})", numerator, denominator);
}

void ExactPrinter::print_values() {
  ExactOrder order = exact_order(source(), program_, stage_, ExactPart::values);
  order.several = false;  // all of them are wanted
  const bool none = order.slots.empty();
  const std::string width = fmt::format("{}", (order.slots.size() + 63) / 64);
  const std::string broken = none ? "" : fmt::format(" const ::std::uint64_t (&broken)[{}],", width);
  line(fmt::format("\n  static void {}_values_of([[maybe_unused]] const {}* x,{}", name(), dyadic, broken));
  line(fmt::format("      [[maybe_unused]] {}_values_result& result) {{", name()));
  line("    namespace q = ::tightrope::exact_arithmetic;");
  line("    using N [[maybe_unused]] = ::tightrope::DyadicNumbers;\n    [[maybe_unused]] constexpr int unit = 0;");
  if (!none) print_uses(order, ExactPart::values);
  print_nodes(order);
  std::size_t first = 0;
  for (std::size_t o = 0; o < source().outputs.size(); ++o) {
    const dsl::Output& output = source().outputs[o];
    const std::string type = value_type(exact().outputs[o]);
    const auto& elements = exact().outputs[o].elements;
    const bool rational = std::all_of(elements.begin(), elements.end(), [](const auto& e) { return e.rational; });
    for (std::size_t e = 0; rational && e < elements.size(); ++e) {
      std::string conditions = none ? "" : fmt::format("!q::intersect(uses[{}], broken)", first + e);
      if (const std::string guards = broken_guards(elements[e], order); !guards.empty()) {
        conditions += fmt::format("{}!({})", conditions.empty() ? "" : " && ", guards);
      }
      const std::string place = output.name + subscripts(output.extents, static_cast<int>(e));
      const std::string text = value(elements[e], type, order);
      line(fmt::format("    {}result.{} = {};", conditions.empty() ? "" : "if (" + conditions + ") ", place, text));
    }
    first += elements.size();
  }
  line("  }");
  line("\n  // The exact values; none where an input is not finite, a divisor zero or a radicand negative.");
  line(fmt::format("  static {0}_values_result {0}_values({1}) {{", name(), parameters("")));
  line(fmt::format("    {}_values_result result;", name()));
  std::vector<std::string> inputs;
  for (const int slot : order.slots) inputs.push_back(slots_[static_cast<std::size_t>(slot)]);
  if (!none) print_inputs(inputs);
  line(fmt::format("    {}_values_of({}, result);", name(), none ? "nullptr" : "inputs, broken"));
  line("    return result;\n  }");
}

}  // namespace

std::string print_exact_predicate(const ExactPredicate& exact, Precision precision) {
  return ExactPrinter(exact, precision).print();
}

}  // namespace tightrope::codegen
