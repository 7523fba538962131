#pragma once
/// C++ text of predicates in mode `staged`; docs/generated-code.md is the contract.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "codegen/bounds.h"
#include "codegen/print_exact.h"

namespace tightrope::codegen {

/// One filter of a staged predicate: signs that are definite under these bounds are final.
struct StagedFilter {
  BoundMode mode = BoundMode::safe;
  BoundedPredicate bounded;
};

/// A predicate in stages: the filters in order, then exact arithmetic.
struct StagedPredicate {
  const dsl::Predicate* predicate = nullptr;
  std::vector<StagedFilter> filters;  ///< may be empty
  ExactProgram program;
};

/// The stages of a predicate: `static` where all inputs have ranges of use, else SafeBound; then TightBound, as far as
/// they take its operations; then exact. Errors: what
/// exact_program reports, and inputs or outputs that the mode does not know.
std::optional<StagedPredicate> staged_predicate(const dsl::Predicate& predicate, Precision precision,
                                                dsl::Diagnostics& diagnostics, Weakening weakening = Weakening::none);

/// The whole header, FILE.staged.REAL.h.
std::string print_staged_header(std::span<const StagedPredicate> predicates, const HeaderOptions& options);

}  // namespace tightrope::codegen
