#include "codegen/print_staged.h"

#include <fmt/format.h>

#include <algorithm>

#include "codegen/count.h"
#include "codegen/exact_order.h"
#include "codegen/interface.h"
#include "codegen/simplify.h"

namespace tightrope::codegen {
namespace {

using dsl::Op;

constexpr std::string_view sign_type = "::tightrope::ExactSign";

/// A first filter of mode `static` settles few signs of inputs that are much smaller than their range. Ranges up to
/// this are taken for the size of the inputs; larger ones, as predicates declare them to exclude overflow, are not.
constexpr double largest_telling_range = 0x1p16;

bool has_telling_ranges(const dsl::Predicate& predicate) {
  return std::all_of(predicate.parameters.begin(), predicate.parameters.end(),
                     [](const dsl::Parameter& p) { return p.range.has_value() && *p.range <= largest_telling_range; });
}

/// Whether an infinite input (or a value that overflowed) can leave a finite result with a definite sign behind. Where
/// it cannot, a definite sign of a filter means that all inputs it depends on are finite.
bool swallows_infinities(const dsl::Predicate& predicate) {
  for (dsl::NodeId id = 0; id < predicate.graph.size(); ++id) {
    const Op op = predicate.graph[id].op;
    if (op == Op::div || op == Op::min || op == Op::max || op == Op::select) return true;
  }
  return false;
}

class StagedPrinter {
 public:
  StagedPrinter(const StagedPredicate& staged, Precision precision)
      : staged_(staged),
        predicate_(*staged.predicate),
        real_(codegen::name(precision)),
        arguments_(codegen::arguments(predicate_)),
        several_stages_(predicate_.stages.size() > 1),
        has_range_(std::any_of(predicate_.parameters.begin(), predicate_.parameters.end(),
                               [](const dsl::Parameter& p) { return p.range.has_value(); })),
        checks_finite_(swallows_infinities(simplify(predicate_))) {}

  std::string print() {
    line("template <class Bound, class Real>");
    line(fmt::format("struct {};\n\ntemplate <>", predicate_.name));
    line(fmt::format("struct {}<bound::staged, {}> {{", predicate_.name, real_));
    line(fmt::format("  using real = {};", real_));
    if (several_stages_) print_state();
    for (std::size_t s = 0; s < predicate_.stages.size(); ++s) {
      stage_ = s;
      count_ = element_count(source());
      print_result();
      print_finish();
      if (has_range_) print_function("_in_range");
      print_function("");
    }
    line("};");
    return std::move(out_);
  }

 private:
  void line(std::string_view text) { (out_ += text) += '\n'; }
  const dsl::Stage& source() const { return predicate_.stages[stage_]; }
  const std::string& name() const { return source().name; }

  /// "::tightrope::generated_stages::orient3d<bound::tight, double>"
  std::string part(BoundMode mode) const {
    return fmt::format("::tightrope::generated_stages::{}<{}, {}>", predicate_.name, tag(mode), real_);
  }
  bool has_filter() const { return !staged_.filters.empty(); }
  std::string first() const { return part(staged_.filters.front().mode); }

  std::string parameters(const std::string& more) const;
  std::string names(const std::string& more) const;
  std::string state_parameter() const;
  /// "k[2]" of every element of `sign` outputs, with its number.
  template <class Visit>
  void for_each_sign(Visit visit) const;

  void print_state();
  void print_result();
  void print_finish();
  void print_filter(const StagedFilter& filter);
  void print_function(std::string_view suffix);
  void print_finite_check();

