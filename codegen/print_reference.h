#pragma once
/// The exact meaning of a predicate as tables for the generated tests (runtime/tightrope/testing/reference.h).

#include <string>

#include "dsl/program.h"

namespace tightrope::codegen {

/// Definitions of NAME_operations, NAME_results, NAME_parameters, NAME_outputs, NAME_properties and, of all of them,
/// NAME_reference. `same_values`: generated code computes these very operations. `budget`: operations that one
/// test may evaluate exactly, all its cases together.
std::string print_reference(const dsl::Predicate& predicate, bool same_values, int budget);

/// "antisymmetric(a, b)"
std::string property_text(const dsl::Predicate& predicate, const dsl::Property& property);

}  // namespace tightrope::codegen
