#pragma once
/// Names that end up in C++.

#include <string>
#include <string_view>

namespace tightrope::dsl {

/// Why `name` cannot be an identifier of generated C++ ("is a keyword of C++", ...), or empty.
std::string_view cpp_objection(std::string_view name);
/// Whether generated code or the runtime uses this name where predicates and stages stand.
bool is_generated_name(std::string_view name);

/// Source text on one line: white space and comments become single blanks.
std::string fold_white_space(std::string_view text);
/// The identifier that an output without `as` gets from its expression: "diff(Y)" -> "diff_Y", "3 * Y" -> "n3_Y".
std::string output_name(std::string_view folded_text);

}  // namespace tightrope::dsl
