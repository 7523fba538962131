#include "codegen/compile.h"

#include <algorithm>

#include "codegen/clang/format.h"
#include "codegen/clang/validate.h"
#include "codegen/fuse.h"
#include "codegen/hash.h"
#include "codegen/print_cpp.h"
#include "codegen/print_cuda.h"
#include "codegen/print_exact.h"
#include "codegen/print_staged.h"
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

std::string exact_header(const dsl::Program& program, const HeaderOptions& options, const std::string& name,
                         dsl::Diagnostics& diagnostics) {
  std::vector<ExactProgram> exact;
  for (const dsl::Predicate& predicate : program.predicates) {
    exact.push_back(exact_program(predicate, diagnostics).value_or(ExactProgram{}));
  }
  if (diagnostics.has_errors()) return {};
  std::vector<ExactPredicate> predicates;
  for (std::size_t i = 0; i < exact.size(); ++i) predicates.push_back({&program.predicates[i], &exact[i]});
  return formatted(print_exact_header(predicates, options), name);
}

/// Each filter is validated as a header of its own; the staged header holds the same text.
std::string staged_header(const dsl::Program& program, const HeaderOptions& options, const std::string& name,
                          dsl::Diagnostics& diagnostics, Weakening weakening) {
  std::vector<StagedPredicate> staged;
  for (const dsl::Predicate& predicate : program.predicates) {
    if (auto s = staged_predicate(predicate, options.precision, diagnostics, weakening))
      staged.push_back(std::move(*s));
  }
  if (diagnostics.has_errors()) return {};
  for (const StagedPredicate& s : staged) {
    for (const StagedFilter& filter : s.filters) {
      const GeneratedPredicate generated = {s.predicate, &filter.bounded};
      HeaderOptions of_filter = options;
      of_filter.mode = filter.mode;
      validated_header({&generated, 1}, of_filter, header_name("filter", filter.mode, options.precision));
    }
  }
  return formatted(print_staged_header(staged, options), name);
}

bool has_bounds(BoundMode mode) { return mode != BoundMode::exact && mode != BoundMode::staged; }

/// The headers of the modes whose signs are always known.
std::vector<TextFile> exact_files(const CompileRequest& request, const std::vector<BoundMode>& modes,
                                  const dsl::Program& program, HeaderOptions options, const std::string& stem,
                                  dsl::Diagnostics& diagnostics, Weakening weakening) {
  std::vector<TextFile> files;
  for (const BoundMode mode : modes) {
    if (has_bounds(mode)) continue;
    for (const Precision precision : request.precisions) {
      options.mode = mode;
      options.precision = precision;
      const std::string name = header_name(stem, mode, precision);
      dsl::Diagnostics errors;
      files.push_back({request.directory / name, mode == BoundMode::exact
                                                     ? exact_header(program, options, name, errors)
                                                     : staged_header(program, options, name, errors, weakening)});
      add_new_errors(errors, diagnostics);
    }
  }
  return files;
}

/// One mode and precision, every target.
std::vector<TextFile> bounded_files(const CompileRequest& request, std::span<const GeneratedPredicate> predicates,
                                    HeaderOptions options, const std::string& stem) {
  std::vector<TextFile> files;
  const bool cuda = wants(request, Target::cuda);
  for (const Form form : {Form::scalar, Form::lanes}) {
    if (!(form == Form::scalar ? cuda || wants(request, Target::cpp) : wants(request, Target::simd))) continue;
    options.form = form;
    const std::string name = header_name(stem, options.mode, options.precision, form);
    files.push_back({request.directory / name, validated_header(predicates, options, name)});
  }
  if (cuda) {
    const std::string header = cuda_header_name(stem, options.mode, options.precision);
    const std::string source = cuda_source_name(stem, options.mode, options.precision);
    files.push_back({request.directory / header, formatted(print_cuda_header(predicates, options, stem), header)});
    files.push_back({request.directory / source, formatted(print_cuda_source(predicates, options, stem), source)});
  }
  return files;
}

}  // namespace

