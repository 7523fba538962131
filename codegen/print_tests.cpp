#include "codegen/print_tests.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "codegen/interface.h"
#include "codegen/print_cpp.h"
#include "codegen/print_exact_tests.h"
#include "codegen/print_reference.h"

namespace tightrope::codegen {
namespace {

/// Operations that the tests of one file may evaluate exactly (each takes 0.2 to 1 microsecond), and how many tests
/// share them for each predicate and scalar type.
constexpr int operation_budget = 6'000'000;
constexpr int tests_of_one_predicate = 15;

/// Of the signs on generic inputs, these fractions must be definite. Far below what sound bounds reach, above 0.
constexpr double definite_tight = 0.5;
constexpr double definite_safe = 0.25;

/// The largest number of inputs that are multiplied with each other in a graph.
int degree(const dsl::Graph& graph) {
  std::vector<int> degrees;
  for (dsl::NodeId id = 0; id < graph.size(); ++id) {
    const dsl::Node& n = graph[id];
    const auto at = [&](dsl::NodeId operand) {
      return operand == dsl::no_node ? 0 : degrees[static_cast<std::size_t>(operand)];
    };
    const bool product = n.op == dsl::Op::mul || n.op == dsl::Op::fma;
    const int factors = product ? at(n.a) + at(n.b) : std::max(at(n.a), at(n.b));
    degrees.push_back(n.op == dsl::Op::input ? 1 : std::min(std::max(factors, at(n.c)), 1000));
  }
  return degrees.empty() ? 0 : *std::max_element(degrees.begin(), degrees.end());
}

bool has_alternatives(const dsl::Graph& graph) {
  for (dsl::NodeId id = 0; id < graph.size(); ++id) {
    if (graph[id].op == dsl::Op::select) return true;
  }
  return false;
}

class TestPrinter {
 public:
  TestPrinter(const dsl::Predicate& predicate, const TestOptions& options, int budget)
      : predicate_(predicate),
        options_(options),
        budget_(budget),
        arguments_(arguments(predicate)),
        several_stages_(predicate.stages.size() > 1),
        has_range_(std::any_of(predicate.parameters.begin(), predicate.parameters.end(),
                               [](const dsl::Parameter& p) { return p.range.has_value(); })),
        has_bounds_(std::any_of(options.modes.begin(), options.modes.end(),
                                [](BoundMode mode) { return mode != BoundMode::none; })) {}

  std::string print() {
    out_ = print_reference(predicate_, options_.same_products, budget_);
    if (options_.modes.empty()) return std::move(out_);
    print_adapter("");
    if (has_range_) {
      print_adapter("_in_range");
      print_range_adapter();
    }
    for (const Precision precision : options_.precisions) {
      print_codes(precision);
      print_checks(precision);
    }
    return std::move(out_);
  }

 private:
  const std::string& name() const { return predicate_.name; }
  void line(std::string_view text) { (out_ += text) += '\n'; }

  void print_adapter(const std::string& suffix);
  void print_range_adapter();
  void print_arguments();
  std::string argument_list() const;
  std::string property_id(std::size_t index) const;
  double least_definite(BoundMode mode) const;
  void print_codes(Precision precision);
  void print_checks(Precision precision);

