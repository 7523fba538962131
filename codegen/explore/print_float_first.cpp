#include <fmt/format.h>

#include <algorithm>

#include "codegen/explore/float_first.h"
#include "codegen/interface.h"
#include "codegen/print_cpp.h"

namespace tightrope::codegen::explore {
namespace {

/// What the code needs of its own, as members.
constexpr std::string_view members = R"(
  // All signs are definite.
  template <class Real>
  TIGHTROPE_FUNCTION static bool definite(const Bounded<Real>& x) { return sign(x) != Sign::uncertain; }
  template <class Element, decltype(sizeof(0)) N>
  TIGHTROPE_FUNCTION static bool definite(const Element (&array)[N]) {
    bool all = true;
    for (const Element& element : array) all = definite(element) && all;
    return all;
  }
  TIGHTROPE_FUNCTION static void widen(const Bounded<float>& from, Bounded<double>& to) { to = {from.value, from.bound}; }
  template <class From, class To, decltype(sizeof(0)) N>
  TIGHTROPE_FUNCTION static void widen(const From (&from)[N], To (&to)[N]) {
    for (decltype(sizeof(0)) i = 0; i < N; ++i) widen(from[i], to[i]);
  }
)";

constexpr std::string_view rounding = R"(
  // The float nearest to x, and a bound of its distance from x, 0 for a float.
  TIGHTROPE_FUNCTION static Bounded<float> rounded(double x) {
    const float value = static_cast<float>(x);
    const double distance = magnitude(static_cast<double>(value) - x);
    if (distance <= 0) return {value, 0};
    return {value, product(static_cast<float>(distance), 0x1.000004p+0f) + 0x1p-149f};
  }
)";

class FloatFirstPrinter {
 public:
  FloatFirstPrinter(const Candidate& candidate, const std::string& name, Precision inputs)
      : predicate_(candidate.predicate),
        name_(name),
        bound_(tag(candidate.scheme.bound)),
        inputs_(inputs),
        real_(codegen::name(inputs)),
        arguments_(codegen::arguments(predicate_)),
        several_(predicate_.stages.size() > 1),
        has_range_(has_range(predicate_)),
        filter_has_range_(has_range(candidate.filter->predicate)) {}

  std::string print() {
    line("\ntemplate <class Bound, class Real>");
    line(fmt::format("struct {};\n", name_));
    line(fmt::format("// In single precision, in double where that leaves a sign of the stage open.\ntemplate <>"));
    line(fmt::format("struct {}<{}, {}> {{\n  using real = {};", name_, bound_, real_, real_));
    line(fmt::format("  using filter = {}_filter<{}, float>;", name_, bound_));
    line(fmt::format("  using in_double = {}_in_double<{}, double>;", name_, bound_));
    for (const dsl::Stage& stage : predicate_.stages) {
      line(fmt::format("  using {0}_result = in_double::{0}_result;", stage.name));
    }
    if (several_) {
      line("\n  // What later stages take over from earlier ones: in double they compute it anew.");
      line("  struct State {\n    filter::State of_filter;\n  };");
    }
    out_ += members;
    if (inputs_ == Precision::binary64) out_ += rounding;
    if (has_range_) print_in_range();
    for (std::size_t s = 0; s < predicate_.stages.size(); ++s) {
      if (has_range_) print_checked(s);
      print_stage(s);
    }
    line("};");
    return std::move(out_);
  }

 private:
  static bool has_range(const dsl::Predicate& p) {
    return std::any_of(p.parameters.begin(), p.parameters.end(), [](const dsl::Parameter& q) { return q.range; });
  }
  void line(std::string_view text) { (out_ += text) += '\n'; }

  std::string parameters() const {
    std::string text;
    for (const Argument& a : arguments_) {
      text += fmt::format("{}{}{} {}", text.empty() ? "" : ", ", a.pointer ? "const " : "",
                          real_ + (a.pointer ? "*" : ""), a.name);
    }
    return text;
  }
  /// The arguments' names, each with a suffix if it has been converted for the callee.
  std::string names(std::string_view suffix) const {
    std::string text;
    for (const Argument& a : arguments_) text += fmt::format("{}{}{}", text.empty() ? "" : ", ", a.name, suffix);
    return text;
  }
  void print_signature(std::size_t s, std::string_view suffix) {
    const std::string& stage = predicate_.stages[s].name;
    const bool last = s + 1 == predicate_.stages.size();
    const std::string state = several_ ? fmt::format(", {}State& state", last ? "const " : "") : "";
    line(fmt::format("\n  TIGHTROPE_FUNCTION static {0}_result {0}{1}({2}{3}) noexcept {{", stage, suffix, parameters(),
                     state));
  }

