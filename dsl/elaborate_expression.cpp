#include "dsl/elaborate_expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "dsl/builtins.h"

namespace tightrope::dsl {

namespace {

constexpr int max_depth = 400;                      // of calls, loops and comprehensions in one another
constexpr std::int64_t max_iterations = 1'000'000;  // of one loop
constexpr std::size_t max_work = 1'500'000;         // expressions evaluated and coefficients made, in one predicate

}  // namespace

void Scope::bind(std::string_view name, Value value) {
  values_[name].push_back(std::move(value));
  names_.push_back(name);
}

const Value* Scope::find(std::string_view name) const {
  const auto found = values_.find(name);
  return found == values_.end() || found->second.empty() ? nullptr : &found->second.back();
}

void Scope::leave(std::size_t mark) {
  for (; names_.size() > mark; names_.pop_back()) values_.find(names_.back())->second.pop_back();
}

ExpressionElaborator::ExpressionElaborator(const Declarations& declarations, const BodyTable& bodies,
                                           const ElaborateOptions& options, Reporter& reporter)
    : declarations_(declarations), bodies_(bodies), options_(options), reporter_(reporter) {
  low_.products = options.products;
  low_.evaluation = options.evaluation;
}

bool ExpressionElaborator::Level::allowed(SourceSpan span) {
  if (elaborator_.depth_ <= max_depth) return true;
  elaborator_.error(span, fmt::format("functions and loops are nested more than {} levels deep here", max_depth));
  elaborator_.aborted_ = true;
  return false;
}

bool ExpressionElaborator::charge(std::size_t work, SourceSpan span) {
  if (aborted_) return false;
  work_ += work;
  if (work_ <= max_work) return true;
  error(span, "the predicate is too large: elaborating it takes too many steps",
        "loops and calls are unrolled at compile time");
  aborted_ = true;
  return false;
}

bool ExpressionElaborator::degree_allowed(int degree, SourceSpan span) {
  if (degree <= options_.max_degree) return true;
  error(span, fmt::format("this polynomial has degree {}; at most {} is allowed", degree, options_.max_degree));
  return false;
}

Value ExpressionElaborator::checked(Value value, SourceSpan span) {
  if (low_.overflow) {
    error(span, "a number known at compile time leaves the range of exact arithmetic",
          "its numerator and denominator may have 126 bits besides powers of two");
  } else if (low_.unrepresentable) {
    const Rational& number = low_.unrepresentable->factor;
    const std::string text = number.to_string();
    if (low_.unrepresentable->literal && number.odd_denominator() != 1) {
      error(span, fmt::format("a literal here is not representable in floating point: its value is exactly {}", text),
            fmt::format("write `{}`, a quotient whose rounding the bounds account for", text));
    } else {
      error(span,
            fmt::format("the number {} would have to be a floating-point constant and is not representable", text),
            "numerator and denominator of a constant may have 53 bits besides powers of two");
    }
  } else if (static_cast<std::size_t>(low_.graph.size()) > options_.max_nodes) {
    error(span, fmt::format("the predicate's graph grows beyond {} nodes here", options_.max_nodes));
    aborted_ = true;
    return {};
  } else {
    return value;
  }
  low_.overflow = false;
  low_.unrepresentable.reset();
  return {};
}

std::optional<std::int64_t> ExpressionElaborator::whole_number(const Value& value, SourceSpan span,
                                                               std::string_view what) {
  if (value.poisoned()) return std::nullopt;
  const auto number = as_number(value);
  const auto whole = number ? number->to_integer() : std::nullopt;
  if (!whole) {
    error(span, fmt::format("{} must be a whole number known at compile time, not {}", what,
                            number ? number->to_string() : describe(value)));
  }
  return whole;
}

std::optional<std::pair<std::int64_t, std::int64_t>> ExpressionElaborator::loop_bounds(const Value& first,
                                                                                       SourceSpan first_span,
                                                                                       const Value& last,
                                                                                       SourceSpan last_span) {
  const auto begin = whole_number(first, first_span, "a loop's bound");
  const auto end = whole_number(last, last_span, "a loop's bound");
  if (!begin || !end) return std::nullopt;
  constexpr std::int64_t limit = std::int64_t{1} << 53;
  if (*begin < -limit || *end > limit || *end - *begin > max_iterations) {
    error(last_span, fmt::format("a loop may have at most {} iterations", max_iterations),
          "loops and calls are unrolled at compile time");
    return std::nullopt;
  }
  return std::pair(*begin, std::max(*begin, *end));
}

Value ExpressionElaborator::evaluate(const Module& module, ExprRange range, Scope& scope) {
  if (range.empty()) return {};
  const Module* const outer = std::exchange(module_, &module);
  Value result = evaluate_nodes(range, scope);
  module_ = outer;
  return result;
}

Value ExpressionElaborator::evaluate_nodes(ExprRange range, Scope& scope) {
  const ComprehensionBodies& bodies = bodies_.at(module_);
  std::vector<Value> values(static_cast<std::size_t>(range.end - range.begin));
  std::vector<Value> operands;
  for (ExprId id = range.begin; id < range.end && !aborted_;) {
    if (const ExprId end = bodies.end(id, range.end); end != no_expr) {
      id = end;
      continue;
    }
    const Expr& expr = module_->exprs[static_cast<std::size_t>(id)];
    operands.clear();
    bool poisoned = false;
    for (const ExprId operand : expr.operands) {  // each node has one user, so its value can move there
      operands.push_back(std::move(values[static_cast<std::size_t>(operand - range.begin)]));
      poisoned |= operands.back().poisoned();
    }
    Value& value = values[static_cast<std::size_t>(id - range.begin)];
    if (!poisoned) value = apply(expr, operands, scope);
    if (!value.poisoned()) {
      value = checked(std::move(value), low_.unrepresentable ? literal_span(expr) : expr.span);
    }
    if (!charge(1 + value.coefficient_count() / 4, expr.span)) return {};
    ++id;
  }
  return aborted_ ? Value{} : std::move(values.back());
}

Value ExpressionElaborator::apply(const Expr& expr, std::span<const Value> operands, Scope& scope) {
  switch (expr.kind) {
    case ExprKind::number:
      return apply_literal(expr);
    case ExprKind::name:
      return apply_name(expr, scope);
    case ExprKind::negate:
      return map_elements(operands[0], [](const Polynomial& p) { return negate(p); });
    case ExprKind::add:
    case ExprKind::subtract:
      return apply_sum(expr, operands[0], operands[1]);
    case ExprKind::multiply:
      return apply_product(expr, operands[0], operands[1]);
    case ExprKind::divide:
      return apply_quotient(expr, operands[0], operands[1]);
    case ExprKind::power:
      return apply_power(expr, operands[0], operands[1]);
    case ExprKind::call:
      return apply_call(expr, operands);
    case ExprKind::index:
      return apply_index(expr, operands[0], operands[1]);
    case ExprKind::component:
      return apply_component(expr, operands[0]);
    case ExprKind::at:
      return evaluate_at(*this, expr, operands[0], operands[1], nullptr);
    case ExprKind::at_ratio:
      return evaluate_at(*this, expr, operands[0], operands[1], &operands[2]);
    case ExprKind::split_ratio:
      return split_at(*this, expr, operands[0], operands[1], &operands[2]);
    case ExprKind::array:
      return apply_array(expr, operands);
    case ExprKind::comprehension:
      return apply_comprehension(expr, operands, scope);
  }
  return {};
}

SourceSpan ExpressionElaborator::literal_span(const Expr& expr) const {
  for (const ExprId operand : expr.operands) {
    const Expr* e = &module_->exprs[static_cast<std::size_t>(operand)];
    while (e->kind == ExprKind::negate) e = &module_->exprs[static_cast<std::size_t>(e->operands[0])];
    if (e->kind == ExprKind::number && !Rational::parse(e->text).value_or(0).to_double()) return e->span;
  }
  return expr.span;
}

Value ExpressionElaborator::apply_literal(const Expr& expr) {
  const auto value = Rational::parse(expr.text);
  Coefficient c = number(value.value_or(Rational::invalid()));
  if (!c.factor.valid()) {
    low_.overflow = true;
    c.factor = 0;
  }
  c.literal = !c.factor.to_double();
  return scalar(c);
}

Value ExpressionElaborator::apply_name(const Expr& expr, const Scope& scope) {
  const Value* value = scope.find(expr.text);
  return value == nullptr ? Value{} : *value;  // unknown names have been reported by collect_declarations
}

Value ExpressionElaborator::apply_array(const Expr& expr, std::span<const Value> operands) {
  const Value& first = operands.front();
  for (const Value& v : operands) {
    if (v.extents == first.extents && v.dimension() == first.dimension()) continue;
    error(expr.span, fmt::format("an array cannot hold both {} and {}", describe(first), describe(v)));
    return {};
  }
  std::vector<Value> values(operands.begin(), operands.end());
  elevate_to_common_degree(low_, values);
  return make_array(std::move(values));
}

Value ExpressionElaborator::apply_comprehension(const Expr& expr, std::span<const Value> bounds, Scope& scope) {
  Level level(*this);
  if (!level.allowed(expr.span)) return {};
  const auto range = loop_bounds(bounds[0], operand_span(expr, 0), bounds[1], operand_span(expr, 1));
  if (!range) return {};
  if (range->first == range->second) {
    error(expr.span, fmt::format("this array is empty: no number from {} on is below {}", range->first, range->second));
    return {};
  }
  std::vector<Value> values;
  bool poisoned = false;
  for (std::int64_t i = range->first; i < range->second; ++i) {
    const std::size_t mark = scope.mark();
    scope.bind(expr.text, scalar(number(i)));
    values.push_back(evaluate_nodes({expr.body_begin, expr.body_end}, scope));
    scope.leave(mark);
    if (aborted_) return {};
    poisoned |= values.back().poisoned();
  }
  return poisoned ? Value{} : apply_array(expr, values);
}

Value ExpressionElaborator::apply_call(const Expr& expr, std::span<const Value> arguments) {
  const int given = static_cast<int>(arguments.size());
  if (const Builtin* builtin = find_builtin(expr.text)) {
    if (given < builtin->min_arguments || (builtin->max_arguments >= 0 && given > builtin->max_arguments)) return {};
    return builtin->apply(*this, expr, arguments);
  }
  const auto found = declarations_.functions.find(expr.text);
  if (found == declarations_.functions.end() || found->second.recursive) return {};
  const FunctionEntry& function = found->second;
  if (arguments.size() != function.declaration->parameters.size()) return {};
  Level level(*this);
  if (!level.allowed(expr.span)) return {};
  Scope scope;
  if (!bind_arguments(function, expr, arguments, scope)) return {};
  const Reporter::Context context(reporter_, "", expr.text, " is called", expr.span);
  run_lets(*function.module, function.declaration->body, scope);
  return evaluate(*function.module, function.declaration->result, scope);
}

bool ExpressionElaborator::bind_arguments(const FunctionEntry& function, const Expr& call,
                                          std::span<const Value> arguments, Scope& scope) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const ParameterDecl& parameter = function.declaration->parameters[i];
    if (!fits_parameter(function, parameter, call, i, arguments[i])) return false;
    scope.bind(parameter.name, arguments[i]);
  }
  return true;
}

