/// Expressions of an imported function.

#include <clang/AST/APValue.h>
#include <fmt/format.h>

#include "codegen/clang/interpreter.h"

namespace tightrope::codegen {

using clang::dyn_cast;
using dsl::NodeId;
using dsl::Op;

namespace {

/// Without what stands for nothing: parentheses, temporaries, defaults, template arguments.
const clang::Expr* plain(const clang::Expr* e) {
  for (;;) {
    const clang::Expr* inner = e->IgnoreParens();
    if (const auto* t = dyn_cast<clang::MaterializeTemporaryExpr>(inner)) inner = t->getSubExpr();
    if (const auto* t = dyn_cast<clang::ExprWithCleanups>(inner)) inner = t->getSubExpr();
    if (const auto* t = dyn_cast<clang::ConstantExpr>(inner)) inner = t->getSubExpr();
    if (const auto* t = dyn_cast<clang::CXXBindTemporaryExpr>(inner)) inner = t->getSubExpr();
    if (const auto* t = dyn_cast<clang::CXXDefaultArgExpr>(inner)) inner = t->getExpr();
    if (const auto* t = dyn_cast<clang::CXXDefaultInitExpr>(inner)) inner = t->getExpr();
    if (const auto* t = dyn_cast<clang::SubstNonTypeTemplateParmExpr>(inner)) inner = t->getReplacement();
    if (inner == e) return e;
    e = inner;
  }
}

bool is_real(const clang::Expr* e) { return e->getType()->isRealFloatingType(); }

constexpr const char* branch_on_data =
    "a branch on a computed number: a predicate is straight-line (return the number whose sign decides)";

}  // namespace

Value& Interpreter::cell(Place place, clang::SourceLocation where) {
  Object& o = objects_[static_cast<std::size_t>(place.object)];
  const auto index = static_cast<std::size_t>(place.offset);
  if (place.offset < 0 || (index >= o.cells.size() && !o.grows) || place.offset > 1'000'000) {
    throw ImportError{where, fmt::format("element {} of `{}` is not there", place.offset, o.name)};
  }
  if (index >= o.cells.size()) o.cells.resize(index + 1);
  if (o.parameter >= 0 && o.read.size() < o.cells.size()) {
    o.read.resize(o.cells.size());
    o.written.resize(o.cells.size());
  }
  return o.cells[index];
}

Value Interpreter::load(Place place, clang::QualType type, clang::SourceLocation where) {
  if (type.isVolatileQualified()) throw ImportError{where, "a volatile object may change at any time"};
  Value& value = cell(place, where);
  const Object& o = objects_[static_cast<std::size_t>(place.object)];
  const auto index = static_cast<std::size_t>(place.offset);
  if (o.parameter >= 0 && !o.written[index]) objects_[static_cast<std::size_t>(place.object)].read[index] = true;
  if (value.kind != Value::Kind::none) return value;
  if (o.parameter < 0) throw ImportError{where, fmt::format("`{}` is read before it is set", o.name)};
  if (!type->isRealFloatingType()) {
    throw ImportError{where, fmt::format("`{}` is not known at compile time", o.name)};
  }
  use_real(type, where);
  value = Value::number(graph_.input(static_cast<std::int32_t>(inputs_.size())));
  inputs_.emplace_back(o.parameter, place.offset);
  return value;
}

/// Cells of an array or a struct as they are, set or not.
void Interpreter::copy(Place from, Place to, std::int64_t count, clang::SourceLocation where) {
  for (std::int64_t i = 0; i < count; ++i) {
    const Place source = {from.object, from.offset + i};
    Value value = cell(source, where);
    const Object& o = object(source);
    if (o.parameter >= 0) value = load(source, o.scalar, where);
    store({to.object, to.offset + i}, value, where);
  }
}

void Interpreter::store(Place place, const Value& value, clang::SourceLocation where) {
  cell(place, where) = value;
  Object& o = object(place);
  if (o.parameter >= 0) o.written[static_cast<std::size_t>(place.offset)] = true;
  name(place, value);
}

/// The first variable that a computed number is stored in gives it its name.
void Interpreter::name(Place place, const Value& value) {
  if (value.kind != Value::Kind::number) return;
  const Op op = graph_[value.node].op;
  const Object& o = object(place);
  if (op == Op::input || op == Op::constant || o.name.empty()) return;
  names_.try_emplace(value.node, o.name + cell_label(o.type, place.offset, context_));
}

NodeId Interpreter::number(const clang::Expr* expression) {
  const Value value = evaluate(expression);
  if (value.kind != Value::Kind::number) throw ImportError{expression->getBeginLoc(), "a number is needed here"};
  return value.node;
}

std::int64_t Interpreter::integer(const clang::Expr* expression) {
  const Value value = evaluate(expression);
  if (value.kind == Value::Kind::integer) return value.integer;
  if (value.kind == Value::Kind::number) throw ImportError{expression->getBeginLoc(), branch_on_data};
  throw ImportError{expression->getBeginLoc(), "a whole number known at compile time is needed here"};
}

bool Interpreter::condition(const clang::Expr* expression) { return integer(expression) != 0; }

Place Interpreter::global_constant(const clang::VarDecl* variable, clang::SourceLocation where) {
  if (const auto known = globals_.find(variable); known != globals_.end()) return known->second;
  const clang::VarDecl* definition = variable->getInitializingDeclaration();
  const clang::APValue* value =
      definition != nullptr && definition->getType().isConstQualified() && !definition->getType().isVolatileQualified()
          ? definition->evaluateValue()
          : nullptr;
  if (value == nullptr) {
    throw ImportError{where,
                      fmt::format("`{}` is neither a parameter, a local nor a constant", variable->getNameAsString())};
  }
  const Place place = allocate(variable->getType(), "", where);
  std::int64_t next = 0;
  const auto fill = [&](const auto& self, const clang::APValue& v) -> void {
    if (v.isArray()) {
      for (unsigned i = 0; i < v.getArraySize(); ++i) {
        self(self, i < v.getArrayInitializedElts() ? v.getArrayInitializedElt(i) : v.getArrayFiller());
      }
    } else if (v.isStruct()) {
      for (unsigned i = 0; i < v.getStructNumFields(); ++i) self(self, v.getStructField(i));
    } else if (v.isInt()) {
      cell({place.object, next++}, where) = Value::whole(v.getInt().getExtValue());
    } else if (v.isFloat()) {
      llvm::APFloat number = v.getFloat();
      bool loses = false;
      number.convert(llvm::APFloat::IEEEdouble(), llvm::APFloat::rmNearestTiesToEven, &loses);
      if (loses) throw ImportError{where, "a constant that no double holds"};
      cell({place.object, next++}, where) = Value::number(constant(number.convertToDouble(), where));
    } else {
      throw ImportError{where, fmt::format("`{}` is no constant number", variable->getNameAsString())};
    }
  };
  fill(fill, *value);
  globals_[variable] = place;
  return place;
}

Place Interpreter::evaluate_place(const clang::Expr* expression) {
  const clang::Expr* e = plain(expression);
  const clang::SourceLocation where = e->getExprLoc();
  if (const auto* reference = dyn_cast<clang::DeclRefExpr>(e)) {
    const auto* variable = dyn_cast<clang::VarDecl>(reference->getDecl());
    if (variable == nullptr) throw ImportError{where, "this is no variable"};
    const auto& variables = frames_.back().variables;
    if (const auto local = variables.find(variable); local != variables.end()) return local->second;
    return global_constant(variable, where);
  }
  if (const auto* element = dyn_cast<clang::ArraySubscriptExpr>(e)) {
    const Value base = evaluate(element->getBase());
    if (base.kind != Value::Kind::place) throw ImportError{where, "this pointer leads nowhere that is known"};
    const std::int64_t size = cells_of(element->getType(), context_, where);
    return {base.place.object, base.place.offset + integer(element->getIdx()) * size};
  }
  if (const auto* member = dyn_cast<clang::MemberExpr>(e)) {
    const auto* field = dyn_cast<clang::FieldDecl>(member->getMemberDecl());
    if (field == nullptr) {
      if (const auto* variable = dyn_cast<clang::VarDecl>(member->getMemberDecl()))
        return global_constant(variable, where);
      throw ImportError{where, "this member is no variable"};
    }
    const Place base = member->isArrow() ? evaluate(member->getBase()).place : evaluate_place(member->getBase());
    if (base.object < 0) throw ImportError{where, "this pointer leads nowhere that is known"};
    const Place place = {base.object, base.offset + offset_of(field, context_, where)};
    return field->getType()->isReferenceType() ? cell(place, where).place : place;
  }
  if (const auto* unary = dyn_cast<clang::UnaryOperator>(e)) {
    if (unary->getOpcode() == clang::UO_Deref) {
      const Value base = evaluate(unary->getSubExpr());
      if (base.kind == Value::Kind::place && base.place.object >= 0) return base.place;
      throw ImportError{where, "this pointer leads nowhere that is known"};
    }
    if (unary->isPrefix() && unary->isIncrementDecrementOp()) return increment(unary).first;
  }
  if (const auto* binary = dyn_cast<clang::BinaryOperator>(e)) {
    if (binary->isAssignmentOp()) return assign(binary).first;
    if (binary->isCommaOp()) {
      evaluate(binary->getLHS());
      return evaluate_place(binary->getRHS());
    }
  }
  if (const auto* conditional = dyn_cast<clang::ConditionalOperator>(e); conditional && e->isGLValue()) {
    return evaluate_place(condition(conditional->getCond()) ? conditional->getTrueExpr() : conditional->getFalseExpr());
  }
  if (const auto* cast = dyn_cast<clang::CastExpr>(e)) {
    const auto kind = cast->getCastKind();
    if (kind == clang::CK_NoOp && cast->getSubExpr()->isGLValue()) return evaluate_place(cast->getSubExpr());
  }
  if (const auto* call = dyn_cast<clang::CallExpr>(e); call && call->getDirectCallee() != nullptr && e->isGLValue()) {
    Value value;
    if (!builtin_call(call, value)) {
      const std::vector<Value> result = call_expression(call);
      if (!result.empty() && result.front().kind == Value::Kind::place) return result.front().place;
    } else {
      const Place place = allocate(e->getType(), "", where);
      cell(place, where) = value;
      return place;
    }
  }
  if (!e->isGLValue()) {  // a temporary
    const Place place = allocate(e->getType(), "", where);
    initialise(place, e->getType(), e);
    return place;
  }
  throw ImportError{where, "this expression cannot be followed"};
}

Value Interpreter::evaluate(const clang::Expr* expression) {
  const clang::Expr* e = plain(expression);
  const clang::SourceLocation where = e->getExprLoc();
  count_step(where);
  if (const auto* literal = dyn_cast<clang::FloatingLiteral>(e)) {
    llvm::APFloat value = literal->getValue();
    bool loses = false;
    value.convert(llvm::APFloat::IEEEdouble(), llvm::APFloat::rmNearestTiesToEven, &loses);
    if (loses) throw ImportError{where, "a constant that no double holds"};
    return Value::number(constant(value.convertToDouble(), where));
  }
  if (const auto* cast = dyn_cast<clang::CastExpr>(e)) return evaluate_cast(cast);
  if (const auto* unary = dyn_cast<clang::UnaryOperator>(e)) return evaluate_unary(unary);
  if (const auto* binary = dyn_cast<clang::BinaryOperator>(e)) return evaluate_binary(binary);
  if (const auto* conditional = dyn_cast<clang::ConditionalOperator>(e)) return evaluate_conditional(conditional);
  if (dyn_cast<clang::CXXThisExpr>(e)) return Value::pointer(frames_.back().self);
  if (dyn_cast<clang::ImplicitValueInitExpr>(e) || dyn_cast<clang::CXXScalarValueInitExpr>(e)) {
    return is_real(e) ? Value::number(graph_.constant(0)) : Value::whole(0);
  }
  if (const auto* list = dyn_cast<clang::InitListExpr>(e); list != nullptr && list->getNumInits() == 1) {
    return evaluate(list->getInit(0));
  }
  if (const auto* call = dyn_cast<clang::CallExpr>(e)) {
    Value value;
    if (builtin_call(call, value)) return value;
    const std::vector<Value> result = call_expression(call);
    return result.empty() ? Value{} : result.front();
  }
  if (e->isGLValue()) return Value::pointer(evaluate_place(e));
  if (e->getType()->isIntegralOrEnumerationType()) {
    clang::Expr::EvalResult result;
    if (e->EvaluateAsInt(result, context_)) return Value::whole(result.Val.getInt().getExtValue());
  }
  throw ImportError{where, "this expression cannot be followed"};
}

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
        const std::int64_t value = integer(from);
        const llvm::APSInt wide = llvm::APSInt::get(value);
        const unsigned bits = static_cast<unsigned>(context_.getIntWidth(cast->getType()));
        const bool is_unsigned = cast->getType()->isUnsignedIntegerOrEnumerationType();
        if (bits >= 64 && is_unsigned && value < 0) {
          throw ImportError{where, "a whole number beyond the range of its type"};
        }
        if (bits >= 64) return Value::whole(value);
        return Value::whole(is_unsigned ? static_cast<std::int64_t>(wide.zextOrTrunc(bits).getZExtValue())
                                        : wide.trunc(bits).getSExtValue());
      }
      return evaluate(from);
    case clang::CK_ArrayToPointerDecay:
      return Value::pointer(evaluate_place(from));
    case clang::CK_IntegralToFloating: {
      const Value value = evaluate(from);
      if (value.kind != Value::Kind::integer) throw ImportError{where, "a conversion of data to another type"};
      const bool single = cast->getType()->isSpecificBuiltinType(clang::BuiltinType::Float);
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
      throw ImportError{where, fmt::format("a conversion from `{}` to `{}`", from->getType().getAsString(),
                                           cast->getType().getAsString())};
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
      return Value::whole(-integer(operand));
    case clang::UO_LNot:
      return Value::whole(condition(operand) ? 0 : 1);
    case clang::UO_Not:
      return Value::whole(~integer(operand));
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
  store(place, apply(operation, before, one, operand->getType(), unary), where);
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
    value = apply(clang::BinaryOperator::getOpForCompoundAssignment(binary->getOpcode()),
                  load(place, left->getType(), where), value, left->getType(), binary);
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
  return apply(binary->getOpcode(), a, evaluate(binary->getRHS()), left->getType(), binary);
}

