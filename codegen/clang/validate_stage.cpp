#include "codegen/clang/validate_stage.h"

#include <clang/AST/StmtCXX.h>
#include <fmt/format.h>

#include <algorithm>

namespace tightrope::codegen {

using clang::dyn_cast;
using dsl::NodeId;

bool Subject::has_range() const {
  return std::any_of(predicate.parameters.begin(), predicate.parameters.end(),
                     [](const dsl::Parameter& p) { return p.range.has_value(); });
}

std::vector<InputArgument> input_arguments(const dsl::Predicate& predicate) {
  std::vector<InputArgument> result;
  for (const dsl::Parameter& p : predicate.parameters) {
    const int times = p.moving ? 2 : 1;
    for (int time = 0; time < times; ++time) {
      InputArgument argument{p.bounded, !p.array.empty() || p.dimension > 1, {}};
      for (int element = 0; element < p.elements(); ++element) {
        for (int component = 0; component < p.dimension; ++component) {
          argument.slots.push_back(p.first_slot + (element * times + time) * p.dimension + component);
        }
      }
      result.push_back(std::move(argument));
    }
  }
  return result;
}

std::vector<const clang::Stmt*> body(const clang::FunctionDecl* function) {
  const auto* block = dyn_cast<clang::CompoundStmt>(function->getBody());
  if (block == nullptr) throw Mismatch{function->getLocation(), "a function whose body is no block"};
  std::vector<const clang::Stmt*> result;
  for (const clang::Stmt* statement : block->body()) {
    if (const auto* expression = dyn_cast<clang::Expr>(statement)) statement = bare(expression);
    result.push_back(statement);
  }
  return result;
}

void bind_arguments(const Subject& subject, const clang::FunctionDecl* function, ExpressionReader& reader) {
  for (std::size_t i = 0; i < subject.arguments.size(); ++i) {
    reader.inputs[function->getParamDecl(static_cast<unsigned>(i))] = subject.arguments[i];
  }
}

ElementPlace element_place(const clang::Expr* expression, const clang::ValueDecl* result) {
  ElementPlace place;
  const clang::Expr* e = bare(expression);
  while (const auto* element = dyn_cast<clang::ArraySubscriptExpr>(e)) {
    place.subscripts.insert(place.subscripts.begin(), subscript(element->getIdx()));
    e = bare(element->getBase());
  }
  const auto* member = dyn_cast<clang::MemberExpr>(e);
  if (member == nullptr || member->isArrow() || !names(member->getBase(), result)) return {};
  place.field = dyn_cast<clang::FieldDecl>(member->getMemberDecl());
  return place;
}

const clang::VarDecl* declared_result(const clang::Stmt* statement, const clang::CXXRecordDecl* record) {
  const auto* declaration = dyn_cast<clang::DeclStmt>(statement);
  if (declaration == nullptr || !declaration->isSingleDecl()) return nullptr;
  const auto* variable = dyn_cast<clang::VarDecl>(declaration->getSingleDecl());
  if (variable == nullptr || !variable->hasLocalStorage()) return nullptr;
  const clang::CXXRecordDecl* type = variable->getType()->getAsCXXRecordDecl();
  if (type == nullptr || type->getCanonicalDecl() != record->getCanonicalDecl()) return nullptr;
  if (const clang::Expr* init = variable->getInit()) {  // the implicit default constructor, which does nothing
    const auto* construction = dyn_cast<clang::CXXConstructExpr>(init);
    if (construction == nullptr || construction->getNumArgs() > 0 || !construction->getConstructor()->isTrivial()) {
      return nullptr;
    }
  }
  return variable;
}

bool passes(const clang::Expr* expression, const clang::ValueDecl* variable) {
  const clang::Expr* e = bare(expression);
  if (const auto* copy = dyn_cast<clang::CXXConstructExpr>(e)) {
    const clang::CXXConstructorDecl* constructor = copy->getConstructor();
    if (!constructor->isTrivial() || !constructor->isCopyOrMoveConstructor() || copy->getNumArgs() != 1) return false;
    e = copy->getArg(0);
  }
  return names(e, variable);
}

bool returns(const clang::Stmt* statement, const clang::ValueDecl* variable) {
  const auto* result = dyn_cast<clang::ReturnStmt>(statement);
  return result != nullptr && result->getRetValue() != nullptr && passes(result->getRetValue(), variable);
}

namespace {

class StageValidator {
 public:
  StageValidator(const Subject& subject, CanonicalGraph& graph, std::size_t stage, const clang::FunctionDecl* function,
                 std::map<const clang::ValueDecl*, NodeId>& saved)
      : subject_(subject),
        graph_(graph),
        stage_(stage),
        function_(function),
        saved_(saved),
        reader_(subject.context, graph, subject.real, static_cast<int>(subject.predicate.slots.size())) {
    bind_arguments(subject, function, reader_);
    reader_.saved = saved;
    if (subject.several_stages()) reader_.state = function->getParamDecl(function->getNumParams() - 1);
    for (const dsl::Output& output : subject.predicate.stages[stage].outputs) {
      assigned_.emplace_back(output.nodes.size(), false);
    }
  }

  void run() {
    const std::vector<const clang::Stmt*> statements = body(function_);
    result_ = statements.empty() ? nullptr : declared_result(statements.front(), subject_.results[stage_]);
    if (result_ == nullptr) throw Mismatch{function_->getLocation(), "a stage that does not begin with its result"};
    for (std::size_t i = 1; i + 1 < statements.size(); ++i) follow(statements[i]);
    if (statements.size() < 2 || !returns(statements.back(), result_)) {
      throw Mismatch{statements.back()->getBeginLoc(), "a stage that does not end by returning its result"};
    }
    for (std::size_t o = 0; o < assigned_.size(); ++o) {
      const auto missing = std::find(assigned_[o].begin(), assigned_[o].end(), false);
      if (missing == assigned_[o].end()) continue;
      throw Mismatch{statements.back()->getBeginLoc(),
                     fmt::format("element {} of output {} is never set", missing - assigned_[o].begin(),
                                 subject_.predicate.stages[stage_].outputs[o].name)};
    }
  }

