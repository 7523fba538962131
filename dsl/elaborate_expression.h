#pragma once
/// Expressions and the statements that bind names: types are checked and nodes made in one walk. Functions are inlined
/// and loops unrolled, so every value's shape and degree is known where it is made.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "dsl/declarations.h"
#include "dsl/program.h"
#include "dsl/residues.h"
#include "dsl/value.h"

namespace tightrope::dsl {

/// The names of one predicate or function call. Blocks end in reverse order; of equal names the latest counts.
class Scope {
 public:
  void bind(std::string_view name, Value value);
  const Value* find(std::string_view name) const;
  /// For `leave`: everything bound since `mark` was taken goes.
  std::size_t mark() const { return names_.size(); }
  void leave(std::size_t mark);

 private:
  std::unordered_map<std::string_view, std::vector<Value>> values_;
  std::vector<std::string_view> names_;  ///< in the order bound
};

/// The comprehension bodies of every module of a program.
using BodyTable = std::unordered_map<const Module*, ComprehensionBodies>;

class ExpressionElaborator {
 public:
  ExpressionElaborator(const Declarations& declarations, const BodyTable& bodies, const ElaborateOptions& options,
                       Reporter& reporter);

  Value evaluate(const Module& module, ExprRange range, Scope& scope);
  /// The values of `for name in first .. last`, or empty after an error.
  std::optional<std::pair<std::int64_t, std::int64_t>> loop_bounds(const Value& first, SourceSpan first_span,
                                                                   const Value& last, SourceSpan last_span);
  /// A whole number known at compile time, or empty after an error that says what `what` must be.
  std::optional<std::int64_t> whole_number(const Value& value, SourceSpan span, std::string_view what);

  void error(SourceSpan span, std::string message, std::string hint = {}) {
    reporter_.error(span, std::move(message), std::move(hint));
  }
  /// `value`, or poison and a diagnostic if what was just added to the graph went wrong or made it too large.
  Value checked(Value value, SourceSpan span);
  /// False, with a diagnostic, if a polynomial may not have this degree.
  bool degree_allowed(int degree, SourceSpan span);
  /// Counts the work of unrolling; false once it is too much, after one diagnostic.
  bool charge(std::size_t work, SourceSpan span);
  bool aborted() const { return aborted_; }

  /// One level of functions, comprehensions and loops in one another, while it lives; false if too deep.
  class Level {
   public:
    explicit Level(ExpressionElaborator& elaborator) : elaborator_(elaborator) { ++elaborator_.depth_; }
    ~Level() { --elaborator_.depth_; }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;
    bool allowed(SourceSpan span);

   private:
    ExpressionElaborator& elaborator_;
  };

  /// Where operand `i` of the expression that is being elaborated stands.
  SourceSpan operand_span(const Expr& expr, std::size_t i) const {
    return module_->exprs[static_cast<std::size_t>(expr.operands[i])].span;
  }

  /// Where the literal among the operands stands, or the expression itself.
  SourceSpan literal_span(const Expr& expr) const;

  Lowering& lowering() { return low_; }
  Comparison compare(const Coefficient& a, const Coefficient& b) { return residues_.compare(low_.graph, a, b); }
  const ElaborateOptions& options() const { return options_; }
  Reporter& reporter() { return reporter_; }

 private:
  Value evaluate_nodes(ExprRange range, Scope& scope);
  Value apply(const Expr& expr, std::span<const Value> operands, Scope& scope);
  Value apply_literal(const Expr& expr);
  Value apply_name(const Expr& expr, const Scope& scope);
  Value apply_sum(const Expr& expr, const Value& a, const Value& b);
  Value apply_product(const Expr& expr, const Value& a, const Value& b);
  Value apply_quotient(const Expr& expr, const Value& a, const Value& b);
  Value apply_power(const Expr& expr, const Value& a, const Value& b);
  Value apply_index(const Expr& expr, const Value& a, const Value& b);
  Value apply_component(const Expr& expr, const Value& a);
  Value apply_array(const Expr& expr, std::span<const Value> operands);
  Value apply_comprehension(const Expr& expr, std::span<const Value> bounds, Scope& scope);
  Value apply_call(const Expr& expr, std::span<const Value> arguments);
  bool bind_arguments(const FunctionEntry& function, const Expr& call, std::span<const Value> arguments, Scope& scope);
  bool fits_parameter(const FunctionEntry& function, const ParameterDecl& parameter, const Expr& call,
                      std::size_t position, const Value& argument);
  void run_lets(const Module& module, const std::vector<Statement>& statements, Scope& scope);

  const Declarations& declarations_;
  const BodyTable& bodies_;
  const ElaborateOptions& options_;
  Reporter& reporter_;
  Lowering low_;
  Residues residues_;               ///< of `low_.graph`, as far as they were needed
  const Module* module_ = nullptr;  ///< that of the expression that is being elaborated
  std::size_t work_ = 0;
  int depth_ = 0;
  bool aborted_ = false;
};

/// What `P at s`, `P at r/s`, `split(P, s)` and `split(P, r/s)` are worth; `where` is r, `whole` is s or null.
Value evaluate_at(ExpressionElaborator& elaborator, const Expr& expr, const Value& p, const Value& where,
                  const Value* whole);
Value split_at(ExpressionElaborator& elaborator, const Expr& expr, const Value& p, const Value& where,
               const Value* whole);

}  // namespace tightrope::dsl