bool wants(const CompileRequest& request, Target target) {
  return std::find(request.targets.begin(), request.targets.end(), target) != request.targets.end();
}

dsl::Program load(const CompileRequest& request, dsl::SourceMap& sources, dsl::Diagnostics& diagnostics) {
  dsl::Program program = dsl::load_program(request.file, sources, diagnostics, {.products = request.products});
  if (request.fma && !diagnostics.has_errors()) {
    for (dsl::Predicate& predicate : program.predicates) predicate = contract_products(predicate);
  }
  return program;
}

std::vector<BoundedProgram> bounded_programs(const dsl::Program& program, const std::vector<BoundMode>& modes,
                                             const std::vector<Precision>& precisions, dsl::Diagnostics& diagnostics,
                                             Weakening weakening) {
  std::vector<BoundedProgram> result;
  for (const BoundMode mode : modes) {
    if (!has_bounds(mode)) continue;
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
  const auto& predicates = program.predicates;
  const auto refused = [&](auto made) { return std::any_of(predicates.begin(), predicates.end(), made); };
  dsl::Diagnostics ignored;
  const auto no_exact = [&](const dsl::Predicate& p) { return !exact_program(p, ignored); };
  const auto no_staged = [&](const dsl::Predicate& p) { return !staged_predicate(p, Precision::binary64, ignored); };
  if (refused(no_exact)) std::erase(modes, BoundMode::exact);
  if (refused(no_staged)) std::erase(modes, BoundMode::staged);
  return modes;
}

std::uint64_t source_hash(const dsl::Program& program, const dsl::SourceMap& sources) {
  Fnv1a hash;
  for (const std::uint32_t file : program.files) hash.add_text(sources.file(file).text);
  return hash.value();
}

std::string validated_header(std::span<const GeneratedPredicate> predicates, const HeaderOptions& options,
                             const std::string& name) {
  std::string text = formatted(print_header(predicates, options), name);
  std::vector<AnalysedPredicate> analysed;
  for (const GeneratedPredicate& p : predicates) analysed.push_back({p.predicate, p.bounded});
  const std::string mismatch = validate(text, name, analysed, options.mode, options.precision, options.form);
  if (!mismatch.empty()) throw TranslationError(mismatch);
  return text;
}

std::optional<std::vector<TextFile>> compile(const CompileRequest& request, dsl::SourceMap& sources,
                                             dsl::Diagnostics& diagnostics, Weakening weakening) {
  const dsl::Program program = load(request, sources, diagnostics);
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
    HeaderOptions options = {source_name, hash, bounded.mode, bounded.precision, request.fma};
    for (TextFile& file : bounded_files(request, predicates, options, stem)) files.push_back(std::move(file));
  }
  // Exact answers know no rounding: their filters stay unfused.
  const dsl::Program unfused =
      request.fma ? dsl::load_program(request.file, sources, diagnostics, {.products = request.products}) : program;
  const std::vector<BoundMode> scalar_modes = wants(request, Target::cpp) ? modes : std::vector<BoundMode>();
  for (TextFile& file :
       exact_files(request, scalar_modes, unfused, {source_name, hash, BoundMode::exact, Precision::binary64}, stem,
                   diagnostics, weakening)) {
    files.push_back(std::move(file));
  }
  if (diagnostics.has_errors()) return std::nullopt;
  if (request.tests) {
    // The reference is the direct product scheme, unfused, whatever the generated code uses.
    dsl::SourceMap reference_sources;
    const dsl::Program reference = dsl::load_program(request.file, reference_sources, diagnostics, {});
    if (diagnostics.has_errors()) return std::nullopt;
    TestOptions options = {stem, source_name,        hash,
                           {},   request.precisions, request.products == dsl::ProductScheme::direct && !request.fma};
    for (const BoundMode mode : modes) (has_bounds(mode) ? options.modes : options.exact_modes).push_back(mode);
    files.push_back({request.directory / (stem + ".test.cpp"), print_tests(reference, options)});
    files.push_back({request.directory / "CMakeLists.txt", print_test_project(request.fma)});
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