  const StagedPredicate& staged_;
  const dsl::Predicate& predicate_;
  std::string real_;
  std::vector<Argument> arguments_;
  bool several_stages_;
  bool has_range_;
  bool checks_finite_;
  std::size_t stage_ = 0;
  std::size_t count_ = 0;
  std::string out_;
};

std::string StagedPrinter::parameters(const std::string& more) const {
  std::string text;
  for (const Argument& a : arguments_) {
    const std::string type = a.pointer ? fmt::format("const {}*", real_) : real_;
    text += fmt::format("{}[[maybe_unused]] {} {}", text.empty() ? "" : ", ", type, a.name);
  }
  return text.empty() || more.empty() ? text + more : text + ", " + more;
}

std::string StagedPrinter::names(const std::string& more) const {
  std::string text;
  for (const Argument& a : arguments_) text += (text.empty() ? "" : ", ") + a.name;
  return text.empty() || more.empty() ? text + more : text + ", " + more;
}

std::string StagedPrinter::state_parameter() const {
  if (!several_stages_) return "";
  return stage_ + 1 == predicate_.stages.size() ? "[[maybe_unused]] const State& state"
                                                : "[[maybe_unused]] State& state";
}

template <class Visit>
void StagedPrinter::for_each_sign(Visit visit) const {
  std::size_t index = 0;
  for (const dsl::Output& output : source().outputs) {
    for (std::size_t e = 0; e < output.nodes.size(); ++e, ++index) {
      if (output.sign) visit(index, output.name + subscripts(output.extents, static_cast<int>(e)));
    }
  }
}

void StagedPrinter::print_state() {
  line("\n  // What later stages take over from earlier ones.");
  line(has_filter() ? fmt::format("  using State = {}::State;", first()) : "  struct State {};");
}

void StagedPrinter::print_result() {
  line(fmt::format("\n  struct {}_result {{", name()));
  for (const dsl::Output& output : source().outputs) {
    const std::string type = output.sign ? std::string(sign_type) : fmt::format("Bounded<{}>", real_);
    line(fmt::format("    {} {}{};", type, output.name, extents_text(output.extents)));
  }
  line("  };");
}

/// A later filter: its earlier stages are computed for their State alone.
void StagedPrinter::print_filter(const StagedFilter& filter) {
  const std::string code = part(filter.mode);
  const std::string_view suffix = has_range_ ? "_in_range" : "";
  line("    if (filter) {");
  if (several_stages_) {
    line(fmt::format("      {}::State state;", code));
    for (std::size_t s = 0; s < stage_; ++s) {
      line(fmt::format("      {}::{}{}({});", code, predicate_.stages[s].name, suffix, names("state")));
    }
  }
  line(fmt::format("      const auto bounds = {}::{}{}({});", code, name(), suffix,
                   names(several_stages_ ? "state" : "")));
  for_each_sign([&](std::size_t, const std::string& place) {
    line(fmt::format("      if (result.{0} == {1}::zero) result.{0} = filtered(bounds.{0});", place, sign_type));
  });
  line("    }");
}

/// The signs that the first filter left open, out of line; `filter` tells whether bounds hold for the inputs.
void StagedPrinter::print_finish() {
  line("\n  // Settles the signs that are still zero, with the later filters if those apply to the inputs.");
  line(fmt::format("  TIGHTROPE_OUT_OF_LINE static {0}_result {0}_finish({1}) {{", name(),
                   parameters(fmt::format("[[maybe_unused]] bool filter, {}_result result", name()))));
  for (std::size_t f = 1; f < staged_.filters.size(); ++f) print_filter(staged_.filters[f]);
  line("    ::std::uint64_t wanted = 0;");
  for_each_sign([&](std::size_t i, const std::string& place) {
    line(fmt::format("    if (result.{} == {}::zero) wanted |= {:#x}U;", place, sign_type,
                     std::uint64_t{1} << wanted_bit(i, count_)));
  });
  line("    if (wanted == 0) return result;");
  line(fmt::format("    {} signs[{}];", sign_type, count_));
  line(fmt::format("    {}::{}_signs({});", part(BoundMode::exact), name(), names("wanted, signs")));
  for_each_sign([&](std::size_t i, const std::string& place) {
    line(fmt::format("    if ((wanted & {:#x}U) != 0) result.{} = signs[{}];",
                     std::uint64_t{1} << wanted_bit(i, count_), place, i));
  });
  line("    return result;\n  }");
}

/// Inputs that are not finite go to exact arithmetic at once, which calls their signs invalid.
void StagedPrinter::print_finite_check() {
  const std::vector<std::string> slots = slot_expressions(predicate_);
  std::vector<std::string> words;
  for (std::size_t i = 0; i < predicate_.slots.size(); ++i) {
    words.push_back(fmt::format("{0} - {0} == 0{1}", slots[i], i + 1 < predicate_.slots.size() ? " &&" : ";"));
  }
  line(wrap("    const bool finite = ", words));
}

/// The stage's function. With ranges there are two: one checks them, the other (_in_range) need not.
void StagedPrinter::print_function(std::string_view suffix) {
  line(fmt::format("\n  TIGHTROPE_FUNCTION static {0}_result {0}{1}({2}) {{", name(), suffix,
                   parameters(state_parameter())));
  line(fmt::format("    {}_result result;", name()));
  const bool checks_range = has_filter() && has_range_ && suffix.empty();
  std::string condition;
  if (has_filter() && checks_finite_ && !predicate_.slots.empty()) {
    print_finite_check();
    condition = "finite";
  }
  if (checks_range) condition += fmt::format("{}{}::in_range({})", condition.empty() ? "" : " && ", first(), names(""));
  if (!has_filter()) {
    for (const dsl::Output& output : source().outputs) {
      if (!output.sign) line(fmt::format("    make_uncertain(result.{});", output.name));
    }
    for_each_sign([&](std::size_t, const std::string& place) {
      line(fmt::format("    result.{} = {}::zero;", place, sign_type));
    });
    line(fmt::format("    return {}_finish({});\n  }}", name(), names("false, result")));
    return;
  }
  if (!condition.empty()) {
    line(fmt::format("    if (!({})) {{", condition));
    if (several_stages_ && stage_ + 1 < predicate_.stages.size()) line("      state = State{};");
    for (const dsl::Output& output : source().outputs) {
      if (!output.sign) line(fmt::format("      make_uncertain(result.{});", output.name));
    }
    for_each_sign([&](std::size_t, const std::string& place) {
      line(fmt::format("      result.{} = {}::zero;", place, sign_type));
    });
    line(fmt::format("      return {}_finish({});\n    }}", name(), names("false, result")));
  }
  const std::string_view unchecked = has_range_ ? "_in_range" : "";
  line(fmt::format("    const auto bounds = {}::{}{}({});", first(), name(), unchecked,
                   names(several_stages_ ? "state" : "")));
  std::size_t index = 0;
  std::string open;
  for (const dsl::Output& output : source().outputs) {
    for (std::size_t e = 0; e < output.nodes.size(); ++e, ++index) {
      const std::string place = output.name + subscripts(output.extents, static_cast<int>(e));
      line(output.sign ? fmt::format("    result.{0} = filtered(bounds.{0});", place)
                       : fmt::format("    result.{0} = bounds.{0};", place));
      if (output.sign) open += fmt::format("{}(result.{} == {}::zero)", open.empty() ? "" : " | ", place, sign_type);
    }
  }
  if (!open.empty()) {
    line(fmt::format("    if (__builtin_expect({}, 0)) return {}_finish({});", open, name(), names("true, result")));
  }
  line("    return result;\n  }");
}

}  // namespace

std::optional<StagedPredicate> staged_predicate(const dsl::Predicate& predicate, Precision precision,
                                                dsl::Diagnostics& diagnostics, Weakening weakening) {
  for (const dsl::Parameter& parameter : predicate.parameters) {
    if (!parameter.bounded) continue;
    diagnostics.error(predicate.stages.front().outputs.front().span,
                      "predicate `" + predicate.name +
                          "` has no signs in mode `staged`: the exact value of the input `" + parameter.name +
                          "` is not known",
                      "mode `exact` takes exact numbers for `bounded` inputs");
    return std::nullopt;
  }
  std::optional<ExactProgram> program = exact_program(predicate, diagnostics);
  if (!program) return std::nullopt;
  StagedPredicate result;
  result.predicate = &predicate;
  result.program = std::move(*program);
  const auto add_filter = [&](BoundMode mode) {
    dsl::Diagnostics refusals;
    BoundedPredicate bounded = add_bounds(predicate, mode, precision, refusals, weakening);
    if (!refusals.has_errors()) result.filters.push_back({mode, std::move(bounded)});
  };
  if (has_telling_ranges(predicate)) add_filter(BoundMode::fixed);
  if (result.filters.empty()) add_filter(BoundMode::safe);
  add_filter(BoundMode::tight);
  return result;
}

std::string print_staged_header(std::span<const StagedPredicate> predicates, const HeaderOptions& options) {
  std::string head = exact_head(options);
  std::string parts;
  std::string body;
  for (const StagedPredicate& staged : predicates) {
    const ExactPredicate exact = {staged.predicate, &staged.program};
    head += fmt::format("//\n// {}\n", staged.predicate->name);
    for (std::size_t s = 0; s < staged.predicate->stages.size(); ++s) {
      head += fmt::format("//   {}\n", staged.predicate->stages[s].name);
      for (const StagedFilter& filter : staged.filters) {
        const Cost cost = stage_costs(filter.bounded, schedule(filter.bounded))[s];
        head += comment_lines("", fmt::format("     {}: operations for values {}, for bounds {}",
                                              codegen::name(filter.mode), text(cost.value), text(cost.bound)));
      }
      head += comment_lines("", "     " + exact_cost(exact, s));
    }
    for (const StagedFilter& filter : staged.filters) {
      HeaderOptions part = options;
      part.mode = filter.mode;
      parts += print_predicate({staged.predicate, &filter.bounded}, part);
    }
    parts += '\n' + print_exact_predicate(exact, options.precision);
    body += '\n' + StagedPrinter(staged, options.precision).print();
  }
  return head +
         "#pragma once\n\n#include <tightrope/exact_sign.h>\n\n"
         "// The stages, each a predicate of its own.\n"
         "TIGHTROPE_PRECISE_BEGIN\nnamespace tightrope::generated_stages {\n" +
         parts + "\n}  // namespace tightrope::generated_stages\n\nnamespace tightrope::generated {\n" + body +
         "\n}  // namespace tightrope::generated\nTIGHTROPE_PRECISE_END\n";
}

}  // namespace tightrope::codegen
