#include "codegen/clang/expression.h"

#include <clang/Basic/Builtins.h>
#include <clang/Lex/Lexer.h>
#include <fmt/format.h>

#include "codegen/clang/parse.h"

namespace tightrope::codegen {

using clang::dyn_cast;
using dsl::NodeId;
using dsl::Op;

namespace {

/// Whether the compiler may put another operation, or none, in the place of one with these options. (Contraction takes
/// a product, and those are behind a barrier.)
bool loose(clang::FPOptions options) {
  return options.getAllowFPReassociate() || options.getAllowReciprocal() || options.getNoHonorNaNs() ||
         options.getNoHonorInfs() || options.getNoSignedZero() || options.getAllowApproxFunc();
}

}  // namespace

const clang::Expr* bare(const clang::Expr* expression) {
  for (;;) {
    expression = expression->IgnoreParens();
    if (const auto* cast = dyn_cast<clang::ImplicitCastExpr>(expression)) {
      switch (static_cast<int>(cast->getCastKind())) {
        case clang::CK_LValueToRValue:
        case clang::CK_NoOp:
        case clang::CK_ArrayToPointerDecay:
        case clang::CK_FunctionToPointerDecay:
        case clang::CK_BuiltinFnToFnPtr:
          expression = cast->getSubExpr();
          continue;
        default:
          return expression;
      }
    }
    if (const auto* temporary = dyn_cast<clang::MaterializeTemporaryExpr>(expression)) {
      expression = temporary->getSubExpr();
    } else if (const auto* cleanups = dyn_cast<clang::ExprWithCleanups>(expression)) {
      expression = cleanups->getSubExpr();
    } else {
      return expression;
    }
  }
}

bool names(const clang::Expr* expression, const clang::ValueDecl* declaration) {
  const auto* reference = dyn_cast<clang::DeclRefExpr>(bare(expression));
  return reference != nullptr && reference->getDecl() == declaration;
}

bool in_runtime(const clang::Decl* declaration, const clang::SourceManager& sources) {
  // A macro's name in the text stands in the text: TIGHTROPE_LANES, where a namespace is opened.
  const llvm::StringRef file = sources.getFilename(sources.getExpansionLoc(declaration->getLocation()));
  return std::string_view(file.data(), file.size()).substr(0, runtime_folder.size()) == runtime_folder;
}

std::string source_text(const clang::Stmt* statement, const clang::ASTContext& context) {
  const auto range = clang::CharSourceRange::getTokenRange(statement->getSourceRange());
  std::string text = clang::Lexer::getSourceText(range, context.getSourceManager(), context.getLangOpts()).str();
  std::string result;
  for (const char c : text) {
    const bool blank = c == ' ' || c == '\n' || c == '\t';
    if (!blank || (!result.empty() && result.back() != ' ')) result += blank ? ' ' : c;
  }
  constexpr std::size_t longest = 200;
  return result.size() > longest ? result.substr(0, longest) + " ..." : result;
}

int subscript(const clang::Expr* expression) {
  const auto* number = dyn_cast<clang::IntegerLiteral>(expression->IgnoreParenImpCasts());
  if (number == nullptr || number->getValue().ugt(1u << 30)) {
    throw Mismatch{expression->getBeginLoc(), "a subscript that is no number"};
  }
  return static_cast<int>(number->getValue().getZExtValue());
}

NodeId ExpressionReader::read(const clang::Expr* expression) {
  const clang::Expr* e = bare(expression);
  const auto mismatch = [&](std::string_view what) {
    return Mismatch{e->getBeginLoc(), fmt::format("{}: `{}`", what, source_text(e, context_))};
  };
  if (!context_.hasSameUnqualifiedType(e->getType(), real_) || clang::isa<clang::CastExpr>(e)) {
    throw mismatch(fmt::format("a number of type {} converted to {} or mixed with it",
                               e->IgnoreParenCasts()->getType().getAsString(), real_.getAsString()));
  }
  if (const auto* literal = dyn_cast<clang::FloatingLiteral>(e)) {
    if (!literal->isExact()) throw mismatch("a literal that its type does not hold exactly");
    return graph_.constant(literal->getValue().convertToDouble());
  }
  if (const auto* unary = dyn_cast<clang::UnaryOperator>(e)) {
    if (unary->getOpcode() != clang::UO_Minus) throw mismatch("an operator that graphs do not have");
    return graph_.intern({.op = Op::neg, .a = read(unary->getSubExpr())});
  }
  if (const auto* binary = dyn_cast<clang::BinaryOperator>(e)) {
    Op op = Op::add;
    switch (static_cast<int>(binary->getOpcode())) {
      case clang::BO_Add:
        break;
      case clang::BO_Sub:
        op = Op::sub;
        break;
      case clang::BO_Div:
        op = Op::div;
        break;
      case clang::BO_Mul:
        throw mismatch("a bare product, which compilers may fuse with a sum; product(a, b) is due");
      default:
        throw mismatch("an operator that graphs do not have");
    }
    if (loose(binary->getFPFeaturesInEffect(context_.getLangOpts())))
      throw mismatch("an operation that may be changed");
    const NodeId a = read(binary->getLHS());
    return graph_.intern({.op = op, .a = a, .b = read(binary->getRHS())});
  }
  if (const auto* call = dyn_cast<clang::CallExpr>(e)) return read_call(call);
  if (const auto* member = dyn_cast<clang::MemberExpr>(e)) return read_member(member);
  if (const auto* reference = dyn_cast<clang::DeclRefExpr>(e)) {
    if (const auto local = locals.find(reference->getDecl()); local != locals.end()) return local->second;
  }
  return input(e, false, e);
}

/// The operation that a callee stands for: the runtime's own functions and built-ins, nothing of the same name.
Op ExpressionReader::operation(const clang::CallExpr* call) const {
  struct Callee {
    std::string_view name;
    Op op;
  };
  constexpr Callee callees[] = {{"tightrope::product", Op::mul},
                                {"tightrope::sum", Op::add},
                                {"tightrope::difference", Op::sub},
                                {"tightrope::magnitude", Op::abs},
                                {"tightrope::minimum", Op::min},
                                {"tightrope::maximum", Op::max},
                                {"tightrope::max_magnitude", Op::max_magnitude},
                                {"tightrope::choose", Op::select},
                                {"tightrope::square_root", Op::sqrt},
                                {"tightrope::multiply_add", Op::fma},
                                {"tightrope::normalizer", Op::normalizer},
                                {"tightrope::certain_nonzero", Op::certain_nonzero},
                                {"tightrope::certain_nonnegative", Op::certain_nonnegative}};
  const clang::FunctionDecl* callee = call->getDirectCallee();
  if (callee != nullptr) {
    switch (callee->getBuiltinID()) {
      case clang::Builtin::BI__builtin_sqrt:
      case clang::Builtin::BI__builtin_sqrtf:
        return Op::sqrt;
      case clang::Builtin::BI__builtin_fma:
      case clang::Builtin::BI__builtin_fmaf:
        return Op::fma;
      default:
        break;
    }
    const std::string name = callee->getQualifiedNameAsString();
    for (const Callee& known : callees) {
      if (known.name == name && in_runtime(callee, context_.getSourceManager())) return known.op;
    }
  }
  throw Mismatch{call->getBeginLoc(), fmt::format("a call of something else than the runtime's operations: `{}`",
                                                  source_text(call, context_))};
}

NodeId ExpressionReader::read_call(const clang::CallExpr* call) {
  if (const clang::FunctionDecl* callee = call->getDirectCallee()) {
    const unsigned id = callee->getBuiltinID();
    if (id == clang::Builtin::BI__builtin_inf || id == clang::Builtin::BI__builtin_inff) {
      return graph_.constant(std::numeric_limits<double>::infinity());
    }
  }
  dsl::Node node = {.op = operation(call)};
  if (static_cast<int>(call->getNumArgs()) != dsl::operand_count(node.op)) {
    throw Mismatch{call->getBeginLoc(), "a call with another number of operands than the operation has"};
  }
  dsl::NodeId* const operands[] = {&node.a, &node.b, &node.c};
  for (unsigned i = 0; i < call->getNumArgs(); ++i) *operands[i] = read(call->getArg(i));
  return graph_.intern(node);
}

/// `state.v7`, or `.value` and `.bound` of an input.
NodeId ExpressionReader::read_member(const clang::MemberExpr* member) {
  const clang::ValueDecl* field = member->getMemberDecl();
  if (!member->isArrow() && state != nullptr && names(member->getBase(), state)) {
    const auto found = saved.find(field);
    if (found != saved.end()) return found->second;
    throw Mismatch{member->getBeginLoc(), fmt::format("`{}` is read before it is set", source_text(member, context_))};
  }
  const bool of_bounded = in_runtime(field, context_.getSourceManager());
  const std::string name = field->getNameAsString();
  if (member->isArrow() || !of_bounded || (name != "value" && name != "bound")) {
    throw Mismatch{member->getBeginLoc(), fmt::format("`{}` is no input", source_text(member, context_))};
  }
  return input(bare(member->getBase()), name == "bound", member);
}

/// The input at `place`, an argument or an element of one; `whole` with the member behind it.
NodeId ExpressionReader::input(const clang::Expr* place, bool bound, const clang::Expr* whole) {
  const auto mismatch = [&](std::string_view what) {
    return Mismatch{whole->getBeginLoc(), fmt::format("{}: `{}`", what, source_text(whole, context_))};
  };
  const auto* element = dyn_cast<clang::ArraySubscriptExpr>(place);
  const clang::Expr* base = element != nullptr ? bare(element->getBase()) : place;
  const auto* reference = dyn_cast<clang::DeclRefExpr>(base);
  const auto argument = reference != nullptr ? inputs.find(reference->getDecl()) : inputs.end();
  if (argument == inputs.end()) throw mismatch("no operation of graphs and no input");
  const InputArgument& source = argument->second;
  if (source.pointer != (element != nullptr)) throw mismatch("an argument used as another type");
  const auto index = static_cast<std::size_t>(element != nullptr ? subscript(element->getIdx()) : 0);
  if (index >= source.slots.size()) throw mismatch("a subscript beyond the end of the argument");
  if (source.bounded != (whole != place)) throw mismatch("a bounded number used as a plain one");
  return graph_.intern({.op = Op::input, .index = source.slots[index] + (bound ? slots_ : 0)});
}

}  // namespace tightrope::codegen
