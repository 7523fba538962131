#pragma once
/// `tightrope import`: a C++ function as a predicate's text.

#include <stdexcept>
#include <string>

#include "codegen/clang/import_function.h"

namespace tightrope::codegen {

/// Thrown at a function whose predicate goes beyond the language's limits; holds the language's diagnostics.
struct InexpressibleFunction : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The text of a .pred file with one predicate that computes what the C++ function does, rounding for rounding.
///
/// Operations keep their order and association; a C++ variable's name becomes the `let` of the first number it held.
/// Constants are written exactly. The language gathers the constant factors of products (3 * x * y is 3 (x y)), so
/// `rounded(3 * x)` stands where the C++ code rounds in between, and only there.
///
/// The text is compiled again before it is returned: its graph and the imported one are the same after `simplify`.
/// Throws a TranslationError if they are not, an InexpressibleFunction if it does not compile. `source_name` is for the
/// comment at its top.
std::string import_text(const ImportedFunction& function, const std::string& source_name);

/// Whether the predicate of this text computes the imported graph, output by output. On "no" because it does not even
/// compile, `errors` says why.
bool computes(const std::string& text, const ImportedFunction& function, std::string& errors);

}  // namespace tightrope::codegen
