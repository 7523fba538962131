#pragma once
/// C++ text of predicates in mode `exact`; docs/generated-code.md is the contract.

#include <cstdint>
#include <span>
#include <string>

#include "codegen/exact_program.h"
#include "codegen/interface.h"
#include "codegen/print_cpp.h"

namespace tightrope::codegen {

/// A predicate and what `exact_program` made of it.
struct ExactPredicate {
  const dsl::Predicate* predicate = nullptr;
  const ExactProgram* program = nullptr;
};

/// The whole header, FILE.exact.REAL.h.
std::string print_exact_header(std::span<const ExactPredicate> predicates, const HeaderOptions& options);

/// Declaration of the predicate's template and its specialisation for bound::exact.
std::string print_exact_predicate(const ExactPredicate& exact, Precision precision);

/// "operations for signs 23 (14 sums, 9 products); integers of up to 3 words, 6 where ..": what a header says at its
/// top of the exact arithmetic of a stage.
std::string exact_cost(const ExactPredicate& exact, std::size_t stage);

/// The first lines of a header, up to what it says of its predicates.
std::string exact_head(const HeaderOptions& options);

}  // namespace tightrope::codegen
