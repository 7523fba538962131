#include "codegen/compile.h"

#include <algorithm>

#include "codegen/clang/format.h"
#include "codegen/clang/validate.h"
#include "codegen/hash.h"
#include "codegen/print_cpp.h"
#include "codegen/print_tests.h"

namespace tightrope::codegen {
namespace {

namespace fs = std::filesystem;

bool same(const dsl::Diagnostic& a, const dsl::Diagnostic& b) {
  return a.span.file == b.span.file && a.span.begin == b.span.begin && a.message == b.message;
}

void add_new_errors(const dsl::Diagnostics& from, dsl::Diagnostics& to) {
  for (const dsl::Diagnostic& d : from.entries()) {
    const auto& known = to.entries();
    if (std::none_of(known.begin(), known.end(), [&](const dsl::Diagnostic& k) { return same(k, d); })) {
      to.error(d.span, d.message, d.hint);
    }
  }
}

std::string make_escaped(std::string_view path) {
  std::string result;
  for (const char c : path) {
    if (c == ' ' || c == '#' || c == '\\') result += '\\';
    if (c == '$') result += '$';
    result += c;
  }
  return result;
}

std::uint64_t source_hash(const dsl::Program& program, const dsl::SourceMap& sources) {
  Fnv1a hash;
  for (const std::uint32_t file : program.files) hash.add_text(sources.file(file).text);
  return hash.value();
}

/// The header's final text, proved to be what was analysed.
std::string validated_header(std::span<const GeneratedPredicate> predicates, const HeaderOptions& options,
                             const std::string& name) {
  std::string text = formatted(print_header(predicates, options), name);
  std::vector<AnalysedPredicate> analysed;
  for (const GeneratedPredicate& p : predicates) analysed.push_back({p.predicate, p.bounded});
  const std::string mismatch = validate(text, name, analysed, options.mode, options.precision);
  if (!mismatch.empty()) throw TranslationError(mismatch);
  return text;
}

}  // namespace

std::vector<BoundedProgram> bounded_programs(const dsl::Program& program, const std::vector<BoundMode>& modes,
                                             const std::vector<Precision>& precisions, dsl::Diagnostics& diagnostics,
                                             Weakening weakening) {
  std::vector<BoundedProgram> result;
  for (const BoundMode mode : modes) {
    for (const Precision precision : precisions) {
      BoundedProgram bounded{mode, precision, {}};
      dsl::Diagnostics errors;
      for (const dsl::Predicate& predicate : program.predicates) {
        bounded.predicates.push_back(add_bounds(predicate, mode, precision, errors, weakening));
      }
      add_new_errors(errors, diagnostics);
      result.push_back(std::move(bounded));
    }
  }
  return result;
}

std::vector<BoundMode> modes_of(const CompileRequest& request, const dsl::Program& program) {
  std::vector<BoundMode> modes = request.modes;
  if (!request.only_applicable_modes) return modes;
  dsl::Diagnostics errors;
  bounded_programs(program, {BoundMode::fixed}, request.precisions, errors);
  if (errors.has_errors()) std::erase(modes, BoundMode::fixed);
  return modes;
}

std::optional<std::vector<TextFile>> compile(const CompileRequest& request, dsl::SourceMap& sources,
                                             dsl::Diagnostics& diagnostics, Weakening weakening) {
  const dsl::Program program = dsl::load_program(request.file, sources, diagnostics, {.products = request.products});
  if (diagnostics.has_errors()) return std::nullopt;
  const std::vector<BoundMode> modes = modes_of(request, program);
  const std::vector<BoundedProgram> programs =
      bounded_programs(program, modes, request.precisions, diagnostics, weakening);
  if (diagnostics.has_errors()) return std::nullopt;

  const std::string stem = fs::path(request.file).stem().string();
  const std::string source_name = fs::path(request.file).filename().string();
  const std::uint64_t hash = source_hash(program, sources);
  std::vector<TextFile> files;
  for (const BoundedProgram& bounded : programs) {
    std::vector<GeneratedPredicate> predicates;
    for (std::size_t i = 0; i < program.predicates.size(); ++i) {
      predicates.push_back({&program.predicates[i], &bounded.predicates[i]});
    }
    const std::string name = header_name(stem, bounded.mode, bounded.precision);
    files.push_back({request.directory / name,
                     validated_header(predicates, {source_name, hash, bounded.mode, bounded.precision}, name)});
  }
  if (request.tests) {
    // The reference is the direct product scheme, whatever the generated code uses.
    dsl::SourceMap reference_sources;
    const dsl::Program reference = dsl::load_program(request.file, reference_sources, diagnostics, {});
    if (diagnostics.has_errors()) return std::nullopt;
    const TestOptions options = {stem,  source_name,        hash,
                                 modes, request.precisions, request.products == dsl::ProductScheme::direct};
    files.push_back({request.directory / (stem + ".test.cpp"), print_tests(reference, options)});
    files.push_back({request.directory / "CMakeLists.txt", print_test_project()});
  }
  if (!request.depfile.empty()) {
    std::vector<std::string> targets;
    for (const TextFile& file : files) {  // not the project file: ninja refuses targets that its rule does not declare
      if (file.path.filename() == "CMakeLists.txt") continue;
      targets.push_back(fs::absolute(file.path).lexically_normal().string());
    }
    std::vector<std::string> prerequisites;
    for (const std::uint32_t file : program.files) {
      prerequisites.push_back(fs::absolute(sources.file(file).path).lexically_normal().string());
    }
    files.push_back({request.depfile, depfile_text(targets, prerequisites)});
  }
  return files;
}

std::string depfile_text(const std::vector<std::string>& targets, const std::vector<std::string>& prerequisites) {
  std::string text;
  for (const std::string& target : targets) text += (text.empty() ? "" : " \\\n") + make_escaped(target);
  text += ':';
  for (const std::string& prerequisite : prerequisites) text += " \\\n  " + make_escaped(prerequisite);
  return text + "\n";
}

}  // namespace tightrope::codegen
