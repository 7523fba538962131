#include "codegen/clang/memory.h"

#include <clang/AST/DeclCXX.h>
#include <fmt/format.h>

namespace tightrope::codegen {

using clang::dyn_cast;

namespace {

const clang::RecordDecl* plain_record(clang::QualType type, clang::SourceLocation where) {
  const auto* record = type->getAs<clang::RecordType>();
  const clang::RecordDecl* definition = record == nullptr ? nullptr : record->getDecl()->getDefinition();
  const auto* cxx = dyn_cast_or_null<clang::CXXRecordDecl>(definition);
  if (definition == nullptr || definition->isUnion() || (cxx != nullptr && cxx->getNumBases() > 0)) {
    throw ImportError{where,
                      fmt::format("a variable of type `{}`: only numbers, arrays and plain structs of them can be "
                                  "followed",
                                  type.getAsString())};
  }
  if (cxx != nullptr && !cxx->hasTrivialDestructor()) {
    throw ImportError{where,
                      fmt::format("an object of type `{}`, whose destructor does something", type.getAsString())};
  }
  for (const clang::FieldDecl* field : definition->fields()) {
    if (field->isBitField()) throw ImportError{where, fmt::format("bit-fields, in type `{}`", type.getAsString())};
  }
  return definition;
}

}  // namespace

std::int64_t cells_of(clang::QualType type, const clang::ASTContext& context, clang::SourceLocation where) {
  type = type.getCanonicalType();
  if (type.isVolatileQualified()) throw ImportError{where, "a volatile object may change at any time"};
  if (const auto* array = context.getAsConstantArrayType(type)) {
    const auto extent = static_cast<std::int64_t>(array->getSize().getZExtValue());
    if (extent > 1'000'000) throw ImportError{where, "an array of more than a million elements"};
    return extent * cells_of(array->getElementType(), context, where);
  }
  if (type->isArithmeticType() || type->isPointerType() || type->isEnumeralType() || type->isReferenceType()) return 1;
  std::int64_t total = 0;
  for (const clang::FieldDecl* field : plain_record(type, where)->fields()) {
    total += cells_of(field->getType(), context, where);
  }
  return total;
}

std::string cell_label(clang::QualType type, std::int64_t offset, const clang::ASTContext& context) {
  if (type.isNull()) return fmt::format("_{}", offset);  // behind a pointer
  if (const auto* array = context.getAsConstantArrayType(type)) {
    const std::int64_t size = cells_of(array->getElementType(), context, {});
    return fmt::format("_{}", offset / size) + cell_label(array->getElementType(), offset % size, context);
  }
  const auto* record = type->getAs<clang::RecordType>();
  if (record == nullptr) return "";
  for (const clang::FieldDecl* field : record->getDecl()->getDefinition()->fields()) {
    const std::int64_t size = cells_of(field->getType(), context, {});
    if (offset < size) return "_" + field->getNameAsString() + cell_label(field->getType(), offset, context);
    offset -= size;
  }
  return "";
}

std::int64_t offset_of(const clang::FieldDecl* field, const clang::ASTContext& context, clang::SourceLocation where) {
  std::int64_t offset = 0;
  for (const clang::FieldDecl* earlier : field->getParent()->fields()) {
    if (earlier == field) break;
    offset += cells_of(earlier->getType(), context, where);
  }
  return offset;
}

}  // namespace tightrope::codegen
