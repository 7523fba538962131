/// Expressions of an imported function.

#include <clang/AST/APValue.h>
#include <fmt/format.h>

#include "codegen/clang/interpreter.h"

namespace tightrope::codegen {

using clang::dyn_cast;
using dsl::NodeId;
using dsl::Op;

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
  if (o.parameter < 0 || o.written[index]) {
    throw ImportError{where, fmt::format("`{}` is read before it is set", o.name)};
  }
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
      cell({place.object, next++}, where) = whole(v.getInt(), where);
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
    return moved(base.place, integer(element->getIdx()), size, where);
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
    if (e->EvaluateAsInt(result, context_)) return whole(result.Val.getInt(), where);
  }
  throw ImportError{where, "this expression cannot be followed"};
}

}  // namespace tightrope::codegen
