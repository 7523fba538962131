#pragma once
/// What the files of a program declare, and the checks on names that need no types.

#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "dsl/ast.h"
#include "dsl/reporter.h"

namespace tightrope::dsl {

struct FunctionEntry {
  const Module* module = nullptr;
  const FunctionDecl* declaration = nullptr;
  bool recursive = false;  ///< calls itself, directly or not (reported; calls of it are poison)
};

/// A predicate or an instance: one of the two pointers is set.
struct PredicateEntry {
  const Module* module = nullptr;
  const PredicateDecl* predicate = nullptr;
  const InstanceDecl* instance = nullptr;
};

struct Declarations {
  std::unordered_map<std::string_view, FunctionEntry> functions;
  std::unordered_map<std::string_view, PredicateEntry> predicates;
  /// Some file has syntax errors, so declarations may be missing: unknown names are not reported.
  bool incomplete = false;
};

/// Collects the declarations of all modules (the main file first, then imports) and checks, in functions and predicates
/// whether used or not: names declared twice, unknown names and functions, numbers of arguments, recursion.
Declarations collect_declarations(std::span<const Module> modules, bool incomplete, Reporter& reporter);

/// The ranges of `module.exprs` that are bodies of comprehensions, for walkers to skip: `end(begin, before)` is the end
/// of the outermost body that starts at `begin` and ends before `before`, or `no_expr`.
class ComprehensionBodies {
 public:
  explicit ComprehensionBodies(const Module& module);
  ExprId end(ExprId begin, ExprId before) const;

 private:
  std::unordered_map<ExprId, std::vector<ExprId>> ends_;  ///< of the bodies that start there, outermost first
};

}  // namespace tightrope::dsl
