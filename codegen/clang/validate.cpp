#include "codegen/clang/validate.h"

#include <clang/AST/DeclTemplate.h>
#include <clang/Frontend/ASTUnit.h>
#include <fmt/format.h>

#include <sstream>

#include "codegen/clang/parse.h"
#include "codegen/clang/validate_stage.h"
#include "codegen/precision.h"

namespace tightrope::codegen {
namespace {

using clang::dyn_cast;

std::string_view tag_name(BoundMode mode) {
  switch (mode) {
    case BoundMode::none:
      return "tightrope::bound::none";
    case BoundMode::safe:
      return "tightrope::bound::safe";
    case BoundMode::tight:
      return "tightrope::bound::tight";
    case BoundMode::fixed:
      return "tightrope::bound::fixed";
    case BoundMode::interval:
      return "tightrope::bound::interval";
    case BoundMode::exact:
      return "tightrope::bound::exact";
    case BoundMode::staged:
      return "tightrope::bound::staged";
  }
  return "";
}

/// The syntax tree is what Clang makes of the text. A conditional or a macro could make something else of it for
/// another compiler, so there are none but the refusal to compile without fused multiply-add (`--fma`).
std::string foreign_directive(const std::string& text, const std::string& file_name) {
  const auto known = [](std::string_view line) {
    if (line == "#pragma once" || line == "#endif") return true;
    for (const std::string_view start : {"#include <tightrope/", "#error \"", "#if !defined(__FMA__)"}) {
      if (line.starts_with(start)) return true;
    }
    return false;
  };
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::size_t start = line.find_first_not_of(" \t");
    if (start == std::string::npos) continue;
    const std::string_view rest = std::string_view(line).substr(start);
    if ((rest[0] == '#' && !known(rest)) || rest.starts_with("%:") || line.back() == '\\') {
      return fmt::format("{}:{}: a preprocessor line that generated code does not have: `{}`", file_name, number, line);
    }
  }
  return {};
}

/// One predicate's specialisation.
class ClassValidator {
 public:
  ClassValidator(const clang::ASTContext& context, const AnalysedPredicate& analysed, BoundMode mode,
                 Precision precision, Form form, const clang::ClassTemplateSpecializationDecl* code)
      : subject_{context,
                 *analysed.predicate,
                 *analysed.bounded,
                 precision,
                 precision == Precision::binary64 ? context.DoubleTy : context.FloatTy,
                 input_arguments(*analysed.predicate)},
        mode_(mode),
        form_(form),
        code_(code) {}

  void run() {
    check_template_arguments();
    find_members();
    CanonicalGraph graph(subject_.bounded.graph, format(subject_.precision).significand_bits);
    std::map<const clang::ValueDecl*, dsl::NodeId> saved;
    const bool has_range = subject_.has_range();
    if (has_range && form_ == Form::scalar) {
      const clang::FunctionDecl* in_range = function("in_range", subject_.context.BoolTy, no_state);
      validate_in_range(subject_, in_range);
      for (std::size_t s = 0; s < subject_.results.size(); ++s) {
        const std::string& name = subject_.predicate.stages[s].name;
        validate_checked_stage(subject_, s, stage_function(name, s), in_range, stage_function(name + "_in_range", s));
      }
    }
    for (std::size_t s = 0; s < subject_.results.size(); ++s) {
      const std::string& name = subject_.predicate.stages[s].name;
      validate_stage(subject_, graph, s, stage_function(has_range ? name + "_in_range" : name, s), saved);
    }
    if (!functions_.empty()) mismatch(functions_.begin()->second, "a function that predicates do not have");
  }

 private:
  enum StateArgument { no_state, state, const_state };

  [[noreturn]] static void mismatch(const clang::Decl* where, std::string_view what) {
    const auto* named = dyn_cast<clang::NamedDecl>(where);
    throw Mismatch{where->getLocation(),
                   fmt::format("{}{}{}", named ? named->getNameAsString() : "", named ? ": " : "", what)};
  }

  bool is_real(clang::QualType type) const { return subject_.context.hasSameType(type, subject_.real); }

  /// Bounded<real>, without qualifiers.
  bool is_bounded(clang::QualType type) const {
    const auto* record =
        dyn_cast_or_null<clang::ClassTemplateSpecializationDecl>(type.getCanonicalType()->getAsCXXRecordDecl());
    return record != nullptr && !type.hasQualifiers() && record->getQualifiedNameAsString() == "tightrope::Bounded" &&
           in_runtime(record, subject_.context.getSourceManager()) && is_real(record->getTemplateArgs()[0].getAsType());
  }

