#pragma once
/// Follows a C++ function whose control flow is known at compile time, and notes the arithmetic that it does.

#include <clang/AST/DeclCXX.h>
#include <clang/AST/ExprCXX.h>
#include <clang/AST/StmtCXX.h>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "codegen/bounds.h"
#include "codegen/clang/memory.h"

namespace tightrope::codegen {

/// `e` without what stands for nothing: parentheses, temporaries, defaults, template arguments.
const clang::Expr* plain(const clang::Expr* e);

inline bool is_real(const clang::Expr* e) { return e->getType()->isRealFloatingType(); }

/// Holds every result of one operation on 64-bit integers.
__extension__ using WideInteger = __int128;

inline constexpr const char* branch_on_data =
    "a branch on a computed number: a predicate is straight-line (return the number whose sign decides)";

/// Evaluates the way C++ does, with numbers in place of values: every floating-point operation becomes a node, rounded
/// as the code rounds it; whole numbers, conditions, pointers and calls are carried out. Throws an ImportError at the
/// first thing that this is impossible for.
class Interpreter {
 public:
  explicit Interpreter(const clang::ASTContext& context) : context_(context) {}

  /// Runs the function on its parameters' objects; the cells of the result.
  std::vector<Value> run(const clang::FunctionDecl* function, const std::vector<Place>& arguments);

  /// A new object for a variable of this type.
  Place allocate(clang::QualType type, std::string name, clang::SourceLocation where);
  Object& object(Place place) { return objects_[static_cast<std::size_t>(place.object)]; }
  const std::vector<Object>& objects() const { return objects_; }

  dsl::Graph& graph() { return graph_; }
  /// By provisional input slot: which cell of which parameter.
  const std::vector<std::pair<int, std::int64_t>>& inputs() const { return inputs_; }
  /// What the C++ code calls a node, and its operands in the order in which it has them.
  const std::map<dsl::NodeId, std::string>& names() const { return names_; }
  const std::map<dsl::NodeId, std::pair<dsl::NodeId, dsl::NodeId>>& written_order() const { return written_order_; }
  const std::map<dsl::NodeId, clang::SourceLocation>& places() const { return places_; }

  /// The one floating-point type of the function; an error for a second one.
  Precision precision() const {
    return real_ && *real_ == clang::BuiltinType::Float ? Precision::binary32 : Precision::binary64;
  }
  void use_real(clang::QualType type, clang::SourceLocation where);

 private:
  enum class Flow { next, leave_loop, next_turn, leave_function };
  struct Frame {
    std::map<const clang::ValueDecl*, Place> variables;
    Place self;
    bool has_self = false;
    std::vector<Value> result;
    const clang::FunctionDecl* function = nullptr;
  };

  // interpreter.cpp: statements, calls
  Flow execute(const clang::Stmt* statement);
  Flow execute_loop(const clang::Stmt* statement, const clang::Stmt* condition_variable, const clang::Expr* condition,
                    const clang::Expr* step, const clang::Stmt* body, bool test_first);
  void declare(const clang::VarDecl* variable);
  void execute_return(const clang::ReturnStmt* statement);
  std::vector<Value> call(const clang::FunctionDecl* function, Frame frame, clang::SourceLocation where);
  std::vector<Value> call_expression(const clang::CallExpr* call);
  bool builtin_call(const clang::CallExpr* call, Value& result);
  Frame bind(const clang::FunctionDecl* function, const std::vector<const clang::Expr*>& arguments,
             clang::SourceLocation where);
  void initialise(Place place, clang::QualType type, const clang::Expr* init);
  void construct(Place place, const clang::CXXConstructExpr* expression);
  void count_step(clang::SourceLocation where);

  // interpreter_expression.cpp: places, loads and stores; interpreter_operator.cpp: conversions and operators
  Value evaluate(const clang::Expr* expression);
  Place evaluate_place(const clang::Expr* expression);
  Place global_constant(const clang::VarDecl* variable, clang::SourceLocation where);
  Value evaluate_cast(const clang::CastExpr* cast);
  Value evaluate_unary(const clang::UnaryOperator* unary);
  Value evaluate_binary(const clang::BinaryOperator* binary);
  std::pair<Place, Value> increment(const clang::UnaryOperator* unary);
  std::pair<Place, Value> assign(const clang::BinaryOperator* binary);
  Value evaluate_conditional(const clang::ConditionalOperator* conditional);
  Value apply(clang::BinaryOperatorKind operation, const Value& a, const Value& b, clang::QualType operand_type,
              clang::QualType result_type, clang::SourceLocation where);
  Value apply_to_integers(clang::BinaryOperatorKind operation, std::int64_t x, std::int64_t y,
                          clang::QualType result_type, clang::SourceLocation where);
  Value whole(WideInteger result, clang::QualType type, clang::SourceLocation where) const;
  Value whole(const llvm::APSInt& value, clang::SourceLocation where) const;
  static Place moved(Place place, std::int64_t elements, std::int64_t size, clang::SourceLocation where);
  bool condition(const clang::Expr* expression);
  std::int64_t integer(const clang::Expr* expression);
  dsl::NodeId number(const clang::Expr* expression);
  dsl::NodeId number_in(const clang::Expr* expression);
  Value load(Place place, clang::QualType type, clang::SourceLocation where);
  void store(Place place, const Value& value, clang::SourceLocation where);
  Value& cell(Place place, clang::SourceLocation where);
  void copy(Place from, Place to, std::int64_t count, clang::SourceLocation where);
  void name(Place place, const Value& value);

  // interpreter_integer.cpp: whole, moved, apply_to_integers; interpreter_number.cpp: the arithmetic, constants folded
  // as C++ rounds them
  dsl::NodeId constant(double value, clang::SourceLocation where);
  dsl::NodeId binary(dsl::Op op, dsl::NodeId a, dsl::NodeId b, clang::SourceLocation where);
  dsl::NodeId unary(dsl::Op op, dsl::NodeId a, clang::SourceLocation where);
  dsl::NodeId noted(dsl::NodeId node, dsl::NodeId a, dsl::NodeId b, clang::SourceLocation where);
  const double* constant_value(dsl::NodeId node) const;
  double rounded(double value) const;

  const clang::ASTContext& context_;
  dsl::Graph graph_;
  std::vector<Object> objects_;
  std::vector<Frame> frames_;
  std::map<const clang::VarDecl*, Place> globals_;
  std::vector<std::pair<int, std::int64_t>> inputs_;
  std::map<dsl::NodeId, std::string> names_;
  std::map<dsl::NodeId, std::pair<dsl::NodeId, dsl::NodeId>> written_order_;
  std::map<dsl::NodeId, clang::SourceLocation> places_;
  std::optional<clang::BuiltinType::Kind> real_;
  int steps_ = 0;
};

}  // namespace tightrope::codegen
