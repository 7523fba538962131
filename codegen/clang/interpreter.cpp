#include "codegen/clang/interpreter.h"

#include <clang/AST/Attr.h>
#include <clang/Basic/SourceManager.h>
#include <fmt/format.h>

namespace tightrope::codegen {

using clang::dyn_cast;
using dsl::NodeId;
using dsl::Op;

namespace {
constexpr int most_steps = 2'000'000;      // expressions evaluated
constexpr std::size_t deepest_call = 200;  // a recursion that would end is not told from one that would not
}  // namespace

void Interpreter::count_step(clang::SourceLocation where) {
  if (++steps_ > most_steps) throw ImportError{where, "this takes too many steps; does a loop not end?"};
}

Place Interpreter::allocate(clang::QualType type, std::string name, clang::SourceLocation where) {
  Object object;
  object.name = std::move(name);
  object.type = type;
  object.cells.resize(static_cast<std::size_t>(cells_of(type, context_, where)));
  objects_.push_back(std::move(object));
  return {static_cast<int>(objects_.size()) - 1, 0};
}

std::vector<Value> Interpreter::run(const clang::FunctionDecl* function, const std::vector<Place>& arguments) {
  Frame frame;
  for (unsigned i = 0; i < function->getNumParams(); ++i) frame.variables[function->getParamDecl(i)] = arguments[i];
  return call(function, std::move(frame), function->getLocation());
}

std::vector<Value> Interpreter::call(const clang::FunctionDecl* function, Frame frame, clang::SourceLocation where) {
  const clang::FunctionDecl* definition = nullptr;
  if (!function->hasBody(definition)) {
    throw ImportError{where, fmt::format("the body of `{}` is not to be seen", function->getQualifiedNameAsString())};
  }
  for (const Frame& caller : frames_) {
    if (caller.function == definition && frames_.size() > deepest_call) {
      throw ImportError{where, fmt::format("`{}` calls itself too often", function->getNameAsString())};
    }
  }
  if (definition != function) {  // parameters of the definition, not of an earlier declaration
    for (unsigned i = 0; i < function->getNumParams(); ++i) {
      const auto argument = frame.variables.find(function->getParamDecl(i));
      if (argument != frame.variables.end()) frame.variables[definition->getParamDecl(i)] = argument->second;
    }
  }
  frame.function = definition;
  frames_.push_back(std::move(frame));
  if (const auto* constructor = dyn_cast<clang::CXXConstructorDecl>(definition)) {
    for (const clang::CXXCtorInitializer* init : constructor->inits()) {
      if (!init->isMemberInitializer()) throw ImportError{where, "a constructor of a base class"};
      const clang::FieldDecl* field = init->getMember();
      const Place self = frames_.back().self;
      initialise({self.object, self.offset + offset_of(field, context_, where)}, field->getType(), init->getInit());
    }
  }
  const Flow flow = execute(definition->getBody());
  std::vector<Value> result = std::move(frames_.back().result);
  frames_.pop_back();
  if (flow != Flow::leave_function && !definition->getReturnType()->isVoidType() &&
      !clang::isa<clang::CXXConstructorDecl>(definition)) {
    throw ImportError{definition->getLocation(), "the function ends without returning its result"};
  }
  return result;
}

Interpreter::Frame Interpreter::bind(const clang::FunctionDecl* function,
                                     const std::vector<const clang::Expr*>& arguments, clang::SourceLocation where) {
  if (arguments.size() != function->getNumParams())
    throw ImportError{where, "a call with a variable number of arguments"};
  Frame frame;
  for (unsigned i = 0; i < function->getNumParams(); ++i) {
    const clang::ParmVarDecl* parameter = function->getParamDecl(i);
    if (parameter->getType()->isReferenceType()) {
      frame.variables[parameter] = evaluate_place(arguments[i]);
    } else {
      const Place place = allocate(parameter->getType(), "", where);
      initialise(place, parameter->getType(), arguments[i]);
      frame.variables[parameter] = place;
    }
  }
  return frame;
}

namespace {

/// Whether the standard says what it does: a declaration of the C library's, or std:: in a system header. A user's
/// function with a visible body is what its body says, whatever its name.
bool is_library_function(const clang::FunctionDecl* function, const clang::SourceManager& sources) {
  const clang::FunctionDecl* definition = nullptr;
  const bool visible = function->hasBody(definition) && !sources.isInSystemHeader(definition->getLocation());
  if (visible) return false;
  return function->getBuiltinID() != 0 ||
         (function->isInStdNamespace() && sources.isInSystemHeader(function->getLocation()));
}

}  // namespace

/// Functions of the standard library that are operations of the language.
bool Interpreter::builtin_call(const clang::CallExpr* call, Value& result) {
  const clang::FunctionDecl* callee = call->getDirectCallee();
  if (callee == nullptr) throw ImportError{call->getExprLoc(), "a call through a pointer"};
  std::string name = callee->getNameAsString();
  if (!is_library_function(callee, context_.getSourceManager())) return false;
  if (name.starts_with("__builtin_")) name = name.substr(10);
  struct Function {
    std::string_view name;
    Op op;
  };
  constexpr Function functions[] = {{"sqrt", Op::sqrt}, {"sqrtf", Op::sqrt}, {"fabs", Op::abs},  {"fabsf", Op::abs},
                                    {"abs", Op::abs},   {"min", Op::min},    {"fmin", Op::min},  {"fminf", Op::min},
                                    {"max", Op::max},   {"fmax", Op::max},   {"fmaxf", Op::max}, {"fma", Op::fma},
                                    {"fmaf", Op::fma}};
  for (const Function& f : functions) {
    if (f.name != name || call->getNumArgs() != static_cast<unsigned>(dsl::operand_count(f.op))) continue;
    std::vector<Value> operands;
    for (const clang::Expr* argument : call->arguments()) {
      if (!argument->getType()->isArithmeticType()) return false;
      operands.push_back(argument->isGLValue()
                             ? load(evaluate_place(argument), argument->getType(), argument->getExprLoc())
                             : evaluate(argument));
    }
    const clang::SourceLocation where = call->getExprLoc();
    const auto kind = operands.front().kind;
    const clang::QualType type = call->getType().getNonReferenceType();
    if (kind == Value::Kind::integer && operands.back().kind == kind && type->isIntegerType() && f.op != Op::sqrt &&
        f.op != Op::fma) {
      const std::int64_t x = operands.front().integer;
      const std::int64_t y = operands.back().integer;
      const WideInteger magnitude = x < 0 ? -WideInteger{x} : x;
      result = whole(f.op == Op::abs ? magnitude : f.op == Op::min ? std::min(x, y) : std::max(x, y), type, where);
      return true;
    }
    for (const Value& v : operands) {
      if (v.kind != Value::Kind::number)
        throw ImportError{where, fmt::format("`{}` of something else than numbers", name)};
    }
    use_real(type, where);
    if (f.op == Op::fma) {
      const NodeId node = graph_.fma(operands[0].node, operands[1].node, operands[2].node);
      result = Value::number(noted(node, operands[0].node, operands[1].node, where));
    } else if (operands.size() == 2) {
      result = Value::number(binary(f.op, operands[0].node, operands[1].node, where));
    } else {
      result = Value::number(unary(f.op, operands[0].node, where));
    }
    return true;
  }
  return false;
}

std::vector<Value> Interpreter::call_expression(const clang::CallExpr* call) {
  const clang::SourceLocation where = call->getExprLoc();
  const clang::FunctionDecl* callee = call->getDirectCallee();
  if (callee == nullptr) throw ImportError{where, "a call through a pointer"};
  std::vector<const clang::Expr*> arguments(call->arg_begin(), call->arg_end());
  const auto* method = dyn_cast<clang::CXXMethodDecl>(callee);
  if (method == nullptr || method->isStatic()) return this->call(callee, bind(callee, arguments, where), where);
  if (method->isVirtual()) throw ImportError{where, "a call of a virtual function"};
  Place self;
  if (const auto* member_call = dyn_cast<clang::CXXMemberCallExpr>(call)) {
    const clang::Expr* object = member_call->getImplicitObjectArgument();
    self = object->getType()->isPointerType() ? evaluate(object).place : evaluate_place(object);
  } else {  // an operator: the object comes first
    self = evaluate_place(arguments.front());
    arguments.erase(arguments.begin());
  }
  if (method->isCopyAssignmentOperator() || method->isMoveAssignmentOperator()) {
    if (method->isTrivial()) {
      // The right side is complete before the left changes: v = V{v.y, v.x}.
      const clang::QualType type = context_.getRecordType(method->getParent());
      copy(evaluate_place(arguments.front()), self, cells_of(type, context_, where), where);
      return {Value::pointer(self)};
    }
  }
  Frame frame = bind(callee, arguments, where);
  frame.self = self;
  frame.has_self = true;
  return this->call(callee, std::move(frame), where);
}

void Interpreter::construct(Place place, const clang::CXXConstructExpr* expression) {
  const clang::CXXConstructorDecl* constructor = expression->getConstructor();
  const clang::SourceLocation where = expression->getExprLoc();
  std::vector<const clang::Expr*> arguments(expression->arg_begin(), expression->arg_end());
  if (!constructor->isTrivial() && constructor->isDefaulted() && constructor->isCopyOrMoveConstructor()) {
    throw ImportError{where, "a copy of an object with a member that has a copy constructor of its own"};
  }
  if (constructor->isTrivial()) {
    if (arguments.empty()) return;  // left unset
    copy(evaluate_place(arguments.front()), place, cells_of(expression->getType(), context_, where), where);
    return;
  }
  Frame frame = bind(constructor, arguments, where);
  frame.self = place;
  frame.has_self = true;
  call(constructor, std::move(frame), where);
}

/// Fills the cells of a variable, a temporary or a member.
void Interpreter::initialise(Place place, clang::QualType type, const clang::Expr* init) {
  const clang::SourceLocation where = init->getExprLoc();
  const clang::Expr* e = init->IgnoreParens();
  while (const auto* wrapper = dyn_cast<clang::FullExpr>(e)) e = wrapper->getSubExpr()->IgnoreParens();
  if (const auto* temporary = dyn_cast<clang::MaterializeTemporaryExpr>(e)) e = temporary->getSubExpr();
  if (const auto* binding = dyn_cast<clang::CXXBindTemporaryExpr>(e)) e = binding->getSubExpr();
  if (const auto* value = dyn_cast<clang::CXXDefaultInitExpr>(e)) return initialise(place, type, value->getExpr());
  const bool compound = type->isRecordType() || type->isArrayType();
  if (!compound) {
    const bool reference = type->isReferenceType();
    store(place, reference ? Value::pointer(evaluate_place(e)) : evaluate(e), where);
    return;
  }
  if (const auto* cast = dyn_cast<clang::CastExpr>(e); cast != nullptr && !e->isGLValue()) {
    return initialise(place, type, cast->getSubExpr());  // constructor conversions, functional casts
  }
  if (const auto* list = dyn_cast<clang::InitListExpr>(e)) {
    std::int64_t offset = 0;
    if (const auto* array = context_.getAsConstantArrayType(type)) {
      const std::int64_t size = cells_of(array->getElementType(), context_, where);
      const auto extent = static_cast<unsigned>(array->getSize().getZExtValue());
      for (unsigned i = 0; i < extent; ++i, offset += size) {
        const clang::Expr* element = i < list->getNumInits() ? list->getInit(i) : list->getArrayFiller();
        if (element != nullptr) initialise({place.object, place.offset + offset}, array->getElementType(), element);
      }
      return;
    }
    unsigned i = 0;
    for (const clang::FieldDecl* field : type->getAs<clang::RecordType>()->getDecl()->getDefinition()->fields()) {
      if (i < list->getNumInits()) {
        initialise({place.object, place.offset + offset}, field->getType(), list->getInit(i++));
      }
      offset += cells_of(field->getType(), context_, where);
    }
    return;
  }
  if (clang::isa<clang::ImplicitValueInitExpr>(e) || clang::isa<clang::CXXScalarValueInitExpr>(e)) {
    const std::int64_t count = cells_of(type, context_, where);
    for (std::int64_t i = 0; i < count; ++i) {
      cell({place.object, place.offset + i}, where) = Value::number(graph_.constant(0));
    }
    return;
  }
  if (const auto* construction = dyn_cast<clang::CXXConstructExpr>(e)) return construct(place, construction);
  if (const auto* call = dyn_cast<clang::CallExpr>(e); call != nullptr && !e->isGLValue()) {
    const std::vector<Value> result = call_expression(call);
    for (std::size_t i = 0; i < result.size(); ++i) {
      cell({place.object, place.offset + static_cast<std::int64_t>(i)}, where) = result[i];
      name({place.object, place.offset + static_cast<std::int64_t>(i)}, result[i]);
    }
    return;
  }
  if (const auto* conditional = dyn_cast<clang::ConditionalOperator>(e); conditional != nullptr && !e->isGLValue()) {
    return initialise(place, type,
                      condition(conditional->getCond()) ? conditional->getTrueExpr() : conditional->getFalseExpr());
  }
  if (e->isGLValue()) {
    copy(evaluate_place(e), place, cells_of(type, context_, where), where);
    return;
  }
  throw ImportError{where, "this initialiser cannot be followed"};
}

void Interpreter::declare(const clang::VarDecl* variable) {
  const clang::SourceLocation where = variable->getLocation();
  if (variable->isStaticLocal() && !variable->getType().isConstQualified()) {
    throw ImportError{where, "a static variable keeps its value from call to call"};
  }
  if (variable->isStaticLocal()) return;  // read as a constant
  const clang::QualType type = variable->getType();
  Frame& frame = frames_.back();
  if (type->isReferenceType()) {
    const Place place = evaluate_place(variable->getInit());
    frames_.back().variables[variable] = place;
    return;
  }
  if (type.isVolatileQualified()) throw ImportError{where, "a volatile object may change at any time"};
  if (variable->hasAttr<clang::CleanupAttr>()) throw ImportError{where, "a variable with a clean-up function"};
  if (type->isRealFloatingType()) use_real(type, where);
  const Place place = allocate(type, variable->getNameAsString(), where);
  frame.variables[variable] = place;
  if (variable->getInit() != nullptr) initialise(place, type, variable->getInit());
}

void Interpreter::execute_return(const clang::ReturnStmt* statement) {
  const clang::Expr* value = statement->getRetValue();
  const clang::QualType type = frames_.back().function->getReturnType();
  if (value == nullptr || type->isVoidType()) return;
  std::vector<Value> result;
  if (type->isReferenceType()) {
    result.push_back(Value::pointer(evaluate_place(value)));
  } else if (type->isRecordType()) {
    const Place place = allocate(type, "", value->getExprLoc());
    initialise(place, type, value);
    result = object(place).cells;
  } else {
    result.push_back(evaluate(value));
  }
  frames_.back().result = std::move(result);
}

Interpreter::Flow Interpreter::execute_loop(const clang::Stmt* statement, const clang::Stmt* condition_variable,
                                            const clang::Expr* test, const clang::Expr* step, const clang::Stmt* body,
                                            bool test_first) {
  if (condition_variable != nullptr) throw ImportError{statement->getBeginLoc(), "a variable in a loop's condition"};
  for (bool first = true;; first = false) {
    count_step(statement->getBeginLoc());
    if (test != nullptr && (test_first || !first) && !condition(test)) return Flow::next;
    const Flow flow = execute(body);
    if (flow == Flow::leave_function) return flow;
    if (flow == Flow::leave_loop) return Flow::next;
    if (step != nullptr) evaluate(step);
  }
}

Interpreter::Flow Interpreter::execute(const clang::Stmt* statement) {
  if (statement == nullptr || clang::isa<clang::NullStmt>(statement)) return Flow::next;
  const clang::SourceLocation where = statement->getBeginLoc();
  if (const auto* block = dyn_cast<clang::CompoundStmt>(statement)) {
    for (const clang::Stmt* s : block->body()) {
      if (const Flow flow = execute(s); flow != Flow::next) return flow;
    }
    return Flow::next;
  }
  if (const auto* declarations = dyn_cast<clang::DeclStmt>(statement)) {
    for (const clang::Decl* d : declarations->decls()) {
      if (const auto* variable = dyn_cast<clang::VarDecl>(d)) declare(variable);
    }
    return Flow::next;
  }
  if (const auto* expression = dyn_cast<clang::Expr>(statement)) {
    if (expression->isPRValue() && expression->getType()->isRecordType()) {
      evaluate_place(expression);
    } else {
      evaluate(expression);
    }
    return Flow::next;
  }
  if (const auto* result = dyn_cast<clang::ReturnStmt>(statement)) {
    execute_return(result);
    return Flow::leave_function;
  }
  if (const auto* branch = dyn_cast<clang::IfStmt>(statement)) {
    execute(branch->getInit());
    if (const auto* variable = branch->getConditionVariable()) declare(variable);
    return execute(condition(branch->getCond()) ? branch->getThen() : branch->getElse());
  }
  if (const auto* loop = dyn_cast<clang::ForStmt>(statement)) {
    execute(loop->getInit());
    return execute_loop(loop, loop->getConditionVariableDeclStmt(), loop->getCond(), loop->getInc(), loop->getBody(),
                        true);
  }
  if (const auto* loop = dyn_cast<clang::WhileStmt>(statement)) {
    return execute_loop(loop, loop->getConditionVariableDeclStmt(), loop->getCond(), nullptr, loop->getBody(), true);
  }
  if (const auto* loop = dyn_cast<clang::DoStmt>(statement)) {
    return execute_loop(loop, nullptr, loop->getCond(), nullptr, loop->getBody(), false);
  }
  if (const auto* loop = dyn_cast<clang::CXXForRangeStmt>(statement)) {
    for (const clang::Stmt* s :
         {loop->getInit(), static_cast<const clang::Stmt*>(loop->getRangeStmt()),
          static_cast<const clang::Stmt*>(loop->getBeginStmt()), static_cast<const clang::Stmt*>(loop->getEndStmt())}) {
      execute(s);
    }
    while (condition(loop->getCond())) {
      execute(loop->getLoopVarStmt());
      const Flow flow = execute(loop->getBody());
      if (flow == Flow::leave_function) return flow;
      if (flow == Flow::leave_loop) break;
      evaluate(loop->getInc());
    }
    return Flow::next;
  }
  if (clang::isa<clang::BreakStmt>(statement)) return Flow::leave_loop;
  if (clang::isa<clang::ContinueStmt>(statement)) return Flow::next_turn;
  throw ImportError{where, "this statement cannot be followed"};
}

}  // namespace tightrope::codegen
