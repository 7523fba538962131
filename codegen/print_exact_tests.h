#pragma once
/// The part of FILE.test.cpp that tests modes `exact` and `staged`.

#include <string>

#include "codegen/print_tests.h"

namespace tightrope::codegen {

/// Tests of one predicate in `options.exact_modes`, behind its reference table (print_reference.h).
std::string print_exact_tests(const dsl::Predicate& predicate, const TestOptions& options);

}  // namespace tightrope::codegen