Value Interpreter::apply(clang::BinaryOperatorKind operation, const Value& a, const Value& b,
                         clang::QualType operand_type, const clang::Expr* whole) {
  const clang::SourceLocation where = whole->getExprLoc();
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
    return Value::pointer({a.place.object, a.place.offset + (operation == clang::BO_Add ? 1 : -1) * b.integer * size});
  }
  if (operation == clang::BO_Add && a.kind == Value::Kind::integer && b.kind == Value::Kind::place) {
    const std::int64_t size = cells_of(whole->getType()->getPointeeType(), context_, where);
    return Value::pointer({b.place.object, b.place.offset + a.integer * size});
  }
  if (a.kind != Value::Kind::integer || b.kind != Value::Kind::integer) throw refuse();
  const std::int64_t x = a.integer;
  const std::int64_t y = b.integer;
  std::int64_t result = 0;
  bool overflow = false;
  switch (static_cast<int>(operation)) {
    case clang::BO_Add:
      overflow = __builtin_add_overflow(x, y, &result);
      break;
    case clang::BO_Sub:
      overflow = __builtin_sub_overflow(x, y, &result);
      break;
    case clang::BO_Mul:
      overflow = __builtin_mul_overflow(x, y, &result);
      break;
    case clang::BO_Div:
    case clang::BO_Rem:
      if (y == 0) throw ImportError{where, "a division by zero"};
      if (y == -1) return Value::whole(operation == clang::BO_Div ? -x : 0);
      result = operation == clang::BO_Div ? x / y : x % y;
      break;
    case clang::BO_LT:
      return Value::whole(x < y);
    case clang::BO_GT:
      return Value::whole(x > y);
    case clang::BO_LE:
      return Value::whole(x <= y);
    case clang::BO_GE:
      return Value::whole(x >= y);
    case clang::BO_EQ:
      return Value::whole(x == y);
    case clang::BO_NE:
      return Value::whole(x != y);
    case clang::BO_And:
      return Value::whole(x & y);
    case clang::BO_Or:
      return Value::whole(x | y);
    case clang::BO_Xor:
      return Value::whole(x ^ y);
    case clang::BO_Shl:
    case clang::BO_Shr:
      if (x < 0 || y < 0 || y > 62 || (operation == clang::BO_Shl && x > (INT64_MAX >> y))) throw refuse();
      return Value::whole(operation == clang::BO_Shl ? x << y : x >> y);
    default:
      throw refuse();
  }
  // Wrapping of narrower types is not followed: no loop bound or subscript should rest on it.
  const bool narrow = whole->getType()->isIntegerType() && context_.getIntWidth(whole->getType()) <= 32;
  const bool is_unsigned = whole->getType()->isUnsignedIntegerType();
  if (overflow ||
      (narrow && (result > (is_unsigned ? UINT32_MAX : INT32_MAX) || result < (is_unsigned ? 0 : INT32_MIN))) ||
      (is_unsigned && result < 0)) {
    throw ImportError{where, "a whole number beyond the range of its type"};
  }
  return Value::whole(result);
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
    const Value holds = apply(test->getOpcode(), Value::number(a), Value::number(b), test->getLHS()->getType(), test);
    return chosen(holds.integer != 0);
  }
  // Both sides are evaluated here, one of them there: neither may leave a trace.
  const std::vector<Object> before = objects_;
  const NodeId yes = number_in(conditional->getTrueExpr());
  const NodeId no = number_in(conditional->getFalseExpr());
  for (std::size_t o = 0; o < before.size(); ++o) {
    for (std::size_t i = 0; i < before[o].cells.size(); ++i) {
      const bool first_read = before[o].parameter >= 0 && before[o].cells[i].kind == Value::Kind::none &&
                              !objects_[o].written[i];
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
