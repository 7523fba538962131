/// `in_range` and the functions that consult it.

#include <clang/AST/StmtCXX.h>
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <set>

#include "codegen/clang/validate_stage.h"

namespace tightrope::codegen {

using clang::dyn_cast;
using dsl::NodeId;
using dsl::Op;

namespace {

/// The number of the format that comes next above a finite one.
double next_up(double value, Precision precision) {
  if (precision == Precision::binary64) return std::nextafter(value, std::numeric_limits<double>::infinity());
  return static_cast<double>(std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity()));
}

/// Whether `limit`, a number of the format, lets the same finite numbers through as `range`: |x| <= range <=> |x| <=
/// limit.
bool same_range(double limit, double range, Precision precision) {
  return limit >= 0 && limit <= range && next_up(limit, precision) > range;
}

/// The conjuncts of a && b && ...
void collect_conjuncts(const clang::Expr* expression, std::vector<const clang::Expr*>& conjuncts) {
  std::vector<const clang::Expr*> open = {expression};
  while (!open.empty()) {
    const clang::Expr* e = bare(open.back());
    open.pop_back();
    const auto* binary = dyn_cast<clang::BinaryOperator>(e);
    if (binary != nullptr && binary->getOpcode() == clang::BO_LAnd) {
      open.push_back(binary->getRHS());
      open.push_back(binary->getLHS());
    } else {
      conjuncts.push_back(e);
    }
  }
}

/// The direct call in `expression`, whose arguments are those of `function` in order, then nothing (or, with
/// `with_state`, the state).
bool calls_with_own_arguments(const clang::Expr* expression, const clang::FunctionDecl* callee,
                              const clang::FunctionDecl* function, bool with_state) {
  const auto* call = dyn_cast<clang::CallExpr>(bare(expression));
  if (call == nullptr || call->getDirectCallee() == nullptr) return false;
  if (call->getDirectCallee()->getCanonicalDecl() != callee->getCanonicalDecl()) return false;
  const unsigned count = with_state ? function->getNumParams() : callee->getNumParams();
  if (call->getNumArgs() != count || callee->getNumParams() != count) return false;
  for (unsigned i = 0; i < count; ++i) {
    if (!passes(call->getArg(i), function->getParamDecl(i))) return false;
  }
  return true;
}

/// `state = State{};`
bool resets_state(const clang::Stmt* statement, const clang::ValueDecl* state) {
  const auto* call = dyn_cast<clang::CXXOperatorCallExpr>(statement);
  if (call == nullptr || call->getOperator() != clang::OO_Equal || !names(call->getArg(0), state)) return false;
  const clang::Expr* value = bare(call->getArg(1));
  if (const auto* cast = dyn_cast<clang::CXXFunctionalCastExpr>(value)) value = bare(cast->getSubExpr());
  const auto* list = dyn_cast<clang::InitListExpr>(value);
  return list != nullptr && std::all_of(list->begin(), list->end(), [](const clang::Stmt* member) {
           return clang::isa<clang::ImplicitValueInitExpr>(member);
         });
}

/// The output that `make_uncertain(result.output);` wipes out; null if it is something else.
const clang::FieldDecl* wiped_output(const Subject& subject, const clang::Stmt* statement,
                                     const clang::ValueDecl* result) {
  const auto* call = dyn_cast<clang::CallExpr>(statement);
  const clang::FunctionDecl* callee = call == nullptr ? nullptr : call->getDirectCallee();
  if (callee == nullptr || callee->getQualifiedNameAsString() != "tightrope::make_uncertain" ||
      !in_runtime(callee, subject.context.getSourceManager()) || call->getNumArgs() != 1) {
    return nullptr;
  }
  const ElementPlace place = element_place(call->getArg(0), result);
  return place.subscripts.empty() ? place.field : nullptr;
}

/// What the caller gets where a range is broken: every output wiped out, State empty.
void validate_refusal(const Subject& subject, std::size_t stage, const clang::FunctionDecl* checked,
                      const clang::Stmt* branch) {
  const auto* block = dyn_cast<clang::CompoundStmt>(branch);
  if (block == nullptr) throw Mismatch{branch->getBeginLoc(), "a range check without a block"};
  std::vector<const clang::Stmt*> statements;
  for (const clang::Stmt* s : block->body()) {
    const auto* expression = dyn_cast<clang::Expr>(s);
    statements.push_back(expression != nullptr ? bare(expression) : s);
  }
  std::size_t next = 0;
  const auto statement = [&]() {
    if (next == statements.size()) throw Mismatch{block->getEndLoc(), "the answer beyond the range is incomplete"};
    return statements[next++];
  };
  if (stage + 1 < subject.predicate.stages.size() &&
      !resets_state(statement(), checked->getParamDecl(checked->getNumParams() - 1))) {
    throw Mismatch{block->getBeginLoc(), "State is not emptied where a range is broken"};
  }
  const clang::VarDecl* result = declared_result(statement(), subject.results[stage]);
  if (result == nullptr) throw Mismatch{block->getBeginLoc(), "no result is declared where a range is broken"};
  std::set<const clang::FieldDecl*> wiped;
  const std::size_t outputs = subject.predicate.stages[stage].outputs.size();
  while (wiped.size() < outputs) {
    const clang::Stmt* s = statement();
    const clang::FieldDecl* field = wiped_output(subject, s, result);
    if (field == nullptr || !wiped.insert(field).second) {
      throw Mismatch{s->getBeginLoc(), fmt::format("`{}` where an output should become uncertain", subject.text(s))};
    }
  }
  const clang::Stmt* last = statement();
  if (!returns(last, result) || next != statements.size()) {
    throw Mismatch{last->getBeginLoc(),
                   fmt::format("`{}` where the uncertain result should be returned", subject.text(last))};
  }
}

}  // namespace