  void print_in_range() {
    line("\n  // Whether the inputs keep the declared ranges; false for NaN.");
    line(fmt::format("  TIGHTROPE_FUNCTION static bool in_range({}) noexcept {{", parameters()));
    print_conversion("_d", inputs_ == Precision::binary32 ? "double" : "");
    line(fmt::format("    return in_double::in_range({});\n  }}", names(inputs_ == Precision::binary32 ? "_d" : "")));
  }

  void print_checked(std::size_t s) {
    print_signature(s, "");
    line(fmt::format("    if (!in_range({})) {{", names("")));
    if (several_ && s + 1 < predicate_.stages.size()) line("      state = State{};");
    line(fmt::format("      {}_result result;", predicate_.stages[s].name));
    for (const dsl::Output& output : predicate_.stages[s].outputs) {
      line(fmt::format("      make_uncertain(result.{});", output.name));
    }
    line("      return result;\n    }");
    line(fmt::format("    return {}_in_range({}{});\n  }}", predicate_.stages[s].name, names(""),
                     several_ ? ", state" : ""));
  }

  /// Copies of the arguments in another type under their names with a suffix; none for type "".
  void print_conversion(std::string_view suffix, const std::string& type) {
    if (type.empty()) return;
    const bool rounds = type != "double";
    for (const Argument& a : arguments_) {
      const auto element = [&](std::size_t i) {
        const std::string x = a.pointer ? fmt::format("{}[{}]", a.name, i) : a.name;
        return rounds ? fmt::format("rounded({})", x) : x;
      };
      if (!a.pointer) {
        line(fmt::format("    const {} {}{} = {};", type, a.name, suffix, element(0)));
        continue;
      }
      std::string elements;
      for (std::size_t i = 0; i < a.slots.size(); ++i) elements += (i == 0 ? "" : ", ") + element(i);
      line(fmt::format("    const {} {}{}[{}] = {{{}}};", type, a.name, suffix, a.slots.size(), elements));
    }
  }

  void print_stage(std::size_t s) {
    const dsl::Stage& stage = predicate_.stages[s];
    const bool from_double = inputs_ == Precision::binary64;
    print_signature(s, has_range_ ? "_in_range" : "");
    std::string all_definite;
    for (const dsl::Output& output : stage.outputs) {
      if (output.sign)
        all_definite += fmt::format("{}definite(found.{})", all_definite.empty() ? "" : " && ", output.name);
    }
    print_conversion("_f", from_double ? "Bounded<float>" : "");
    line(fmt::format("    const auto found = filter::{}{}({}{});", stage.name, filter_has_range_ ? "_in_range" : "",
                     names(from_double ? "_f" : ""), several_ ? ", state.of_filter" : ""));
    line(fmt::format("    if ({}) {{\n      {}_result result;", all_definite, stage.name));
    for (const dsl::Output& output : stage.outputs) {
      line(fmt::format("      widen(found.{0}, result.{0});", output.name));
    }
    line("      return result;\n    }");
    print_conversion("_d", from_double ? "" : "double");
    const std::string arguments = names(from_double ? "" : "_d");
    const std::string suffix = has_range_ ? "_in_range" : "";
    if (several_) line("    in_double::State none{};");
    line(fmt::format("    return in_double::{}{}({}{});\n  }}", stage.name, suffix, arguments,
                     several_ ? ", none" : ""));
  }

  const dsl::Predicate& predicate_;
  std::string name_;
  std::string bound_;
  Precision inputs_;
  std::string real_;
  std::vector<Argument> arguments_;
  bool several_;
  bool has_range_;
  bool filter_has_range_;
  std::string out_;
};

}  // namespace

dsl::Predicate named_filter(const Candidate& candidate, const std::string& name) {
  dsl::Predicate predicate = candidate.filter->predicate;
  predicate.name = name + "_filter";
  return predicate;
}

dsl::Predicate named_in_double(const Candidate& candidate, const std::string& name) {
  dsl::Predicate predicate = candidate.predicate;
  predicate.name = name + "_in_double";
  return predicate;
}

std::string print_float_first(const Candidate& candidate, const std::string& name, Precision inputs) {
  HeaderOptions options;
  options.mode = candidate.scheme.bound;
  options.precision = Precision::binary32;
  const dsl::Predicate filter = named_filter(candidate, name);
  std::string text = print_predicate({&filter, &candidate.filter->bounded}, options);
  options.precision = Precision::binary64;
  const dsl::Predicate in_double = named_in_double(candidate, name);
  text += print_predicate({&in_double, &candidate.bounded}, options);
  return text + FloatFirstPrinter(candidate, name, inputs).print();
}

}  // namespace tightrope::codegen::explore