bool ExpressionElaborator::fits_parameter(const FunctionEntry& function, const ParameterDecl& parameter,
                                          const Expr& call, std::size_t position, const Value& argument) {
  std::string wanted;
  bool fits = true;
  std::vector<int> extents;
  for (const ExprRange& range : parameter.array) {
    Scope none;
    const SourceSpan span =
        range.empty() ? parameter.span : function.module->exprs[static_cast<std::size_t>(range.root())].span;
    const auto extent = whole_number(evaluate(*function.module, range, none), span, "an array's extent");
    if (!extent) return false;
    extents.push_back(static_cast<int>(std::clamp<std::int64_t>(*extent, 0, max_iterations)));
    wanted += fmt::format("[{}]", *extent);
  }
  if (!extents.empty()) wanted = fmt::format("an array {}", wanted);
  if (!extents.empty() || parameter.kind != ParameterDecl::Kind::unspecified) fits = argument.extents == extents;
  if (parameter.kind != ParameterDecl::Kind::unspecified) {
    const bool plane = parameter.kind == ParameterDecl::Kind::vec2 || parameter.kind == ParameterDecl::Kind::point2;
    const int dimension = parameter.kind == ParameterDecl::Kind::scalar ? 1 : plane ? 2 : 3;
    const char* const names[] = {"scalar", "2D vector", "vector"};
    wanted = extents.empty() ? fmt::format("a {}", names[dimension - 1])
                             : fmt::format("{} of {}s", wanted, names[dimension - 1]);
    fits = fits && argument.dimension() == dimension;
  }
  if (wanted.empty()) wanted = "a value";
  if (parameter.motion != ParameterDecl::Motion::unspecified) {
    const int degree = parameter.motion == ParameterDecl::Motion::fixed ? 0 : 1;
    wanted += degree == 0 ? " of degree 0" : " of degree 1 or 0";
    fits = fits && argument.degree() <= degree;
  }
  if (!fits) {
    error(operand_span(call, position),
          fmt::format("`{}` takes {} as `{}`, not {}", call.text, wanted, parameter.name, describe(argument)));
  }
  return fits;
}

void ExpressionElaborator::run_lets(const Module& module, const std::vector<Statement>& statements, Scope& scope) {
  for (const Statement& s : statements) {
    if (aborted_) return;
    if (s.kind == StatementKind::let) scope.bind(s.name, evaluate(module, s.expr, scope));
    if (s.kind != StatementKind::for_loop || s.first.empty() || s.last.empty()) continue;
    Level level(*this);
    if (!level.allowed(s.span)) return;
    const auto span_of = [&](ExprRange r) { return module.exprs[static_cast<std::size_t>(r.root())].span; };
    const Value first = evaluate(module, s.first, scope);
    const Value last = evaluate(module, s.last, scope);
    const auto range = loop_bounds(first, span_of(s.first), last, span_of(s.last));
    for (std::int64_t i = range ? range->first : 0; range && i < range->second && charge(1, s.span); ++i) {
      const std::size_t mark = scope.mark();
      scope.bind(s.name, scalar(number(i)));
      run_lets(module, s.body, scope);
      scope.leave(mark);
    }
  }
}

}  // namespace tightrope::dsl
