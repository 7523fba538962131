#pragma once
/// The schemes of one predicate that differ, with their bounds and operations.

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "codegen/count.h"
#include "codegen/explore/scheme.h"

namespace tightrope::codegen::explore {

/// A filter in single precision (float_first.h).
struct FloatFilter {
  dsl::Predicate predicate;
  BoundedPredicate bounded;
};

struct Candidate {
  Scheme scheme;
  std::vector<std::string> aliases;           ///< schemes that come to the same code
  dsl::Predicate predicate;                   ///< computed by this scheme
  BoundedPredicate bounded;                   ///< with a filter: of double
  Precision precision = Precision::binary64;  ///< of `bounded`
  std::optional<FloatFilter> filter;
  std::vector<Cost> costs;  ///< by stage; with a filter: of the filter

  std::string name() const { return explore::name(scheme); }
  /// Operations of the stages up to `stage`.
  OperationCount values(std::size_t stage) const;
  OperationCount bounds(std::size_t stage) const;
  int operations(std::size_t stage) const { return values(stage).total() + bounds(stage).total(); }
};

/// A predicate in a file, in all ways that the language front lowers it, by ProductScheme and EvaluationScheme.
struct Lowerings {
  dsl::Predicate predicates[2][2];
  const dsl::Predicate& written() const { return predicates[0][0]; }
};

/// Loads the predicate `name` of a file (empty: its only one) in all ways. Returns "" or one line on what is wrong with
/// the name; errors in the file go to `diagnostics`. `source_hash`: of the file and its imports.
std::string load_lowerings(const std::string& file, const std::string& name, dsl::SourceMap& sources,
                           dsl::Diagnostics& diagnostics, Lowerings& lowerings, std::uint64_t& source_hash);

/// What a pass of this folder, or a lowering, made is not the polynomial as written: a defect of this compiler.
struct UnequalScheme : std::logic_error {
  using std::logic_error::logic_error;
};

/// All schemes whose code differs, in the order of all_schemes(); of several with the same code the first, which knows
/// the others' names. Schemes that the predicate has no bounds for are left out. `inputs` is the type of the inputs.
/// Throws UnequalScheme, if exact evaluation at random points says so.
std::vector<Candidate> candidates(const Lowerings& lowerings, Precision inputs);

/// Whether the outputs of two predicates with the same inputs have the same exact values at `points` random points with
/// coordinates that are whole numbers below 2^20. Two unequal polynomials of degree d agree at one such point with a
/// probability of at most d / 2^20 [Schwartz 1980, Zippel 1979]. Points where either is no number are passed over.
bool equal_at_random_points(const dsl::Predicate& a, const dsl::Predicate& b, int points);

}  // namespace tightrope::codegen::explore
