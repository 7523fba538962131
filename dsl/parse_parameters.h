#pragma once
/// The parameter lists of predicates and functions.

#include <vector>

#include "dsl/ast.h"
#include "dsl/token_cursor.h"

namespace tightrope::dsl {

/// `(` parameters `)`, extents into `exprs`. False after an error that leaves the cursor inside the list; errors within
/// one parameter are reported and the next one is taken. With `typed` every parameter must have a type.
bool parse_parameters(TokenCursor& cursor, std::vector<Expr>& exprs, bool typed,
                      std::vector<ParameterDecl>& parameters);

}  // namespace tightrope::dsl
