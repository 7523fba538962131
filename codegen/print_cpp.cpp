#include "codegen/print_cpp.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "codegen/count.h"
#include "codegen/interface.h"
#include "codegen/schedule.h"

namespace tightrope::codegen {
namespace {

using dsl::Node;
using dsl::NodeId;
using dsl::Op;

/// Characters of an output's expression that are repeated in a comment.
constexpr std::size_t longest_quotation = 500;

/// x * 2^exponent as multiplications by powers of two that the format holds. One factor does unless 2^exponent leaves
/// the exponent range. Then several do, and the result is still rounded at most once: upwards they are exact up to the
/// overflow of the result itself; downwards the first, 2^min_normal, is inexact only for |x| < 1, where what remains
/// (a factor below eta) makes the result 0 either way.
std::string scaling(const std::string& operand, int exponent, Precision precision) {
  const bool single = precision == Precision::binary32;
  const int largest = single ? 127 : 1023;
  const int smallest = single ? -149 : -1074;  // eta = 2^smallest is a number
  const int min_normal = single ? -126 : -1022;
  std::string result = operand;
  while (exponent > largest || exponent < smallest) {
    const int step = exponent > 0 ? largest : min_normal;
    result = fmt::format("product({}, {})", result, literal(std::ldexp(1.0, step), precision));
    exponent -= step;
  }
  return fmt::format("product({}, {})", result, literal(std::ldexp(1.0, exponent), precision));
}

/// `limit` rounded towards zero: the numbers of the format with |x| <= limit stay the same.
double limit_in_format(double limit, Precision precision) {
  if (precision == Precision::binary64) return limit;
  const double largest = std::numeric_limits<float>::max();
  if (limit >= largest) return largest;
  const auto nearest = static_cast<float>(limit);
  return static_cast<double>(nearest) <= limit ? nearest : std::nextafter(nearest, 0.0f);
}

class PredicatePrinter {
 public:
  PredicatePrinter(const GeneratedPredicate& generated, const HeaderOptions& options)
      : predicate_(*generated.predicate),
        bounded_(*generated.bounded),
        options_(options),
        lanes_(options.form == Form::lanes),
        scalar_(codegen::name(options.precision)),
        real_(lanes_ ? fmt::format("Lanes<{}>", scalar_) : scalar_),
        schedule_(codegen::schedule(bounded_)),
        arguments_(codegen::arguments(predicate_)),
        slots_(slot_expressions(predicate_)),
        several_stages_(predicate_.stages.size() > 1),
        has_range_(std::any_of(predicate_.parameters.begin(), predicate_.parameters.end(),
                               [](const dsl::Parameter& p) { return p.range.has_value(); })) {
    name_nodes();
    find_arguments();
  }

  std::string print();
  std::string summary() const;

 private:
  void name_nodes();
  void find_arguments();
  std::string expression(NodeId id) const;
  std::string operand(NodeId id) const { return names_[static_cast<std::size_t>(id)]; }

  std::string declaration(const Argument& argument, bool used) const;
  std::string signature(std::size_t stage, bool with_suffix, const std::vector<bool>& used, bool state_used) const;
  std::vector<bool> used_arguments(std::size_t stage) const;

  void print_results();
  void print_state();
  void print_in_range();
  void print_checked_stage(std::size_t stage);
  void print_stage(std::size_t stage);

  void line(std::string_view text) { (out_ += text) += '\n'; }

