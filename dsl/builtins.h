#pragma once
/// The functions of the language.

#include <span>
#include <string_view>
#include <vector>

#include "dsl/value.h"

namespace tightrope::dsl {

class ExpressionElaborator;
struct Expr;

struct Builtin {
  std::string_view name;
  int min_arguments = 1;
  int max_arguments = 1;  ///< -1: any number
  /// Arguments are not poisoned and of the right number; `call` is for places of diagnostics.
  Value (*apply)(ExpressionElaborator& elaborator, const Expr& call, std::span<const Value> arguments) = nullptr;
};

/// Null if there is none.
const Builtin* find_builtin(std::string_view name);
std::span<const Builtin> builtins();

}  // namespace tightrope::dsl
