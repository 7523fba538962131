#include "codegen/print_exact_tests.h"

#include <fmt/format.h>

#include <utility>

#include "codegen/interface.h"

namespace tightrope::codegen {
namespace {

/// A case's slots become the arguments of the generated functions; bounded inputs are exact numbers.
std::string argument_lines(const std::vector<Argument>& arguments) {
  std::string text;
  for (std::size_t a = 0; a < arguments.size(); ++a) {
    const Argument& argument = arguments[a];
    std::vector<std::string> items;
    for (const int slot : argument.slots) {
      items.push_back(argument.bounded ? fmt::format("c.exact[{}].value.lower().numerator()", slot)
                                       : fmt::format("c.x[{}].value", slot));
    }
    const std::string_view type = argument.bounded ? "Dyadic" : "Real";
    if (argument.pointer) {
      for (std::size_t i = 0; i < items.size(); ++i) items[i] += i + 1 < items.size() ? "," : "};";
      text += wrap(fmt::format("  const {} a{}[] = {{", type, a), items) + '\n';
    } else {
      text += fmt::format("  const {} a{} = {};\n", type, a, items.front());
    }
  }
  return text;
}

std::string adapter(const dsl::Predicate& predicate) {
  const std::vector<Argument> list = arguments(predicate);
  std::string names;
  for (std::size_t a = 0; a < list.size(); ++a) names += fmt::format("{}a{}", a == 0 ? "" : ", ", a);
  const bool several_stages = predicate.stages.size() > 1;
  if (several_stages) names += names.empty() ? "state" : ", state";
  std::string text = fmt::format(
      "\ntemplate <class Bound, class Real>\n"
      "void {0}_exact([[maybe_unused]] const Case<Real>& c, ExactOutcome<Real>* y) {{\n"
      "  using Code = generated::{0}<Bound, Real>;\n",
      predicate.name);
  text += argument_lines(list);
  if (several_stages) text += "  typename Code::State state;\n";
  for (std::size_t s = 0; s < predicate.stages.size(); ++s) {
    const dsl::Stage& stage = predicate.stages[s];
    text += fmt::format("  const auto r{} = Code::{}({});\n", s, stage.name, names);
    for (const dsl::Output& output : stage.outputs) {
      text += fmt::format("  y = collect_exact(r{}.{}, y);\n", s, output.name);
    }
  }
  return text + "}\n";
}

}  // namespace

std::string print_exact_tests(const dsl::Predicate& predicate, const TestOptions& options) {
  if (options.exact_modes.empty()) return {};
  std::string text = adapter(predicate);
  for (const Precision precision : options.precisions) {
    const std::string real = codegen::name(precision);
    text += fmt::format("\nconst ExactCode<{0}> {1}_exact_codes_{0}[] = {{\n", real, predicate.name);
    for (const BoundMode mode : options.exact_modes) {
      text += fmt::format("    {{\"{0} {1}\", {2}_exact<{3}, {1}>}},\n", codegen::name(mode), real, predicate.name,
                          tag(mode));
    }
    text += "};\n";
    const std::pair<std::string_view, std::string_view> families[] = {
        {"on_uniform_inputs", "uniform"},    {"on_a_lattice", "lattice"},
        {"near_zeros", "zero_set"},          {"on_dependent_inputs", "dependent"},
        {"at_all_scales", "scales"},         {"far_from_the_origin", "far_away"},
        {"on_mixed_magnitudes", "mixed"},    {"on_subnormal_inputs", "underflow"},
        {"on_extreme_exponents", "extreme"}, {"on_infinities_and_nan", "not_finite"},
    };
    for (const auto& [name, family] : families) {
      text += fmt::format(
          "\nTEST({0}_{1}, signs_are_exact_{2}) {{\n"
          "  expect(check_exact_family<{1}>({0}_reference, {0}_exact_codes_{1}, Family::{3}));\n}}\n",
          predicate.name, real, name, family);
    }
  }
  return text;
}

}  // namespace tightrope::codegen
