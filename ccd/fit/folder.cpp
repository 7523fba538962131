#include "fit/folder.h"

#include <fmt/format.h>

#include <algorithm>

#include "fit/report.h"

namespace tightrope::ccd {
namespace {

/// What the texts say of one kind.
struct Words {
  std::string id;     ///< vertex_face
  std::string model;  ///< VertexFace
  std::string plane;  ///< plane_of_face
  std::string rest;   ///< face_at_rest
  std::string real;
  std::string bound;   ///< of the command
  std::string tag;     ///< of the generated code
  std::string range;   ///< as C++ has it
  std::string method;  ///< the enumerator
  std::string look;    ///< in words
};

std::string underscored(std::string_view text) {
  std::string result(text);
  std::replace(result.begin(), result.end(), '-', '_');
  return result;
}

Words words(const Choice& choice) {
  const bool faces = choice.kind == Kind::vertex_face;
  Words w;
  w.id = underscored(name(choice.kind));
  w.model = faces ? "VertexFace" : "EdgeEdge";
  w.plane = faces ? "plane_of_face" : "plane_of_edges";
  w.rest = faces ? "face_at_rest" : "edge_at_rest";
  w.real = choice.look.single ? "float" : "double";
  w.bound = choice.look.range ? "static" : "safe";
  w.tag = choice.look.range ? "fixed" : "safe";
  w.range = choice.exponent ? fmt::format("0x1p{}{}", *choice.exponent, choice.look.single ? "f" : "")
                            : fmt::format("std::numeric_limits<{}>::infinity()", w.real);
  w.method = underscored(name(choice.method));
  w.look = in_words(choice.look, choice.kind, choice.exponent ? fmt::format("range 2^{}", *choice.exponent) : "");
  return w;
}

std::string header(const std::string& name, const std::vector<Choice>& choices, bool times) {
  std::string text = fmt::format(
      "#pragma once\n"
      "/// Collision queries fitted to a scene by `tightrope-ccd fit`: a first look that takes for granted what holds "
      "in\n"
      "/// the scene, and tests it; the full query behind it. Queries unlike those of the scene get the full query, "
      "so\n"
      "/// that no contact is missed wherever they come from. `points` as in <tightrope/ccd.h>.\n\n"
      "#include <tightrope/ccd.h>\n{}\n#include <cstddef>\n{}",
      times ? "#include <tightrope/impact.h>\n" : "", times ? "#include <optional>\n" : "");
  for (const Choice& choice : choices) {
    const Words w = words(choice);
    text += fmt::format(
        "\n/// First look: {2}. Behind it: method {3}.\n"
        "bool {0}_{1}(const {4}* points);\n"
        "void {0}_{1}(const {4}* points, std::size_t count, unsigned char* results);\n",
        name, w.id, w.look, ccd::name(choice.method), w.real);
    if (!times) continue;
    text += fmt::format(
        "/// As first_impact of <tightrope/impact.h>.\n"
        "std::optional<tightrope::ccd::Impact> {0}_{1}_impact(const {2}* points,\n"
        "    const tightrope::ccd::ImpactOptions& options = {{}});\n",
        name, w.id, w.real);
  }
  return text;
}

std::string model(const std::string& name, const Choice& choice) {
  const Words w = words(choice);
  const std::string generated = "tightrope::generated::" + name + "_";
  const std::string arguments = fmt::format("<tightrope::bound::{}, {}>", w.tag, w.real);
  return fmt::format(
      "struct {0} {{\n"
      "  using Real = {1};\n"
      "  using Plane = {2}{3}{4};\n"
      "  using AtRest = {5};\n"
      "  static constexpr Real range = {6};  // as in {7}_{8}.pred\n"
      "  static constexpr bool both_ends = {9};\n"
      "}};\n",
      w.model, w.real, generated, w.plane, arguments, choice.look.at_rest ? generated + w.rest + arguments : "void",
      w.range, name, w.id, choice.look.both_ends);
}

std::string functions(const std::string& name, const Choice& choice, bool times) {
  const Words w = words(choice);
  std::string text = fmt::format(
      "\nbool {0}_{1}(const {3}* points) {{\n"
      "  return fitted::contact<Kind::{1}, {2}>(points, Method::{4});\n"
      "}}\n"
      "void {0}_{1}(const {3}* points, std::size_t count, unsigned char* results) {{\n"
      "  fitted::contacts<Kind::{1}, {2}>(points, count, results, Method::{4});\n"
      "}}\n",
      name, w.id, w.model, w.real, w.method);
  if (!times) return text;
  return text +
         fmt::format(
             "std::optional<tightrope::ccd::Impact> {0}_{1}_impact(const {3}* points,\n"
             "    const tightrope::ccd::ImpactOptions& options) {{\n"
             "  // The look tells of contact alone, not of distances.\n"
             "  if (options.minimum_separation <= 0 && fitted::apart<Kind::{1}, {2}>(points)) return std::nullopt;\n"
             "  return tightrope::ccd::first_impact(tightrope::ccd::Pair::{1}, points, options);\n"
             "}}\n",
             name, w.id, w.model, w.real);
}

std::string source(const std::string& name, const std::vector<Choice>& choices, bool times) {
  std::string text = fmt::format("#include \"{}.h\"\n\n#include <tightrope/fitted.h>\n\n#include <limits>\n\n", name);
  for (const Choice& choice : choices) {
    const Words w = words(choice);
    text += fmt::format("#include \"{}_{}.{}.{}.h\"\n", name, w.id, w.bound, w.real);
  }
  text +=
      "\nnamespace {\n\nnamespace fitted = tightrope::ccd::fitted;\nusing tightrope::ccd::Kind;\n"
      "using tightrope::ccd::Method;\n";
  for (const Choice& choice : choices) text += "\n" + model(name, choice);
  text += "\n}  // namespace\n";
  for (const Choice& choice : choices) text += functions(name, choice, times);
  return text;
}

std::string build(const std::string& name, const std::vector<Choice>& choices) {
  std::string text = fmt::format(
      "# Written by `tightrope-ccd fit`: the library {0}, and {0}_check, which compares it with the full queries.\n"
      "cmake_minimum_required(VERSION 3.20)\n"
      "project({0} LANGUAGES CXX)\n"
      "if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)\n"
      "  set(CMAKE_BUILD_TYPE Release)\n"
      "endif()\n"
      "find_package(Tightrope REQUIRED)\n\n"
      "add_library({0} STATIC {0}.cpp)\n"
      "target_compile_features({0} PUBLIC cxx_std_20)\n"
      "target_include_directories({0} PUBLIC ${{CMAKE_CURRENT_SOURCE_DIR}})\n"
      "target_link_libraries({0} PUBLIC tightrope::ccd)\n",
      name);
  for (const Choice& choice : choices) {
    const Words w = words(choice);
    text += fmt::format("tightrope_add_predicates({0} FILES {0}_{1}.pred BOUNDS {2} REALS {3})\n", name, w.id, w.bound,
                        w.real);
  }
  return text + fmt::format(
                    "\nadd_executable({0}_check {0}_check.cpp)\n"
                    "target_link_libraries({0}_check PRIVATE {0})\n",
                    name);
}

/// {0} the fit's name, {1} the calls of compare(), {2} the include of its header. No other braces but doubled ones.
constexpr std::string_view check_program =
    R"(/// {0}_check KIND FILE ...: the fitted queries against the full ones on the queries in FILE, 24 numbers of type double
/// each, as this machine has them in memory. Exit status 1 if the fit misses a contact.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <vector>

{2}

namespace {{

using tightrope::ccd::Kind;

std::vector<double> read(const char* path) {{
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::vector<double> numbers(file ? static_cast<std::size_t>(file.tellg()) / sizeof(double) / 24 * 24 : 0);
  file.seekg(0);
  file.read(reinterpret_cast<char*>(numbers.data()), static_cast<std::streamsize>(numbers.size() * sizeof(double)));
  return numbers;
}}

template <class Pass>
double nanoseconds(const Pass& pass) {{
  const auto start = std::chrono::steady_clock::now();
  pass();
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
}}

double median(std::vector<double>& values) {{
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}}

/// The number of missed contacts; prints all there is to say.
template <class Real>
std::size_t compare(Kind kind, const char* path, void (*fitted)(const Real*, std::size_t, unsigned char*)) {{
  const std::vector<double> points = read(path);
  const std::vector<Real> fitted_points(points.begin(), points.end());
  const std::size_t count = points.size() / 24;
  if (count == 0) {{
    std::printf("%s: no queries\n", path);
    return 1;
  }}
  std::vector<unsigned char> full_answers(count), answers(count);
  // Both take turns at blocks of queries: few passes are interrupted by whatever else the machine does. Every round goes
  // through all blocks: branch prediction cannot learn a block by heart.
  const std::size_t few = std::min<std::size_t>(count, 256);
  const double slow = nanoseconds([&] {{ fitted(fitted_points.data(), few, answers.data()); }}) / static_cast<double>(few);
  const auto block = static_cast<std::size_t>(std::clamp(1e5 / slow, 16.0, 2048.0));
  const std::size_t blocks = (count + block - 1) / block;
  std::vector<std::vector<double>> full_times(blocks), times(blocks);
  for (int round = 0; round < 31; ++round) {{
    for (std::size_t b = 0; b < blocks; ++b) {{
      const std::size_t first = b * block, n = std::min(block, count - first);
      full_times[b].push_back(nanoseconds([&] {{
        collides(kind, &points[24 * first], n, &full_answers[first], tightrope::ccd::Method::tightrope);
      }}));
      times[b].push_back(nanoseconds([&] {{ fitted(&fitted_points[24 * first], n, &answers[first]); }}));
    }}
  }}
  double full_time = 0, time = 0;
  for (std::size_t b = 0; b < blocks; ++b) {{
    full_time += median(full_times[b]) / static_cast<double>(count);
    time += median(times[b]) / static_cast<double>(count);
  }}
  std::size_t misses = 0, false_positives = 0;
  for (std::size_t i = 0; i < count; ++i) {{
    misses += answers[i] < full_answers[i] ? 1 : 0;
    false_positives += answers[i] > full_answers[i] ? 1 : 0;
  }}
  std::printf("%s: %zu queries, %zu misses, %zu false positives; full %.1f ns, fitted %.1f ns a query: %.2f times as fast\n",
              kind == Kind::vertex_face ? "vertex-face" : "edge-edge", count, misses, false_positives, full_time, time,
              full_time / time);
  return misses;
}}

}}  // namespace

int main(int argc, char** argv) {{
  std::size_t misses = argc < 3 ? 1 : 0;
  for (int i = 1; i + 1 < argc; i += 2) {{
    bool known = false;
{1}    if (!known) misses += 1;
  }}
  return misses == 0 ? 0 : 1;
}}
)";

std::string check(const std::string& name, const std::vector<Choice>& choices) {
  std::string calls;
  for (const Choice& choice : choices) {
    const Words w = words(choice);
    calls += fmt::format(
        "    if (std::strcmp(argv[i], \"{2}\") == 0) {{\n"
        "      misses += compare<{3}>(Kind::{1}, argv[i + 1], {0}_{1});\n"
        "      known = true;\n"
        "    }}\n",
        name, w.id, ccd::name(choice.kind), w.real);
  }
  return fmt::format(fmt::runtime(check_program), name, calls, fmt::format("#include \"{}.h\"", name));
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

}  // namespace

bool is_fit_name(const std::string& name) {
  const auto fits = [](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; };
  return !name.empty() && is_letter(name.front()) && std::all_of(name.begin(), name.end(), fits);
}

std::vector<FitFile> fit_files(const std::string& name, const std::vector<Choice>& choices, bool times) {
  std::vector<FitFile> files;
  for (const Choice& choice : choices) {
    files.push_back(
        {fmt::format("{}_{}.pred", name, words(choice).id),
         fmt::format("// Written by `tightrope-ccd fit`.\n{}", predicates(name, choice.kind, choice.exponent))});
  }
  files.push_back({name + ".h", header(name, choices, times)});
  files.push_back({name + ".cpp", source(name, choices, times)});
  files.push_back({name + "_check.cpp", check(name, choices)});
  files.push_back({"CMakeLists.txt", build(name, choices)});
  return files;
}

}  // namespace tightrope::ccd