  const dsl::Predicate& predicate_;
  const TestOptions& options_;
  int budget_;
  std::vector<Argument> arguments_;
  bool several_stages_;
  bool has_range_;
  bool has_bounds_;
  std::string out_;
};

/// "antisymmetric_a_b", numbered if declared twice.
std::string TestPrinter::property_id(std::size_t index) const {
  const auto id = [&](std::size_t i) {
    std::string text = property_text(predicate_, predicate_.properties[i]);
    std::string result;
    for (const char c : text) {
      const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
      if (plain || c == '-') result += plain ? c : 'm';
      if (c == '(' || c == ' ') result += '_';
    }
    return result;
  };
  const std::string result = id(index);
  for (std::size_t i = 0; i < predicate_.properties.size(); ++i) {
    if (i != index && id(i) == result) return fmt::format("{}_{}", result, index);
  }
  return result;
}

/// Flat slots become the arguments a0, a1, ... of the generated functions.
void TestPrinter::print_arguments() {
  for (std::size_t a = 0; a < arguments_.size(); ++a) {
    const Argument& argument = arguments_[a];
    std::vector<std::string> items;
    for (const int slot : argument.slots)
      items.push_back(fmt::format("x[{}]{}", slot, argument.bounded ? "" : ".value"));
    const std::string type = argument.bounded ? "Bounded<Real>" : "Real";
    if (argument.pointer) {
      for (std::size_t i = 0; i < items.size(); ++i) items[i] += i + 1 < items.size() ? "," : "};";
      line(wrap(fmt::format("  const {} a{}[] = {{", type, a), items));
    } else {
      line(fmt::format("  const {} a{} = {};", type, a, items.front()));
    }
  }
}

std::string TestPrinter::argument_list() const {
  std::string list;
  for (std::size_t a = 0; a < arguments_.size(); ++a) list += fmt::format("{}a{}", a == 0 ? "" : ", ", a);
  return list;
}

void TestPrinter::print_adapter(const std::string& suffix) {
  line("\ntemplate <class Bound, class Real>");
  const std::string_view x = arguments_.empty() ? "/*x*/" : "x";
  line(fmt::format("void {}_evaluate{}(const Bounded<Real>* {}, Bounded<Real>* y) {{", name(), suffix, x));
  line(fmt::format("  using Code = generated::{}<Bound, Real>;", name()));
  print_arguments();
  if (several_stages_) line("  typename Code::State state;");
  for (std::size_t s = 0; s < predicate_.stages.size(); ++s) {
    const dsl::Stage& stage = predicate_.stages[s];
    const std::string_view state = !several_stages_ ? "" : arguments_.empty() ? "state" : ", state";
    line(fmt::format("  const auto r{} = Code::{}{}({}{});", s, stage.name, suffix, argument_list(), state));
    for (const dsl::Output& output : stage.outputs) line(fmt::format("  y = collect(r{}.{}, y);", s, output.name));
  }
  line("}");
}

void TestPrinter::print_range_adapter() {
  line("\ntemplate <class Bound, class Real>");
  line(fmt::format("bool {}_in_range(const Bounded<Real>* x) {{", name()));
  print_arguments();
  line(fmt::format("  return generated::{}<Bound, Real>::in_range({});", name(), argument_list()));
  line("}");
}

/// A number as bound is of use only where the inputs fill their ranges, which generic inputs (in [-1, 1], none with an
/// error) do if no range exceeds 1; and where few factors make a value, so that most values are not tiny.
double TestPrinter::least_definite(BoundMode mode) const {
  if (mode == BoundMode::none) return 0;
  if (mode != BoundMode::fixed) return mode == BoundMode::tight ? definite_tight : definite_safe;
  const bool filled = std::all_of(predicate_.parameters.begin(), predicate_.parameters.end(),
                                  [](const dsl::Parameter& p) { return p.range.value_or(2) <= 1 && !p.bounded; });
  return filled && degree(predicate_.graph) <= 4 ? definite_safe : 0;
}

void TestPrinter::print_codes(Precision precision) {
  const std::string real = codegen::name(precision);
  line(fmt::format("\nconst Code<{0}> {1}_codes_{0}[] = {{", real, name()));
  for (const BoundMode mode : options_.modes) {
    const bool bounds = mode != BoundMode::none;
    const double definite = least_definite(mode);
    const auto function = [&](std::string_view suffix) {
      return fmt::format("{}_{}<{}, {}>", name(), suffix, tag(mode), real);
    };
    line(
        fmt::format("    {{\"{} {}\", {}, {}, {},", codegen::name(mode), real, bounds, definite, function("evaluate")));
    const std::string own_values = mode == BoundMode::interval ? ", true" : "";
    line(has_range_ ? fmt::format("     {}, {}{}}},", function("evaluate_in_range"), function("in_range"), own_values)
                    : fmt::format("     nullptr, nullptr{}}},", own_values));
  }
  line("};");
}

void TestPrinter::print_checks(Precision precision) {
  const std::string real = codegen::name(precision);
  const auto test = [&](std::string_view test_name, std::string_view function, std::string_view more) {
    line(fmt::format("\nTEST({}_{}, {}) {{", name(), real, test_name));
    line(fmt::format("  expect({2}<{0}>({1}_reference, {1}_codes_{0}{3}));", real, name(), function, more));
    line("}");
  };
  const std::pair<std::string_view, std::string_view> families[] = {
      {"covers_errors_on_uniform_inputs", "uniform"},    {"covers_errors_on_a_lattice", "lattice"},
      {"covers_errors_near_zeros", "zero_set"},          {"covers_errors_on_dependent_inputs", "dependent"},
      {"covers_errors_at_all_scales", "scales"},         {"covers_errors_far_from_the_origin", "far_away"},
      {"covers_errors_on_mixed_magnitudes", "mixed"},    {"covers_errors_under_underflow", "underflow"},
      {"covers_errors_on_extreme_exponents", "extreme"}, {"is_uncertain_on_infinities_and_nan", "not_finite"},
  };
  for (const auto& [test_name, family] : families) {
    test(test_name, "check_family", fmt::format(", Family::{}", family));
  }
  if (has_range_) test("keeps_declared_ranges", "check_ranges", "");
  if (has_alternatives(predicate_.graph)) test("alternatives_are_equal", "check_alternatives", "");
  if (!has_bounds_) return;
  test("covers_the_worst_errors_found", "check_worst_errors", "");
  test("bounds_are_of_use", "check_usefulness", "");
  for (std::size_t p = 0; p < predicate_.properties.size(); ++p) {
    test("keeps_" + property_id(p), "check_property", fmt::format(", {}", p));
  }
}

/// The folder of tightrope/sign.h: beside an installed command, or this build's source.
std::string include_directory() {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path command = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    const fs::path installed = (command.parent_path().parent_path() / "include").lexically_normal();
    if (fs::exists(installed / "tightrope" / "sign.h", error)) return installed.string();
  }
  return fs::exists(fs::path(TIGHTROPE_RUNTIME_DIRECTORY) / "tightrope" / "sign.h", error) ? TIGHTROPE_RUNTIME_DIRECTORY
                                                                                           : "";
}

}  // namespace

