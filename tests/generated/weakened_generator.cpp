/// A generator with one term left out of its bounds, to show that the generated tests notice (codegen/bounds.h).
///
///   weakened_generator safe|tight DIRECTORY NAME...
///
/// writes DIRECTORY/weakened.MODE.double.h and weakened.MODE.test.cpp: for every case of the table below a predicate
/// NAME whose bounds lack a term, and sound_NAME, the same with nothing left out. The names on the command line must
/// be those of the table, so that none goes untested.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "codegen/print_cpp.h"
#include "codegen/print_tests.h"
#include "codegen/write_files.h"

namespace {

using namespace tightrope;
using codegen::BoundMode;
using codegen::Weakening;

constexpr std::array all_weakenings = {
    Weakening::drop_rounding_of_sums,   Weakening::drop_rounding_of_products, Weakening::drop_rounding_of_differences,
    Weakening::drop_first_factor_error, Weakening::drop_second_factor_error,  Weakening::drop_operand_error_of_sums,
    Weakening::drop_division_rounding,  Weakening::drop_input_bound,          Weakening::drop_underflow,
    Weakening::halve_unit_roundoff,     Weakening::drop_product_of_errors,    Weakening::drop_dividend_error,
    Weakening::drop_divisor_error,      Weakening::drop_divisor_margin,       Weakening::drop_root_rounding,
    Weakening::drop_radicand_error,     Weakening::drop_fma_rounding,         Weakening::drop_guards,
    Weakening::drop_second_alternative,
};

struct Case {
  std::string name;
  Weakening weakening;
  const char* parameters;
  const char* expression;
  const char* range = "";
};

/// Per weakening one predicate for every way in which the rule is used: factors with a relative error bound known at
/// compile time (_relative), others, with and without a declared range.
std::vector<Case> cases(BoundMode mode) {
  std::vector<Case> result;
  const auto add = [&](Weakening weakening, const char* suffix, const char* parameters, const char* expression) {
    result.push_back({std::string(name(weakening)) + suffix, weakening, parameters, expression});
  };
  add(Weakening::drop_rounding_of_sums, "", "scalar a, b, c, d", "a * b + c * d");
  add(Weakening::drop_rounding_of_products, "", "scalar a, b", "a * b");
  add(Weakening::drop_rounding_of_products, "_relative", "scalar a, b, c", "(a - b) * c");
  add(Weakening::drop_rounding_of_differences, "", "scalar a, b, c", "(a - b) * c");
  add(Weakening::drop_division_rounding, "", "scalar a", "a / 3");
  add(Weakening::drop_input_bound, "", "bounded scalar a, scalar b", "a + b");
  add(Weakening::drop_underflow, "", "scalar a, b, c", "a * b * c");
  add(Weakening::drop_underflow, "_range", "scalar a, b, c", "a * b * c");
  result.back().range = "  range |a, b, c| <= 1\n";
  add(Weakening::drop_underflow, "_normalized", "scalar a, b", "b");
  result.back().range = "  normalize a, b\n";
  add(Weakening::halve_unit_roundoff, "", "scalar a, b", "a * b");
  add(Weakening::drop_division_rounding, "_quotient", "scalar a, b", "a / b");
  add(Weakening::drop_dividend_error, "", "bounded scalar a, scalar b", "a / b");
  add(Weakening::drop_divisor_error, "", "scalar a, bounded scalar b", "a / b");
  add(Weakening::drop_divisor_margin, "", "scalar a, bounded scalar b", "a / b");
  add(Weakening::drop_root_rounding, "", "scalar a", "sqrt(a)");
  add(Weakening::drop_radicand_error, "", "bounded scalar a", "sqrt(a)");
  add(Weakening::drop_guards, "_divisor", "scalar a, bounded scalar b", "a / b");
  add(Weakening::drop_guards, "_radicand", "bounded scalar a", "sqrt(a)");
  add(Weakening::drop_second_alternative, "", "scalar a, b", "either(a + b, (rounded(3 * a) + rounded(3 * b)) / 3)");
  if (mode == BoundMode::safe) return result;  // (B, k) has no such terms, or they do not show
  add(Weakening::drop_dividend_error, "_relative", "scalar a, b, c", "(a - b) / c");
  add(Weakening::drop_divisor_error, "_relative", "scalar a, b, c", "a / (b - c)");
  add(Weakening::drop_radicand_error, "_relative", "scalar a, b", "sqrt(a - b)");
  add(Weakening::drop_fma_rounding, "", "scalar a, b, c", "fma(a, b, c)");
  add(Weakening::drop_first_factor_error, "_fma", "bounded scalar a, scalar b, c", "fma(a, b, c)");
  add(Weakening::drop_second_factor_error, "_fma", "scalar a, bounded scalar b, scalar c", "fma(a, b, c)");
  add(Weakening::drop_operand_error_of_sums, "_fma", "scalar a, b, bounded scalar c", "fma(a, b, c)");
  add(Weakening::drop_rounding_of_products, "_general", "scalar a, b, c, d", "(a * b + c) * d");
  add(Weakening::drop_first_factor_error, "_relative", "scalar a, b, c, d", "(a - b) * (c - d)");
  add(Weakening::drop_first_factor_error, "_general", "scalar a, b, c, d, e, f", "(a * b + c) * (d * e + f)");
  add(Weakening::drop_second_factor_error, "_relative", "scalar a, b, c, d", "(a - b) * (c - d)");
  add(Weakening::drop_second_factor_error, "_general", "scalar a, b, c, d, e, f", "(a * b + c) * (d * e + f)");
  add(Weakening::drop_operand_error_of_sums, "", "scalar a, b, c, d", "a * b + c * d");
  add(Weakening::drop_product_of_errors, "", "bounded scalar a, b", "a * b");
  return result;
}

int complain(const std::string& message) {
  fmt::print(stderr, "weakened_generator: {}\n", message);
  return 2;
}

std::string check_names(const std::vector<Case>& table, BoundMode mode, const std::set<std::string>& expected) {
  std::set<std::string> names;
  for (const Case& c : table) names.insert(c.name);
  if (names != expected) return "the names on the command line are not those of the table";
  for (const Weakening weakening : all_weakenings) {
    const bool used = std::any_of(table.begin(), table.end(), [&](const Case& c) { return c.weakening == weakening; });
    if (!used && mode == BoundMode::tight) return std::string("no predicate for ") + name(weakening);
  }
  return "";
}

int generate(BoundMode mode, const std::filesystem::path& directory, const std::vector<Case>& table) {
  std::string source;
  for (const Case& c : table) {
    for (const char* prefix : {"", "sound_"}) {
      source += fmt::format("predicate {}{}({}) {{\n{}  sign {} as y\n}}\n", prefix, c.name, c.parameters, c.range,
                            c.expression);
    }
  }
  const std::string stem = "weakened";
  const std::string mode_name = codegen::name(mode);
  const std::filesystem::path pred = directory / (stem + "." + mode_name + ".pred");
  if (const auto error = codegen::write_files(std::vector<codegen::TextFile>{{pred, source}}); !error.empty()) {
    return complain(error);
  }
  dsl::SourceMap sources;
  dsl::Diagnostics diagnostics;
  const dsl::Program program = dsl::load_program(pred.string(), sources, diagnostics);
  std::vector<codegen::BoundedPredicate> bounded;
  for (std::size_t i = 0; i < program.predicates.size(); ++i) {
    const Weakening weakening = i % 2 == 0 ? table[i / 2].weakening : Weakening::none;
    bounded.push_back(
        codegen::add_bounds(program.predicates[i], mode, codegen::Precision::binary64, diagnostics, weakening));
  }
  if (diagnostics.has_errors()) return complain(diagnostics.render(sources));
  std::vector<codegen::GeneratedPredicate> predicates;
  for (std::size_t i = 0; i < bounded.size(); ++i) predicates.push_back({&program.predicates[i], &bounded[i]});
  const codegen::Precision precision = codegen::Precision::binary64;
  const std::string error = codegen::write_files(std::vector<codegen::TextFile>{
      {directory / codegen::header_name(stem, mode, precision),
       codegen::print_header(predicates, {stem + ".pred", 0, mode, precision})},
      {directory / (stem + "." + mode_name + ".test.cpp"),
       codegen::print_tests(program, {stem, stem + ".pred", 0, {mode}, {precision}, true})}});
  return error.empty() ? 0 : complain(error);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return complain("usage: weakened_generator safe|tight DIRECTORY NAME...");
  const BoundMode mode = std::string(argv[1]) == "safe" ? BoundMode::safe : BoundMode::tight;
  const std::vector<Case> table = cases(mode);
  const std::string error = check_names(table, mode, std::set<std::string>(argv + 3, argv + argc));
  return error.empty() ? generate(mode, argv[2], table) : complain(error);
}
