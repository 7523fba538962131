#pragma once
/// The statements of predicates and functions, and the lists of names they hold.

#include <string>
#include <utility>
#include <vector>

#include "dsl/ast.h"
#include "dsl/token_cursor.h"

namespace tightrope::dsl {

using NameList = std::vector<std::pair<std::string, SourceSpan>>;

/// Names separated by commas, appended to `names`; false after an error.
bool parse_names(TokenCursor& cursor, std::string_view what, NameList& names);

/// Where statements stand and what they are added to. One of `predicate` and `function` is null.
struct BlockContext {
  PredicateDecl* predicate = nullptr;
  FunctionDecl* function = nullptr;
  bool in_stage = false;
  bool in_loop = false;
  bool top_level() const { return !in_stage && !in_loop; }
};

/// The statements up to the block's `}`, which is not taken, appended to `body`. Errors are reported, and parsing goes
/// on at the next statement.
void parse_statements(TokenCursor& cursor, std::vector<Expr>& exprs, const BlockContext& context,
                      std::vector<Statement>& body);

/// `{` statements `}`.
void parse_block(TokenCursor& cursor, std::vector<Expr>& exprs, const BlockContext& context,
                 std::vector<Statement>& body);

}  // namespace tightrope::dsl