std::string print_tests(const dsl::Program& reference, const TestOptions& options) {
  std::string text = fmt::format(
      "// Generated by tightrope {} from {} (FNV-1a {:016x}). Do not edit.\n"
      "//\n"
      "// Checks the generated code against exact arithmetic; docs/generated-code.md tells how.\n"
      "#include <gtest/gtest.h>\n"
      "#include <tightrope/testing.h>\n\n",
      TIGHTROPE_VERSION, comment_text(options.source_name), options.source_hash);
  std::vector<BoundMode> modes = options.modes;
  modes.insert(modes.end(), options.exact_modes.begin(), options.exact_modes.end());
  for (const BoundMode mode : modes) {
    for (const Precision precision : options.precisions) {
      text += fmt::format("#include \"{}\"\n", header_name(options.stem, mode, precision));
    }
  }
  text +=
      "\nnamespace tightrope::testing {\n"
      "namespace {\n\n"
      "void expect(const std::string& failure) { EXPECT_TRUE(failure.empty()) << failure; }\n";
  const std::size_t shares = reference.predicates.size() * options.precisions.size() * tests_of_one_predicate;
  const int budget = operation_budget / static_cast<int>(std::max<std::size_t>(1, shares));
  for (const dsl::Predicate& predicate : reference.predicates) {
    text += TestPrinter(predicate, options, budget).print() + print_exact_tests(predicate, options);
  }
  return text + "\n}  // namespace\n}  // namespace tightrope::testing\n";
}

std::string foreign_file(const std::vector<TextFile>& files) {
  for (const TextFile& file : files) {
    if (file.path.filename() != "CMakeLists.txt") continue;
    std::ifstream stream(file.path, std::ios::binary);
    std::string start(project_mark.size(), '\0');
    if (stream && !(stream.read(start.data(), static_cast<std::streamsize>(start.size())) && start == project_mark)) {
      return file.path.string();
    }
  }
  return {};
}

std::string print_test_project(bool fma) {
  constexpr std::string_view fma_options = R"(
# The code was made with --fma: in hardware where this machine has it, else in software.
include(CheckCXXSourceRuns)
set(CMAKE_REQUIRED_FLAGS -mfma)
check_cxx_source_runs("int main(int n, char**) { return __builtin_fma(n, 2.0, -2.0 * n) == 0 ? 0 : 1; }" HAS_FMA)
unset(CMAKE_REQUIRED_FLAGS)
if(HAS_FMA)
  add_compile_options(-mfma)
else()
  add_compile_definitions(TIGHTROPE_SOFTWARE_FMA)
endif()
)";
  return fmt::format(R"({} {}. Builds and runs the generated tests of this folder:
#   cmake -S . -B build && cmake --build build && ctest --test-dir build
cmake_minimum_required(VERSION 3.20)
project(generated_tests LANGUAGES CXX)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release)
endif()

# Where <tightrope/sign.h> is found; without it, an installed Tightrope is looked for.
set(TIGHTROPE_INCLUDE_DIR "{}" CACHE PATH "folder of tightrope/sign.h")
find_package(GTest REQUIRED)
if(EXISTS "${{TIGHTROPE_INCLUDE_DIR}}/tightrope/testing.h")
  add_library(tightrope_headers INTERFACE)
  target_include_directories(tightrope_headers INTERFACE "${{TIGHTROPE_INCLUDE_DIR}}")
else()
  find_package(Tightrope REQUIRED)
  add_library(tightrope_headers ALIAS tightrope::runtime)
endif()

{}
enable_testing()
include(GoogleTest)
file(GLOB tests CONFIGURE_DEPENDS "${{CMAKE_CURRENT_SOURCE_DIR}}/*.test.cpp")
foreach(test IN LISTS tests)
  get_filename_component(name "${{test}}" NAME_WLE)
  string(MAKE_C_IDENTIFIER "${{name}}" target)
  add_executable(${{target}} "${{test}}")
  target_compile_features(${{target}} PRIVATE cxx_std_20)
  target_link_libraries(${{target}} PRIVATE tightrope_headers GTest::gtest_main)
  gtest_discover_tests(${{target}} TEST_PREFIX ${{target}}. DISCOVERY_TIMEOUT 60)
endforeach()
)",
                     project_mark, TIGHTROPE_VERSION, include_directory(), fma ? fma_options : "");
}

}  // namespace tightrope::codegen
