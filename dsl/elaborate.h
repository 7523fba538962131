#pragma once
/// Checked and lowered: from syntax trees to the program that `codegen` takes.

#include <span>

#include "dsl/ast.h"
#include "dsl/declarations.h"
#include "dsl/program.h"

namespace tightrope::dsl {

/// Elaborates all predicates and instances of the first module, which is the main file; the others are its imports.
/// `incomplete` says that some file had syntax errors, which are then not reported once more as unknown names.
Program elaborate(const SourceMap& sources, std::span<const Module> modules, bool incomplete, Diagnostics& diagnostics,
                  const ElaborateOptions& options);

}  // namespace tightrope::dsl
