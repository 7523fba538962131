#pragma once
/// Text to syntax tree.

#include "dsl/ast.h"
#include "dsl/diagnostic.h"

namespace tightrope::dsl {

/// Parses file `file` of `sources`. Every syntax error of the file is reported (the parser resumes at the next
/// statement or declaration); the module holds what could be parsed.
Module parse(const SourceMap& sources, std::uint32_t file, Diagnostics& diagnostics);

}  // namespace tightrope::dsl