  const dsl::Predicate& predicate_;
  const BoundedPredicate& bounded_;
  const HeaderOptions& options_;
  bool lanes_;
  std::string scalar_;  ///< "double"
  std::string real_;    ///< the type of the numbers
  Schedule schedule_;
  std::vector<Argument> arguments_;
  std::vector<std::string> slots_;
  std::vector<std::string> names_;     ///< by node: how it is spelled as an operand
  std::vector<bool> may_be_argument_;  ///< by node
  bool several_stages_;
  bool has_range_;
  std::string out_;
};

/// Inputs and constants are spelled where they are used; everything else is numbered in the order of computation.
void PredicatePrinter::name_nodes() {
  names_.resize(static_cast<std::size_t>(bounded_.graph.size()));
  for (NodeId id = 0; id < bounded_.graph.size(); ++id) {
    const Node& node = bounded_.graph[id];
    if (node.op == Op::input) names_[static_cast<std::size_t>(id)] = slots_[static_cast<std::size_t>(node.index)];
    if (node.op == Op::constant) names_[static_cast<std::size_t>(id)] = literal(node.value, options_.precision);
  }
  int next = 0;
  for (const StageSchedule& stage : schedule_.stages) {
    for (const Step& step : stage.steps) {
      if (step.kind == Step::Kind::compute) names_[static_cast<std::size_t>(step.node)] = fmt::format("v{}", next++);
    }
  }
}

/// Numbers of the caller's, as they are or chosen from several: they may be products that compilers would fuse with a
/// sum, also where they move it into the branches of the choice.
void PredicatePrinter::find_arguments() {
  may_be_argument_.resize(static_cast<std::size_t>(bounded_.graph.size()), false);
  if (lanes_) return;  // highway-inl.h rounds what comes in
  const auto may_be = [&](NodeId id) { return id != dsl::no_node && may_be_argument_[static_cast<std::size_t>(id)]; };
  const auto result = [&](const Node& node) {
    switch (node.op) {
      case Op::input:
        return true;
      case Op::neg:
      case Op::abs:
      case Op::certain_nonzero:
      case Op::certain_nonnegative:
        return may_be(node.a);
      case Op::min:
      case Op::max:
      case Op::max_magnitude:
        return may_be(node.a) || may_be(node.b);
      case Op::select:
        return may_be(node.b) || may_be(node.c);
      case Op::constant:
      case Op::add:
      case Op::sub:
      case Op::mul:
      case Op::mul_pow2:
      case Op::div:
      case Op::sqrt:
      case Op::normalizer:
      case Op::fma:
        return false;  // rounded
    }
    return false;
  };
  for (NodeId id = 0; id < bounded_.graph.size(); ++id) {
    may_be_argument_[static_cast<std::size_t>(id)] = result(bounded_.graph[id]);
  }
}

std::string PredicatePrinter::expression(NodeId id) const {
  const Node& node = bounded_.graph[id];
  const std::string a = node.a == dsl::no_node ? "" : operand(node.a);
  const std::string b = node.b == dsl::no_node ? "" : operand(node.b);
  const auto may_be_argument = [&](NodeId operand) {
    return operand != dsl::no_node && may_be_argument_[static_cast<std::size_t>(operand)];
  };
  const bool with_argument = may_be_argument(node.a) || may_be_argument(node.b);
  const std::string_view suffix = options_.precision == Precision::binary32 ? "f" : "";
  switch (node.op) {
    case Op::input:
    case Op::constant:
      return operand(id);
    case Op::add:
      return with_argument ? fmt::format("sum({}, {})", a, b) : fmt::format("{} + {}", a, b);
    case Op::sub:
      return with_argument ? fmt::format("difference({}, {})", a, b) : fmt::format("{} - {}", a, b);
    case Op::neg:
      return a[0] == '-' ? fmt::format("-({})", a) : "-" + a;
    case Op::mul:
      return fmt::format("product({}, {})", a, b);
    case Op::mul_pow2:
      return scaling(a, node.index, options_.precision);
    case Op::div:
      return fmt::format("{} / {}", a, b);
    case Op::sqrt:
      return lanes_ ? fmt::format("square_root({})", a) : fmt::format("__builtin_sqrt{}({})", suffix, a);
    case Op::abs:
      return fmt::format("magnitude({})", a);
    case Op::min:
      return fmt::format("minimum({}, {})", a, b);
    case Op::max:
      return fmt::format("maximum({}, {})", a, b);
    case Op::certain_nonzero:
    case Op::certain_nonnegative:
      return fmt::format("{}({}, {})", dsl::op_name(node.op), a, b);
    case Op::max_magnitude:
      return fmt::format("max_magnitude({}, {})", a, b);
    case Op::normalizer:
      return fmt::format("normalizer({})", a);
    case Op::select:
      return fmt::format("choose({}, {}, {})", a, b, operand(node.c));
    case Op::fma:
      if (lanes_) return fmt::format("multiply_add({}, {}, {})", a, b, operand(node.c));
      return fmt::format("__builtin_fma{}({}, {}, {})", suffix, a, b, operand(node.c));
  }
  return {};
}

std::string PredicatePrinter::declaration(const Argument& argument, bool used) const {
  const std::string number = argument.bounded ? fmt::format("Bounded<{}>", real_) : real_;
  const std::string type = argument.pointer ? fmt::format("const {}*", number) : number;
  return used ? fmt::format("{} {}", type, argument.name) : fmt::format("{} /*{}*/", type, argument.name);
}

/// The stage's function up to the brace; arguments that it does not use stay unnamed.
std::string PredicatePrinter::signature(std::size_t stage, bool with_suffix, const std::vector<bool>& used,
                                        bool state_used) const {
  const std::string& name = predicate_.stages[stage].name;
  std::vector<std::string> words;
  for (std::size_t i = 0; i < arguments_.size(); ++i) words.push_back(declaration(arguments_[i], used[i]));
  if (several_stages_) {
    const bool last = stage + 1 == predicate_.stages.size();
    words.push_back(fmt::format("{}State& {}", last ? "const " : "", state_used ? "state" : "/*state*/"));
  }
  for (std::size_t i = 0; i < words.size(); ++i) words[i] += i + 1 < words.size() ? "," : ") noexcept {";
  if (words.empty()) words.push_back(") noexcept {");
  return wrap_call(
      fmt::format("  TIGHTROPE_FUNCTION static {}_result {}{}(", name, name, with_suffix ? "_in_range" : ""), words);
}

std::vector<bool> PredicatePrinter::used_arguments(std::size_t stage) const {
  std::vector<bool> slot_used(2 * predicate_.slots.size(), false);
  const auto use = [&](NodeId id) {
    if (id != dsl::no_node && bounded_.graph[id].op == Op::input) {
      slot_used[static_cast<std::size_t>(bounded_.graph[id].index)] = true;
    }
  };
  for (const Step& step : schedule_.stages[stage].steps) {
    if (step.kind != Step::Kind::compute) continue;
    for (const NodeId id : {bounded_.graph[step.node].a, bounded_.graph[step.node].b, bounded_.graph[step.node].c}) {
      use(id);
    }
  }
  for (const OutputBound& output : bounded_.stages[stage].outputs) {
    for (const BoundedNode& element : output.elements) use(element.value), use(element.bound);
  }
  std::vector<bool> used;
  for (const Argument& argument : arguments_) {
    used.push_back(std::any_of(argument.slots.begin(), argument.slots.end(), [&](int slot) {
      return slot_used[static_cast<std::size_t>(slot)] ||
             slot_used[predicate_.slots.size() + static_cast<std::size_t>(slot)];
    }));
  }
  return used;
}

void PredicatePrinter::print_results() {
  for (const dsl::Stage& stage : predicate_.stages) {
    line(fmt::format("\n  struct {}_result {{", stage.name));
    for (const dsl::Output& output : stage.outputs) {
      const std::string_view text = std::string_view(output.text).substr(0, longest_quotation);
      const std::string_view rest = text.size() < output.text.size() ? " ..." : "";
      out_ += comment_lines("    ", fmt::format("{} {}{}", output.sign ? "sign" : "value", text, rest));
      line(fmt::format("    Bounded<{}> {}{};", real_, output.name, extents_text(output.extents)));
    }
    line("  };");
  }
}

void PredicatePrinter::print_state() {
  line("\n  // What later stages take over from earlier ones.");
  std::string members;
  for (const StageSchedule& stage : schedule_.stages) {
    for (const Step& step : stage.steps) {
      if (step.kind == Step::Kind::compute && schedule_.saved[static_cast<std::size_t>(step.node)]) {
        members += fmt::format("    {} {};\n", real_, operand(step.node));
      }
    }
  }
  line(members.empty() ? "  struct State {};" : "  struct State {\n" + members + "  };");
}

void PredicatePrinter::print_in_range() {
  std::vector<std::string> words;
  std::vector<std::string> parameters;
  for (std::size_t a = 0; a < arguments_.size(); ++a) {
    const Argument& argument = arguments_[a];
    const auto& range = predicate_.parameters[static_cast<std::size_t>(argument.parameter)].range;
    parameters.push_back(declaration(argument, range.has_value()) + (a + 1 < arguments_.size() ? "," : ") noexcept {"));
    if (!range) continue;
    const std::string limit = literal(limit_in_format(*range, options_.precision), options_.precision);
    for (const int slot : argument.slots) {
      const auto i = static_cast<std::size_t>(slot);
      words.push_back(fmt::format("magnitude({}) <= {} &&", slots_[i], limit));
      if (argument.bounded) words.push_back(fmt::format("{} <= {} &&", slots_[predicate_.slots.size() + i], limit));
    }
  }
  words.back().replace(words.back().size() - 3, 3, ";");
  line("\n  // Whether the inputs keep the declared ranges; false for NaN.");
  line(wrap_call("  TIGHTROPE_FUNCTION static bool in_range(", parameters));
  line(wrap("    return ", words));
  line("  }");
}

/// The function that checks the ranges first.
void PredicatePrinter::print_checked_stage(std::size_t stage) {
  const dsl::Stage& source = predicate_.stages[stage];
  line("");
  line(signature(stage, false, std::vector<bool>(arguments_.size(), true), true));
  std::vector<std::string> names;
  for (const Argument& argument : arguments_) names.push_back(argument.name + ",");
  std::vector<std::string> range_names = names;
  range_names.back().replace(range_names.back().size() - 1, 1, ")) {");
  line(wrap_call("    if (!in_range(", range_names));
  if (several_stages_ && stage + 1 < predicate_.stages.size()) line("      state = State{};");
  line(fmt::format("      {}_result result;", source.name));
  for (const dsl::Output& output : source.outputs) line(fmt::format("      make_uncertain(result.{});", output.name));
  line("      return result;");
  line("    }");
  if (several_stages_) names.push_back("state,");
  names.back().replace(names.back().size() - 1, 1, ");");
  line(wrap_call(fmt::format("    return {}_in_range(", source.name), names));
  line("  }");
}

void PredicatePrinter::print_stage(std::size_t stage) {
  const std::vector<Step>& steps = schedule_.stages[stage].steps;
  const auto saved = [&](const Step& s) { return schedule_.saved[static_cast<std::size_t>(s.node)]; };
  const bool state_used = std::any_of(steps.begin(), steps.end(), [&](const Step& s) {
    return s.kind == Step::Kind::load || (s.kind == Step::Kind::compute && saved(s));
  });
  line("");
  line(signature(stage, has_range_, used_arguments(stage), state_used));
  line(fmt::format("    {}_result result;", predicate_.stages[stage].name));
  for (const Step& step : steps) {
    const std::string name = operand(step.node);
    switch (step.kind) {
      case Step::Kind::load:
        line(fmt::format("    const {} {} = state.{};", real_, name, name));
        break;
      case Step::Kind::compute:
        line(fmt::format("    const {} {} = {};", real_, name, expression(step.node)));
        if (saved(step)) line(fmt::format("    state.{} = {};", name, name));
        break;
      case Step::Kind::output: {
        const auto o = static_cast<std::size_t>(step.output);
        const dsl::Output& output = predicate_.stages[stage].outputs[o];
        const BoundedNode& element = bounded_.stages[stage].outputs[o].elements[static_cast<std::size_t>(step.element)];
        line(fmt::format("    result.{}{} = {{{}, {}}};", output.name, subscripts(output.extents, step.element), name,
                         element.bound == dsl::no_node ? literal(0, options_.precision) : operand(element.bound)));
        break;
      }
    }
  }
  line("    return result;");
  line("  }");
}

std::string PredicatePrinter::print() {
  line("");
  for (std::size_t begin = 0; begin < predicate_.doc.size();) {
    const std::size_t end = std::min(predicate_.doc.find('\n', begin), predicate_.doc.size());
    out_ += comment_lines("", std::string_view(predicate_.doc).substr(begin, end - begin));
    begin = end + 1;
  }
  line("template <class Bound, class Real>");
  line(fmt::format("struct {};", predicate_.name));
  line("");
  line("template <>");
  line(fmt::format("struct {}<{}, {}> {{", predicate_.name, tag(options_.mode), scalar_));
  line(fmt::format("  using real = {};", real_));
  print_results();
  if (several_stages_) print_state();
  if (has_range_ && !lanes_) print_in_range();
  for (std::size_t stage = 0; stage < predicate_.stages.size(); ++stage) {
    if (has_range_ && !lanes_) print_checked_stage(stage);
    print_stage(stage);
  }
  line("};");
  return std::move(out_);
}

/// What the header says about the predicate at its top.
std::string PredicatePrinter::summary() const {
  std::string result = fmt::format("//\n// {}\n", predicate_.name);
  const std::vector<Cost> costs = stage_costs(bounded_, schedule_);
  for (std::size_t s = 0; s < predicate_.stages.size(); ++s) {
    const dsl::Stage& stage = predicate_.stages[s];
    result += fmt::format("//   {}\n//     operations for values {}\n//     operations for bounds {}\n", stage.name,
                          text(costs[s].value), text(costs[s].bound));
    for (std::size_t o = 0; o < stage.outputs.size(); ++o) {
      const OutputBound& bound = bounded_.stages[s].outputs[o];
      std::string facts = fmt::format("     {}{}: degree {} in t", stage.outputs[o].name,
                                      extents_text(stage.outputs[o].extents), stage.outputs[o].degree);
      if (options_.mode == BoundMode::safe) facts += fmt::format(", k = {}, B = {}", bound.roundings, bound.magnitude);
      if (options_.mode == BoundMode::fixed) facts += ", bound " + literal(bound.constant, options_.precision);
      if (!bound.assumption.empty()) facts += "; " + bound.assumption;
      result += comment_lines("", facts);
    }
  }
  return result;
}

}  // namespace

namespace {

constexpr std::string_view fma_note =
    "// Made with --fma: needs hardware with fused multiply-add. TIGHTROPE_SOFTWARE_FMA lets it compile "
    "without,\n"
    "// which gives the same numbers, slowly.\n";
constexpr std::string_view fma_test =
    "#if !defined(__FMA__) && !defined(__ARM_FEATURE_FMA) && !defined(__CUDACC__) && "
    "!defined(TIGHTROPE_SOFTWARE_FMA)\n"
    "#error \"Tightrope: made with --fma; compile for hardware with fused multiply-add (-mfma)\"\n"
    "#endif\n\n";

constexpr std::string_view lanes_includes =
    "//\n"
    "// For vector classes, one query a lane. Every number keeps its declared range: the caller sees to that. May be\n"
    "// included once for each namespace TIGHTROPE_LANES.\n\n"
    "#include <tightrope/lanes.h>\n\n";

}  // namespace

std::string print_header(std::span<const GeneratedPredicate> predicates, const HeaderOptions& options) {
  std::string head = fmt::format(
      "// Generated by tightrope {} from {} (FNV-1a {:016x}). Do not edit.\n"
      "//\n"
      "// Bound mode {}, scalar type {}. Assumes rounding to nearest and gradual underflow (no flush-to-zero).\n",
      TIGHTROPE_VERSION, comment_text(options.source_name), options.source_hash, codegen::name(options.mode),
      codegen::name(options.precision));
  if (!options.scheme.empty()) head += fmt::format("// Evaluation scheme {} (docs/explore.md).\n", options.scheme);
  if (options.fma) head += fma_note;
  std::string body;
  for (const GeneratedPredicate& generated : predicates) {
    PredicatePrinter printer(generated, options);
    head += printer.summary();
    body += printer.print();
  }
  const bool lanes = options.form == Form::lanes;
  const std::string space = lanes ? "tightrope::TIGHTROPE_LANES" : "tightrope::generated";
  std::string_view includes = "#pragma once\n\n#include <tightrope/sign.h>\n\n";
  if (lanes) includes = lanes_includes;
  return head + std::string(includes) + std::string(options.fma && !lanes ? fma_test : "") +
         fmt::format("TIGHTROPE_PRECISE_BEGIN\nnamespace {} {{\n{}\n}}  // namespace {}\nTIGHTROPE_PRECISE_END\n",
                     space, body, space);
}

std::string print_predicate(const GeneratedPredicate& generated, const HeaderOptions& options) {
  return PredicatePrinter(generated, options).print();
}

std::string header_name(const std::string& stem, BoundMode mode, Precision precision, Form form) {
  return fmt::format("{}.{}.{}{}.h", stem, name(mode), name(precision), form == Form::lanes ? ".simd" : "");
}

}  // namespace tightrope::codegen