  void check_template_arguments() const {
    const clang::TemplateArgumentList& arguments = code_->getTemplateArgs();
    const clang::CXXRecordDecl* tag = arguments.size() == 2 ? arguments[0].getAsType()->getAsCXXRecordDecl() : nullptr;
    if (tag == nullptr || tag->getQualifiedNameAsString() != tag_name(mode_) || !is_real(arguments[1].getAsType())) {
      mismatch(code_, "another bound mode or scalar type than was analysed");
    }
  }

  void find_members() {
    std::map<std::string, const clang::CXXRecordDecl*> records;
    for (const clang::Decl* member : code_->decls()) {
      if (member->isImplicit()) continue;
      if (const auto* record = dyn_cast<clang::CXXRecordDecl>(member)) {
        records[record->getNameAsString()] = record;
      } else if (const auto* method = dyn_cast<clang::CXXMethodDecl>(member)) {
        if (!functions_.emplace(method->getNameAsString(), method).second) mismatch(method, "a function twice");
      } else if (const auto* alias = dyn_cast<clang::TypeAliasDecl>(member)) {
        if (alias->getNameAsString() != "real" || !is_real(alias->getUnderlyingType())) mismatch(alias, "another type");
      } else {
        mismatch(member, "a member that predicates do not have");
      }
    }
    for (const dsl::Stage& stage : subject_.predicate.stages) {
      subject_.results.push_back(take(records, stage.name + "_result"));
      check_result(stage, subject_.results.back());
    }
    if (subject_.several_stages()) {
      subject_.state = take(records, "State");
      for (const clang::FieldDecl* field : members(subject_.state)) {
        if (!is_real(field->getType())) mismatch(field, "a member of State of another type");
      }
    }
    if (!records.empty()) mismatch(records.begin()->second, "a type that predicates do not have");
  }

  const clang::CXXRecordDecl* take(std::map<std::string, const clang::CXXRecordDecl*>& records,
                                   const std::string& name) const {
    const auto found = records.find(name);
    if (found == records.end()) mismatch(code_, fmt::format("no type {}", name));
    const clang::CXXRecordDecl* record = found->second;
    records.erase(found);
    return record;
  }

  /// The fields of a plain struct that holds nothing else.
  static std::vector<const clang::FieldDecl*> members(const clang::CXXRecordDecl* record) {
    if (!record->isCompleteDefinition() || record->isUnion() || record->getNumBases() > 0)
      mismatch(record, "no plain struct");
    std::vector<const clang::FieldDecl*> result;
    for (const clang::Decl* member : record->decls()) {
      if (member->isImplicit()) continue;
      const auto* field = dyn_cast<clang::FieldDecl>(member);
      if (field == nullptr || field->hasInClassInitializer() || field->isBitField())
        mismatch(member, "no plain member");
      result.push_back(field);
    }
    return result;
  }

  void check_result(const dsl::Stage& stage, const clang::CXXRecordDecl* record) const {
    const std::vector<const clang::FieldDecl*> fields = members(record);
    if (fields.size() != stage.outputs.size()) mismatch(record, "another number of outputs than were analysed");
    for (std::size_t o = 0; o < fields.size(); ++o) {
      clang::QualType type = fields[o]->getType();
      bool same = fields[o]->getNameAsString() == stage.outputs[o].name;
      for (const int extent : stage.outputs[o].extents) {
        const auto* array = subject_.context.getAsConstantArrayType(type);
        same = same && array != nullptr && array->getSize() == static_cast<std::uint64_t>(extent);
        if (!same) break;
        type = array->getElementType();
      }
      if (!same || !is_bounded(type)) mismatch(fields[o], "not the output that was analysed");
    }
  }

  const clang::FunctionDecl* stage_function(const std::string& name, std::size_t stage) {
    const bool last = stage + 1 == subject_.results.size();
    return function(name, subject_.context.getRecordType(subject_.results[stage]),
                    !subject_.several_stages() ? no_state
                    : last                     ? const_state
                                               : state);
  }

  /// The member function of this name with the published signature; the second call with one name finds it again.
  const clang::FunctionDecl* function(const std::string& name, clang::QualType result, StateArgument state_argument) {
    if (const auto known = checked_.find(name); known != checked_.end()) return known->second;
    const auto found = functions_.find(name);
    if (found == functions_.end()) mismatch(code_, fmt::format("no function {}", name));
    const clang::CXXMethodDecl* method = found->second;
    functions_.erase(found);
    checked_[name] = method;
    const std::size_t expected = subject_.arguments.size() + (state_argument == no_state ? 0 : 1);
    if (!method->isStatic() || !method->hasBody() || method->isVariadic() || method->getNumParams() != expected ||
        !subject_.context.hasSameType(method->getReturnType(), result)) {
      mismatch(method, "another signature than documented");
    }
    for (std::size_t i = 0; i < subject_.arguments.size(); ++i)
      check_argument(method->getParamDecl(static_cast<unsigned>(i)), subject_.arguments[i]);
    if (state_argument != no_state) check_state(method->getParamDecl(method->getNumParams() - 1), state_argument);
    return method;
  }

