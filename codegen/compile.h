#pragma once
/// From a .pred file to the texts that `tightrope compile` writes.

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "codegen/bounds.h"
#include "codegen/print_cpp.h"
#include "codegen/write_files.h"

namespace tightrope::codegen {

/// What code is for.
enum class Target {
  cpp,   ///< NAME.BOUND.REAL.h
  simd,  ///< NAME.BOUND.REAL.simd.h, for vector classes; not of the modes `exact` and `staged`
  cuda,  ///< NAME.BOUND.REAL.h with .cuda.h and .cu, batches on a GPU; not of these modes either
};

struct CompileRequest {
  std::string file;
  std::vector<BoundMode> modes = {BoundMode::tight};
  std::vector<Precision> precisions = {Precision::binary64};
  std::vector<Target> targets = {Target::cpp};
  dsl::ProductScheme products = dsl::ProductScheme::direct;
  bool only_applicable_modes = false;  ///< leave out `static` where the predicates do not admit it
  bool fma = false;                    ///< contract products into sums (codegen/fuse.h)
  bool tests = false;
  std::filesystem::path directory = ".";
  std::string depfile;  ///< empty: none
};

/// What was printed is not what was analysed (codegen/clang/validate.h): a defect of this compiler.
struct TranslationError : std::logic_error {
  using std::logic_error::logic_error;
};

/// A program with the bounds of one mode and precision, predicate by predicate.
struct BoundedProgram {
  BoundMode mode = BoundMode::tight;
  Precision precision = Precision::binary64;
  std::vector<BoundedPredicate> predicates;
};

/// The program of the request, its products contracted if that is asked for.
dsl::Program load(const CompileRequest& request, dsl::SourceMap& sources, dsl::Diagnostics& diagnostics);

/// The modes of the request, without those that some predicate has no code for if they are to be applicable: `static`
/// without ranges, `exact` and `staged` where they would be refused.
std::vector<BoundMode> modes_of(const CompileRequest& request, const dsl::Program& program);

/// Bounds of every predicate in every combination whose mode has bounds (not `exact`, not `staged`); an error that
/// several combinations share is reported once.
std::vector<BoundedProgram> bounded_programs(const dsl::Program& program, const std::vector<BoundMode>& modes,
                                             const std::vector<Precision>& precisions, dsl::Diagnostics& diagnostics,
                                             Weakening weakening = Weakening::none);

/// The files to write, formatted, every header validated; nothing if there are errors. Throws a TranslationError.
/// `weakening` is the test hook of codegen/bounds.h.
std::optional<std::vector<TextFile>> compile(const CompileRequest& request, dsl::SourceMap& sources,
                                             dsl::Diagnostics& diagnostics, Weakening weakening = Weakening::none);

/// Whether the request wants code for this.
bool wants(const CompileRequest& request, Target target);

/// What headers say of their source: the hash of the file's text and that of its imports.
std::uint64_t source_hash(const dsl::Program& program, const dsl::SourceMap& sources);

/// The text of a header of these predicates, formatted, proved to be what was analysed. Throws a TranslationError.
std::string validated_header(std::span<const GeneratedPredicate> predicates, const HeaderOptions& options,
                             const std::string& name);

/// Targets and prerequisites as make and ninja read them.
std::string depfile_text(const std::vector<std::string>& targets, const std::vector<std::string>& prerequisites);

}  // namespace tightrope::codegen