void validate_in_range(const Subject& subject, const clang::FunctionDecl* function) {
  const int slots = static_cast<int>(subject.predicate.slots.size());
  CanonicalGraph graph({}, 0);
  std::map<NodeId, double> limits;  // of what must be compared
  for (std::size_t a = 0, p = 0; p < subject.predicate.parameters.size(); ++p) {
    const dsl::Parameter& parameter = subject.predicate.parameters[p];
    for (int time = 0; time < (parameter.moving ? 2 : 1); ++time, ++a) {
      if (!parameter.range) continue;
      for (const int slot : subject.arguments[a].slots) {
        const NodeId input = graph.intern({.op = Op::input, .index = slot});
        limits[graph.intern({.op = Op::abs, .a = input})] = *parameter.range;
        if (parameter.bounded) limits[graph.intern({.op = Op::input, .index = slots + slot})] = *parameter.range;
      }
    }
  }
  ExpressionReader reader(subject.context, graph, subject.real, slots);
  bind_arguments(subject, function, reader);
  const std::vector<const clang::Stmt*> statements = body(function);
  const auto* result = statements.size() == 1 ? dyn_cast<clang::ReturnStmt>(statements.front()) : nullptr;
  if (result == nullptr) throw Mismatch{function->getLocation(), "in_range does more than to return a condition"};
  std::vector<const clang::Expr*> conjuncts;
  collect_conjuncts(result->getRetValue(), conjuncts);
  for (const clang::Expr* conjunct : conjuncts) {
    const auto mismatch = [&](std::string_view what) {
      return Mismatch{conjunct->getBeginLoc(), fmt::format("`{}` {}", subject.text(conjunct), what)};
    };
    const auto* comparison = dyn_cast<clang::BinaryOperator>(conjunct);
    if (comparison == nullptr || comparison->getOpcode() != clang::BO_LE) throw mismatch("is no test of a range");
    const auto* limit = dyn_cast<clang::FloatingLiteral>(bare(comparison->getRHS()));
    const auto due = limits.find(reader.read(comparison->getLHS()));
    if (limit == nullptr || due == limits.end()) throw mismatch("tests no declared range, or one twice");
    reader.read(limit);  // its type
    if (!same_range(limit->getValue().convertToDouble(), due->second, subject.precision)) {
      throw mismatch(fmt::format("tests another range than the declared {:a}", due->second));
    }
    limits.erase(due);
  }
  if (!limits.empty()) {
    throw Mismatch{result->getBeginLoc(),
                   fmt::format("in_range does not test {}", graph.describe(limits.begin()->first))};
  }
}

void validate_checked_stage(const Subject& subject, std::size_t stage, const clang::FunctionDecl* checked,
                            const clang::FunctionDecl* in_range, const clang::FunctionDecl* unchecked) {
  const std::vector<const clang::Stmt*> statements = body(checked);
  const auto* branch = statements.size() == 2 ? dyn_cast<clang::IfStmt>(statements[0]) : nullptr;
  const auto* last = statements.size() == 2 ? dyn_cast<clang::ReturnStmt>(statements[1]) : nullptr;
  if (branch == nullptr || last == nullptr || branch->getElse() != nullptr || branch->getInit() != nullptr) {
    throw Mismatch{checked->getLocation(), "a checked stage does more than to test the range and pass on"};
  }
  const auto* negation = dyn_cast<clang::UnaryOperator>(bare(branch->getCond()));
  if (negation == nullptr || negation->getOpcode() != clang::UO_LNot ||
      !calls_with_own_arguments(negation->getSubExpr(), in_range, checked, false)) {
    throw Mismatch{branch->getBeginLoc(),
                   fmt::format("`{}` is not the test of the range", subject.text(branch->getCond()))};
  }
  validate_refusal(subject, stage, checked, branch->getThen());
  if (last->getRetValue() == nullptr ||
      !calls_with_own_arguments(last->getRetValue(), unchecked, checked, subject.several_stages())) {
    throw Mismatch{last->getBeginLoc(),
                   fmt::format("`{}` does not pass on to the unchecked stage", subject.text(last))};
  }
}

}  // namespace tightrope::codegen