  void check_argument(const clang::ParmVarDecl* parameter, const InputArgument& argument) const {
    clang::QualType type = parameter->getType();
    if (argument.pointer) {
      type = type->isPointerType() && !type.isVolatileQualified() ? type->getPointeeType() : clang::QualType();
      if (type.isNull() || !type.isConstQualified()) mismatch(parameter, "not the argument that was analysed");
      type.removeLocalConst();
    }
    if (argument.bounded ? !is_bounded(type) : !is_real(type))
      mismatch(parameter, "not the argument that was analysed");
    if (parameter->hasDefaultArg()) mismatch(parameter, "an argument with a default");
  }

  void check_state(const clang::ParmVarDecl* parameter, StateArgument kind) const {
    const clang::QualType type = parameter->getType();
    const bool reference = type->isLValueReferenceType();
    const clang::QualType target = reference ? type->getPointeeType() : type;
    if (!reference || target->getAsCXXRecordDecl() != subject_.state ||
        target.isConstQualified() != (kind == const_state) || target.isVolatileQualified()) {
      mismatch(parameter, "not the State that was analysed");
    }
  }

  Subject subject_;
  BoundMode mode_;
  Form form_;
  const clang::ClassTemplateSpecializationDecl* code_;
  std::map<std::string, const clang::CXXMethodDecl*> functions_;  ///< not yet checked
  std::map<std::string, const clang::CXXMethodDecl*> checked_;
};

/// The declarations in namespace tightrope::generated of the text itself; anything outside is a mismatch.
std::vector<const clang::Decl*> generated_declarations(const clang::ASTContext& context) {
  std::vector<const clang::Decl*> result;
  const auto inside = [&](const clang::DeclContext* scope, std::string_view name) {
    std::vector<const clang::NamespaceDecl*> spaces;
    for (const clang::Decl* d : scope->decls()) {
      if (d->isImplicit() || d->getLocation().isInvalid() || in_runtime(d, context.getSourceManager())) continue;
      const auto* space = dyn_cast<clang::NamespaceDecl>(d);
      if (space == nullptr || space->isInline() || space->getNameAsString() != name) {
        throw Mismatch{d->getLocation(), "a declaration outside namespace tightrope::generated"};
      }
      spaces.push_back(space);
    }
    return spaces;
  };
  for (const clang::NamespaceDecl* outer : inside(context.getTranslationUnitDecl(), "tightrope")) {
    for (const clang::NamespaceDecl* inner : inside(outer, "generated")) {
      for (const clang::Decl* d : inner->decls()) {
        if (!d->isImplicit()) result.push_back(d);
      }
    }
  }
  return result;
}

void validate_unit(const clang::ASTContext& context, std::span<const AnalysedPredicate> predicates, BoundMode mode,
                   Precision precision, Form form) {
  std::size_t next = 0;
  for (const clang::Decl* d : generated_declarations(context)) {
    if (const auto* declared = dyn_cast<clang::ClassTemplateDecl>(d)) {
      const bool known = next < predicates.size() && declared->getNameAsString() == predicates[next].predicate->name;
      if (known && !declared->isThisDeclarationADefinition()) continue;
    } else if (const auto* code = dyn_cast<clang::ClassTemplateSpecializationDecl>(d)) {
      if (next < predicates.size() && code->getNameAsString() == predicates[next].predicate->name &&
          code->isExplicitSpecialization() && !clang::isa<clang::ClassTemplatePartialSpecializationDecl>(code)) {
        ClassValidator(context, predicates[next++], mode, precision, form, code).run();
        continue;
      }
    }
    throw Mismatch{d->getLocation(), "a declaration that is no analysed predicate, or not in its place"};
  }
  if (next < predicates.size()) {
    throw Mismatch{{}, fmt::format("predicate {} is missing", predicates[next].predicate->name)};
  }
}

}  // namespace

std::string validate(const std::string& text, const std::string& file_name,
                     std::span<const AnalysedPredicate> predicates, BoundMode mode, Precision precision, Form form) {
  if (std::string found = foreign_directive(text, file_name); !found.empty()) return found;
  const ParsedCode code = parse_generated(text, file_name);
  if (!code.errors.empty()) return fmt::format("{} is not accepted by the compiler:\n{}", file_name, code.errors);
  const clang::ASTContext& context = code.unit->getASTContext();
  try {
    validate_unit(context, predicates, mode, precision, form);
  } catch (const Mismatch& mismatch) {
    unsigned line = 0;
    if (mismatch.where.isValid()) line = context.getSourceManager().getPresumedLineNumber(mismatch.where);
    return fmt::format("{}:{}: {}", file_name, line, mismatch.what);
  }
  return {};
}

}  // namespace tightrope::codegen
