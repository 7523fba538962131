#pragma once
/// Translation validation of one predicate's functions (validate.h says what is proved).

#include <clang/AST/DeclCXX.h>

#include <string>
#include <vector>

#include "codegen/clang/expression.h"
#include "codegen/clang/validate.h"

namespace tightrope::codegen {

/// What every check of one predicate's code needs.
struct Subject {
  const clang::ASTContext& context;
  const dsl::Predicate& predicate;
  const BoundedPredicate& bounded;
  Precision precision;
  clang::QualType real;
  std::vector<InputArgument> arguments;                   ///< of every function, in order
  std::vector<const clang::CXXRecordDecl*> results = {};  ///< by stage
  const clang::CXXRecordDecl* state = nullptr;            ///< null if there is one stage only

  std::string text(const clang::Stmt* statement) const { return source_text(statement, context); }
  bool several_stages() const { return predicate.stages.size() > 1; }
  bool has_range() const;
};

/// The arguments as docs/generated-code.md orders them: one a parameter, two for a moving one; elements outermost, then
/// components.
std::vector<InputArgument> input_arguments(const dsl::Predicate& predicate);

/// The statements of a function's body.
std::vector<const clang::Stmt*> body(const clang::FunctionDecl* function);

/// Makes the function's arguments known to `reader` by position.
void bind_arguments(const Subject& subject, const clang::FunctionDecl* function, ExpressionReader& reader);

/// The field behind `result.name[i][j]`, and the row-major number of the element; null if it is something else.
struct ElementPlace {
  const clang::FieldDecl* field = nullptr;
  std::vector<int> subscripts;
};
ElementPlace element_place(const clang::Expr* expression, const clang::ValueDecl* result);

/// Whether `statement` declares `Record name;` without initialiser; returns the variable.
const clang::VarDecl* declared_result(const clang::Stmt* statement, const clang::CXXRecordDecl* record);
/// Whether `statement` is `return variable;`.
bool returns(const clang::Stmt* statement, const clang::ValueDecl* variable);
/// Whether `expression` passes on the variable unchanged: itself, or a plain copy of it.
bool passes(const clang::Expr* expression, const clang::ValueDecl* variable);

/// The straight-line function of a stage. `saved` is what State holds, before and after.
void validate_stage(const Subject& subject, CanonicalGraph& graph, std::size_t stage,
                    const clang::FunctionDecl* function, std::map<const clang::ValueDecl*, dsl::NodeId>& saved);

/// `in_range`, and the function of a stage that consults it.
void validate_in_range(const Subject& subject, const clang::FunctionDecl* function);
void validate_checked_stage(const Subject& subject, std::size_t stage, const clang::FunctionDecl* checked,
                            const clang::FunctionDecl* in_range, const clang::FunctionDecl* unchecked);

}  // namespace tightrope::codegen
