/// Conversions and operators of an imported function.

#include <fmt/format.h>

#include "codegen/clang/interpreter.h"

namespace tightrope::codegen {

using clang::dyn_cast;
using dsl::NodeId;
using dsl::Op;

namespace {

ImportError other_type(const clang::CastExpr* cast) {
  return {cast->getExprLoc(), fmt::format("a conversion from `{}` to `{}`", cast->getSubExpr()->getType().getAsString(),
                                          cast->getType().getAsString())};
}

}  // namespace

Value Interpreter::evaluate_cast(const clang::CastExpr* cast) {
  const clang::Expr* from = cast->getSubExpr();
  const clang::SourceLocation where = cast->getExprLoc();
  switch (static_cast<int>(cast->getCastKind())) {
    case clang::CK_LValueToRValue:
      if (const auto* conditional = dyn_cast<clang::ConditionalOperator>(plain(from))) {
        return evaluate_conditional(conditional);
      }
      return load(evaluate_place(from), from->getType(), where);
    case clang::CK_NoOp:
    case clang::CK_IntegralCast:
    case clang::CK_BitCast:
      if (cast->getCastKind() == clang::CK_BitCast) throw ImportError{where, "a pointer to another type"};
      if (cast->getCastKind() == clang::CK_IntegralCast) {
        return whole(integer(from), cast->getType(), where);
      }
      return evaluate(from);
    case clang::CK_ArrayToPointerDecay:
      return Value::pointer(evaluate_place(from));
    case clang::CK_IntegralToFloating: {
      const Value value = evaluate(from);
      if (value.kind != Value::Kind::integer) throw ImportError{where, "a conversion of data to another type"};
      const bool single = cast->getType()->isSpecificBuiltinType(clang::BuiltinType::Float);
      if (!single && !cast->getType()->isSpecificBuiltinType(clang::BuiltinType::Double)) throw other_type(cast);
      return Value::number(constant(
          single ? static_cast<double>(static_cast<float>(value.integer)) : static_cast<double>(value.integer), where));
    }
    case clang::CK_FloatingCast: {
      const NodeId node = number(from);
      const double* const value = constant_value(node);
      if (value == nullptr) {
        throw ImportError{where,
                          fmt::format("a conversion from `{}` to `{}`; a predicate has one type for all its numbers",
                                      from->getType().getAsString(), cast->getType().getAsString())};
      }
      const bool single = cast->getType()->isSpecificBuiltinType(clang::BuiltinType::Float);
      const bool wider = cast->getType()->isSpecificBuiltinType(clang::BuiltinType::Double) ||
                         cast->getType()->isSpecificBuiltinType(clang::BuiltinType::LongDouble);
      if (!single && !wider) throw other_type(cast);
      return Value::number(constant(single ? static_cast<double>(static_cast<float>(*value)) : *value, where));
    }
    case clang::CK_IntegralToBoolean:
      return Value::whole(condition(from) ? 1 : 0);
    case clang::CK_FloatingToIntegral:
      throw ImportError{where, "a conversion of a computed number to a whole one"};
    case clang::CK_FloatingToBoolean:
      throw ImportError{where, branch_on_data};
    case clang::CK_ToVoid:
      return evaluate(from);
    default:
      throw other_type(cast);
  }
}

Value Interpreter::evaluate_unary(const clang::UnaryOperator* unary) {
  const clang::Expr* operand = unary->getSubExpr();
  const clang::SourceLocation where = unary->getExprLoc();
  switch (static_cast<int>(unary->getOpcode())) {
    case clang::UO_Plus:
      return evaluate(operand);
    case clang::UO_Minus:
      if (is_real(unary)) return Value::number(this->unary(Op::neg, number(operand), where));
      return whole(-WideInteger{integer(operand)}, unary->getType(), where);
    case clang::UO_LNot:
      return Value::whole(condition(operand) ? 0 : 1);
    case clang::UO_Not:
      return whole(~integer(operand), unary->getType(), where);
    case clang::UO_AddrOf:
      return Value::pointer(evaluate_place(operand));
    case clang::UO_PreInc:
    case clang::UO_PreDec:
      return cell(increment(unary).first, where);
    case clang::UO_PostInc:
    case clang::UO_PostDec:
      return increment(unary).second;
    default:
      throw ImportError{where, "this operator cannot be followed"};
  }
}

/// Where the operand stands, and what it held before.
std::pair<Place, Value> Interpreter::increment(const clang::UnaryOperator* unary) {
  const clang::Expr* operand = unary->getSubExpr();
  const clang::SourceLocation where = unary->getExprLoc();
  const Place place = evaluate_place(operand);
  const Value before = load(place, operand->getType(), where);
  const auto operation = unary->isIncrementOp() ? clang::BO_Add : clang::BO_Sub;
  const Value one = is_real(operand) ? Value::number(graph_.constant(1)) : Value::whole(1);
  store(place, apply(operation, before, one, operand->getType(), operand->getType(), where), where);
  return {place, before};
}

/// Where the left side stands, and what it holds now. The right side is evaluated first, as C++17 says.
std::pair<Place, Value> Interpreter::assign(const clang::BinaryOperator* binary) {
  const clang::SourceLocation where = binary->getOperatorLoc();
  const clang::Expr* left = binary->getLHS();
  const auto* compound = dyn_cast<clang::CompoundAssignOperator>(binary);
  if (compound != nullptr && is_real(left) &&
      !context_.hasSameUnqualifiedType(compound->getComputationLHSType(), left->getType())) {
    throw ImportError{where, "a computation in another type than the variable's"};
  }
  if (left->getType().isVolatileQualified()) throw ImportError{where, "a volatile object may change at any time"};
  Value value = evaluate(binary->getRHS());
  const Place place = evaluate_place(left);
  if (compound != nullptr) {
    Value before = load(place, left->getType(), where);
    const clang::QualType type = compound->getComputationLHSType();
    if (before.kind == Value::Kind::integer && type->isIntegralOrEnumerationType()) {
      before = whole(before.integer, type, where);
    }
    value = apply(clang::BinaryOperator::getOpForCompoundAssignment(binary->getOpcode()), before, value, type,
                  compound->getComputationResultType(), where);
    if (value.kind == Value::Kind::integer) value = whole(value.integer, left->getType(), where);
  }
  store(place, value, where);
  return {place, value};
}

Value Interpreter::evaluate_binary(const clang::BinaryOperator* binary) {
  const clang::Expr* left = binary->getLHS();
  if (binary->isCommaOp()) {
    evaluate(left);
    return evaluate(binary->getRHS());
  }
  if (binary->isLogicalOp()) {
    const bool first = condition(left);
    if (first == (binary->getOpcode() == clang::BO_LOr)) return Value::whole(first ? 1 : 0);
    return Value::whole(condition(binary->getRHS()) ? 1 : 0);
  }
  if (binary->isAssignmentOp()) return assign(binary).second;
  const Value a = evaluate(left);
  return apply(binary->getOpcode(), a, evaluate(binary->getRHS()), left->getType(), binary->getType(),
               binary->getOperatorLoc());
}

Value Interpreter::apply(clang::BinaryOperatorKind operation, const Value& a, const Value& b,
                         clang::QualType operand_type, clang::QualType result_type, clang::SourceLocation where) {
  const auto refuse = [&]() { return ImportError{where, "this operator cannot be followed"}; };
  if (a.kind == Value::Kind::number && b.kind == Value::Kind::number) {
    const double* const x = constant_value(a.node);
    const double* const y = constant_value(b.node);
    if (clang::BinaryOperator::isComparisonOp(operation)) {
      if (x == nullptr || y == nullptr) throw ImportError{where, branch_on_data};
      switch (static_cast<int>(operation)) {
        case clang::BO_LT:
          return Value::whole(*x < *y);
        case clang::BO_GT:
          return Value::whole(*x > *y);
        case clang::BO_LE:
          return Value::whole(*x <= *y);
        case clang::BO_GE:
          return Value::whole(*x >= *y);
        case clang::BO_EQ:
          return Value::whole(*x == *y);
        case clang::BO_NE:
          return Value::whole(*x != *y);
        default:
          throw refuse();
      }
    }
    use_real(operand_type, where);
    switch (static_cast<int>(operation)) {
      case clang::BO_Add:
        return Value::number(binary(Op::add, a.node, b.node, where));
      case clang::BO_Sub:
        return Value::number(binary(Op::sub, a.node, b.node, where));
      case clang::BO_Mul:
        return Value::number(binary(Op::mul, a.node, b.node, where));
      case clang::BO_Div:
        return Value::number(binary(Op::div, a.node, b.node, where));
      default:
        throw refuse();
    }
  }
  if (a.kind == Value::Kind::place && b.kind == Value::Kind::place && a.place.object == b.place.object) {
    switch (static_cast<int>(operation)) {  // what loops over [begin, end) need
      case clang::BO_EQ:
        return Value::whole(a.place.offset == b.place.offset);
      case clang::BO_NE:
        return Value::whole(a.place.offset != b.place.offset);
      case clang::BO_LT:
        return Value::whole(a.place.offset < b.place.offset);
      case clang::BO_GT:
        return Value::whole(a.place.offset > b.place.offset);
      case clang::BO_LE:
        return Value::whole(a.place.offset <= b.place.offset);
      case clang::BO_GE:
        return Value::whole(a.place.offset >= b.place.offset);
      default:
        throw refuse();
    }
  }
  const bool moves = operation == clang::BO_Add || operation == clang::BO_Sub;
  if (moves && a.kind == Value::Kind::place && b.kind == Value::Kind::integer) {
    const std::int64_t size = cells_of(operand_type->getPointeeType(), context_, where);
    return Value::pointer(moved(a.place, b.integer, operation == clang::BO_Add ? size : -size, where));
  }
  if (operation == clang::BO_Add && a.kind == Value::Kind::integer && b.kind == Value::Kind::place) {
    const std::int64_t size = cells_of(result_type->getPointeeType(), context_, where);
    return Value::pointer(moved(b.place, a.integer, size, where));
  }
  if (a.kind != Value::Kind::integer || b.kind != Value::Kind::integer) throw refuse();
  return apply_to_integers(operation, a.integer, b.integer, result_type, where);
}

/// The number that an expression has or, of a place, holds.
NodeId Interpreter::number_in(const clang::Expr* expression) {
  if (!expression->isGLValue()) return number(expression);
  return load(evaluate_place(expression), expression->getType(), expression->getExprLoc()).node;
}

/// Of numbers only the patterns of min, max and abs are straight-line.
Value Interpreter::evaluate_conditional(const clang::ConditionalOperator* conditional) {
  const auto* test = dyn_cast<clang::BinaryOperator>(plain(conditional->getCond()));
  const auto chosen = [&](bool yes) {
    const clang::Expr* e = yes ? conditional->getTrueExpr() : conditional->getFalseExpr();
    return e->isGLValue() ? load(evaluate_place(e), e->getType(), e->getExprLoc()) : evaluate(e);
  };
  if (test == nullptr || !test->isRelationalOp() || !is_real(test->getLHS()) || !is_real(conditional)) {
    return chosen(condition(conditional->getCond()));
  }
  const clang::SourceLocation where = conditional->getExprLoc();
  const NodeId a = number(test->getLHS());
  const NodeId b = number(test->getRHS());
  if (constant_value(a) != nullptr && constant_value(b) != nullptr) {
    const Value holds =
        apply(test->getOpcode(), Value::number(a), Value::number(b), test->getLHS()->getType(), test->getType(), where);
    return chosen(holds.integer != 0);
  }
  // Both sides are evaluated here, one of them there: neither may leave a trace.
  const std::vector<Object> before = objects_;
  const NodeId yes = number_in(conditional->getTrueExpr());
  const NodeId no = number_in(conditional->getFalseExpr());
  for (std::size_t o = 0; o < before.size(); ++o) {
    for (std::size_t i = 0; i < before[o].cells.size(); ++i) {
      const bool first_read =
          before[o].parameter >= 0 && before[o].cells[i].kind == Value::Kind::none && !objects_[o].written[i];
      if (!first_read && before[o].cells[i] != objects_[o].cells[i]) throw ImportError{where, branch_on_data};
    }
  }
  const bool less = test->getOpcode() == clang::BO_LT || test->getOpcode() == clang::BO_LE;
  if (yes == a && no == b) return Value::number(binary(less ? Op::min : Op::max, a, b, where));
  if (yes == b && no == a) return Value::number(binary(less ? Op::max : Op::min, a, b, where));
  if (const double* const zero = constant_value(b); zero != nullptr && *zero == 0) {
    const bool negated_if_negative = less && yes == unary(Op::neg, a, where) && no == a;
    const bool negated_if_not = !less && yes == a && no == unary(Op::neg, a, where);
    if (negated_if_negative || negated_if_not) return Value::number(unary(Op::abs, a, where));
  }
  throw ImportError{where, branch_on_data};
}

}  // namespace tightrope::codegen