 private:
  void follow(const clang::Stmt* statement) {
    if (const auto* declaration = dyn_cast<clang::DeclStmt>(statement)) {
      if (declaration->isSingleDecl() && follow_local(dyn_cast<clang::VarDecl>(declaration->getSingleDecl()))) return;
    } else if (const auto* assignment = dyn_cast<clang::BinaryOperator>(statement)) {
      if (assignment->getOpcode() == clang::BO_Assign && follow_store(assignment)) return;
    } else if (const auto* call = dyn_cast<clang::CXXOperatorCallExpr>(statement)) {
      if (call->getOperator() == clang::OO_Equal && follow_output(call)) return;
    }
    throw Mismatch{statement->getBeginLoc(),
                   fmt::format("a statement that is no part of the analysed graph: `{}`", subject_.text(statement))};
  }

  /// const real v = expression;
  bool follow_local(const clang::VarDecl* variable) {
    if (variable == nullptr || !variable->hasLocalStorage() || variable->getInit() == nullptr) return false;
    const clang::QualType type = variable->getType();
    if (!type.isConstQualified() || type.isVolatileQualified() ||
        !subject_.context.hasSameUnqualifiedType(type, subject_.real)) {
      throw Mismatch{variable->getLocation(),
                     fmt::format("{} is of type `{}`, not `const {}`", variable->getNameAsString(), type.getAsString(),
                                 subject_.real.getAsString())};
    }
    const NodeId node = reader_.read(variable->getInit());
    if (!graph_.analysed(node)) {
      throw Mismatch{variable->getLocation(),
                     fmt::format("`{} = {}` is no operation of the analysed graph: {}", variable->getNameAsString(),
                                 subject_.text(variable->getInit()), graph_.describe(node))};
    }
    reader_.locals[variable] = node;
    return true;
  }

  /// state.v = expression;
  bool follow_store(const clang::BinaryOperator* assignment) {
    const auto* member = dyn_cast<clang::MemberExpr>(bare(assignment->getLHS()));
    if (member == nullptr || reader_.state == nullptr || !names(member->getBase(), reader_.state)) return false;
    const NodeId node = reader_.read(assignment->getRHS());
    if (!graph_.analysed(node) || !saved_.emplace(member->getMemberDecl(), node).second) {
      throw Mismatch{assignment->getBeginLoc(),
                     fmt::format("`{}` sets a member of State twice or to no node", subject_.text(assignment))};
    }
    reader_.saved = saved_;
    return true;
  }

  /// result.output[i] = {value, bound};
  bool follow_output(const clang::CXXOperatorCallExpr* call) {
    const auto* method = dyn_cast<clang::CXXMethodDecl>(call->getDirectCallee());
    if (method == nullptr || !method->isTrivial() || call->getNumArgs() != 2) return false;
    const ElementPlace place = element_place(call->getArg(0), result_);
    const auto* pair = dyn_cast<clang::InitListExpr>(bare(call->getArg(1)));
    if (place.field == nullptr || pair == nullptr || pair->getNumInits() != 2) return false;
    const auto o = static_cast<std::size_t>(place.field->getFieldIndex());
    const dsl::Output& output = subject_.predicate.stages[stage_].outputs[o];
    std::size_t element = 0;
    bool inside = place.subscripts.size() == output.extents.size();
    for (std::size_t i = 0; inside && i < output.extents.size(); ++i) {
      inside = place.subscripts[i] < output.extents[i];
      element = element * static_cast<std::size_t>(output.extents[i]) + static_cast<std::size_t>(place.subscripts[i]);
    }
    const std::string text = subject_.text(call);
    if (!inside)
      throw Mismatch{call->getBeginLoc(), fmt::format("subscripts that the output does not have: `{}`", text)};
    if (assigned_[o][element]) throw Mismatch{call->getBeginLoc(), fmt::format("an element set twice: `{}`", text)};
    assigned_[o][element] = true;
    const BoundedNode& analysed = subject_.bounded.stages[stage_].outputs[o].elements[element];
    compare(pair->getInit(0), analysed.value, "value", text);
    compare(pair->getInit(1), analysed.bound, "bound", text);
    return true;
  }

  void compare(const clang::Expr* written, NodeId analysed, std::string_view what, const std::string& text) {
    const NodeId found = reader_.read(written);
    const NodeId due = analysed == dsl::no_node ? graph_.constant(0) : graph_.of(analysed);
    if (found == due) return;
    throw Mismatch{written->getBeginLoc(), fmt::format("the {} in `{}` is {}; analysed was {}", what, text,
                                                       graph_.describe(found), graph_.describe(due))};
  }

  const Subject& subject_;
  CanonicalGraph& graph_;
  std::size_t stage_;
  const clang::FunctionDecl* function_;
  std::map<const clang::ValueDecl*, NodeId>& saved_;
  ExpressionReader reader_;
  const clang::VarDecl* result_ = nullptr;
  std::vector<std::vector<bool>> assigned_;
};

}  // namespace

void validate_stage(const Subject& subject, CanonicalGraph& graph, std::size_t stage,
                    const clang::FunctionDecl* function, std::map<const clang::ValueDecl*, NodeId>& saved) {
  StageValidator(subject, graph, stage, function, saved).run();
}

}  // namespace tightrope::codegen
