#pragma once
/// Expressions, by operator precedence [Pratt 1973]: `at`, then `+ -`, then `* /`, then unary minus, then `^`.

#include <vector>

#include "dsl/ast.h"
#include "dsl/token_cursor.h"

namespace tightrope::dsl {

/// Appends the nodes of the expression at `cursor` to `exprs`. Empty, with an error reported and nothing appended, if
/// there is no well-formed one; the cursor then stands where the error was found.
ExprRange parse_expression(TokenCursor& cursor, std::vector<Expr>& exprs);

}  // namespace tightrope::dsl
