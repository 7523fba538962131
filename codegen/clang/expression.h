#pragma once
/// Expressions of generated C++ as the compiler sees them, back to graph nodes.

#include <clang/AST/ASTContext.h>
#include <clang/AST/Expr.h>
#include <clang/AST/ExprCXX.h>

#include <map>
#include <string>
#include <vector>

#include "codegen/clang/canonical_graph.h"

namespace tightrope::codegen {

/// Thrown where the code is not what was analysed.
struct Mismatch {
  clang::SourceLocation where;
  std::string what;
};

/// One argument of a stage's function: which input slots it holds.
struct InputArgument {
  bool bounded = false;
  bool pointer = false;
  std::vector<int> slots;
};

/// `expression` without what changes neither value nor type: parentheses, lvalue-to-rvalue, added const, decay of
/// arrays and functions, temporaries. A conversion between numbers stays.
const clang::Expr* bare(const clang::Expr* expression);

/// Whether `expression` names this variable.
bool names(const clang::Expr* expression, const clang::ValueDecl* declaration);

/// Whether `declaration` stands in one of the runtime's headers.
bool in_runtime(const clang::Decl* declaration, const clang::SourceManager& sources);

/// The source text of a statement, on one line.
std::string source_text(const clang::Stmt* statement, const clang::ASTContext& context);

/// A compile-time subscript.
int subscript(const clang::Expr* expression);

/// Reads expressions of one function. Every number in them must be of type `real` (no conversion, no wider type), every
/// operator and every callee one of those that the graph has: anything else is a Mismatch.
class ExpressionReader {
 public:
  ExpressionReader(const clang::ASTContext& context, CanonicalGraph& graph, clang::QualType real, int slots)
      : context_(context), graph_(graph), real_(real), slots_(slots) {}

  dsl::NodeId read(const clang::Expr* expression);

  /// What the function's names stand for.
  std::map<const clang::ValueDecl*, dsl::NodeId> locals;
  std::map<const clang::ValueDecl*, InputArgument> inputs;
  std::map<const clang::ValueDecl*, dsl::NodeId> saved;  ///< by member of State
  const clang::ValueDecl* state = nullptr;

 private:
  dsl::NodeId read_call(const clang::CallExpr* call);
  dsl::NodeId read_member(const clang::MemberExpr* member);
  dsl::NodeId input(const clang::Expr* place, bool bound, const clang::Expr* whole);
  dsl::Op operation(const clang::CallExpr* call) const;

  const clang::ASTContext& context_;
  CanonicalGraph& graph_;
  clang::QualType real_;
  int slots_;
};

}  // namespace tightrope::codegen
