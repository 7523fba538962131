#include "codegen/clang/import_function.h"

#include <clang/AST/RecursiveASTVisitor.h>
#include <fmt/format.h>

#include <algorithm>

#include "codegen/clang/interpreter.h"
#include "codegen/clang/parse.h"

namespace tightrope::codegen {
namespace {

using clang::dyn_cast;

/// Functions of a name that have a body.
class Finder : public clang::RecursiveASTVisitor<Finder> {
 public:
  explicit Finder(std::string name) : name_(std::move(name)) {}
  bool shouldVisitTemplateInstantiations() const { return true; }
  bool VisitFunctionDecl(clang::FunctionDecl* f) {  // NOLINT: the name is Clang's
    if (f->getNameAsString() != name_ && f->getQualifiedNameAsString() != name_) return true;
    if (f->isThisDeclarationADefinition() && !f->isDependentContext()) found.push_back(f);
    if (f->isDependentContext()) templates.push_back(f);
    return true;
  }
  std::vector<const clang::FunctionDecl*> found, templates;

 private:
  std::string name_;
};

/// A parameter while the function is followed.
struct Source {
  const clang::ParmVarDecl* declaration = nullptr;
  Place place;                        ///< of its numbers
  std::vector<std::int64_t> extents;  ///< -1: as many as are used
  bool by_value = false;
};

/// The numbers that a type holds, as extents of an array of them; the type of one.
clang::QualType shape(clang::QualType type, const clang::ASTContext& context, std::vector<std::int64_t>& extents,
                      clang::SourceLocation where) {
  while (const auto* array = context.getAsConstantArrayType(type)) {
    extents.push_back(static_cast<std::int64_t>(array->getSize().getZExtValue()));
    type = array->getElementType();
  }
  const auto* record = type->getAs<clang::RecordType>();
  if (record == nullptr) return type;
  const std::int64_t cells = cells_of(type, context, where);
  clang::QualType scalar;
  for (const clang::FieldDecl* field : record->getDecl()->getDefinition()->fields()) {
    std::vector<std::int64_t> inner;
    const clang::QualType of_field = shape(field->getType(), context, inner, where).getUnqualifiedType();
    if (!scalar.isNull() && !context.hasSameType(scalar, of_field)) {
      throw ImportError{where, fmt::format("a struct of different types: `{}`", type.getAsString())};
    }
    scalar = of_field;
  }
  if (scalar.isNull()) throw ImportError{where, fmt::format("an empty struct: `{}`", type.getAsString())};
  if (cells > 1) extents.push_back(cells);
  return scalar;
}

class Importer {
 public:
  explicit Importer(const clang::ASTContext& context, const clang::FunctionDecl* function)
      : context_(context), function_(function), interpreter_(context) {}

  ImportedFunction run() {
    std::vector<Place> arguments;
    for (const clang::ParmVarDecl* p : function_->parameters()) arguments.push_back(add(p));
    const std::vector<Value> result = interpreter_.run(function_, arguments);
    ImportedFunction imported;
    imported.name = function_->getNameAsString();
    imported.precision = interpreter_.precision();
    const std::vector<int> first_slots = add_parameters(imported);
    add_graph(first_slots, imported);
    add_outputs(result, imported);
    return imported;
  }

 private:
  Place add(const clang::ParmVarDecl* p) {
    const clang::SourceLocation where = p->getLocation();
    Source source{p, {}, {}, false};
    clang::QualType type = p->getType();
    const bool pointer = type->isPointerType();
    const bool reference = type->isReferenceType();
    if (type->isRValueReferenceType()) throw ImportError{where, "a parameter that is an rvalue reference"};
    source.by_value = !pointer && !reference;
    // `double p[3]` says three, though C++ makes a pointer of it.
    if (pointer) {
      const auto* written = dyn_cast<clang::ConstantArrayType>(p->getOriginalType().getTypePtr());
      source.extents.push_back(written != nullptr ? static_cast<std::int64_t>(written->getSize().getZExtValue()) : -1);
    }
    if (pointer || reference) type = type->getPointeeType();
    if (type->isPointerType() || type->isVoidType() || type->isFunctionType()) {
      throw ImportError{where, fmt::format("a parameter of type `{}`", p->getType().getAsString())};
    }
    if (type.isVolatileQualified()) throw ImportError{where, "a volatile object may change at any time"};
    const clang::QualType scalar = shape(type, context_, source.extents, where);
    source.place = interpreter_.allocate(type, p->getNameAsString(), where);
    Object& object = interpreter_.object(source.place);
    object.parameter = static_cast<int>(sources_.size());
    object.scalar = scalar;
    if (pointer) {
      object.type = {};
      object.grows = source.extents.front() < 0;
      if (!object.grows) object.cells.resize(object.cells.size() * static_cast<std::size_t>(source.extents.front()));
    }
    object.read.resize(object.cells.size());
    object.written.resize(object.cells.size());
    sources_.push_back(source);
    if (!pointer) return source.place;
    const Place variable = interpreter_.allocate(p->getType(), "", where);
    interpreter_.object(variable).cells.front() = Value::pointer(source.place);
    return variable;
  }

  /// Those that are read, or come by value; the first slot of each, by its number in the C++ function.
  std::vector<int> add_parameters(ImportedFunction& imported) {
    std::vector<int> first_slots(sources_.size(), -1);
    int next = 0;
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      const Source& source = sources_[s];
      const Object& object = interpreter_.objects()[static_cast<std::size_t>(source.place.object)];
      std::int64_t used = 0;
      for (std::size_t i = 0; i < object.read.size(); ++i) {
        if (object.read[i]) used = static_cast<std::int64_t>(i) + 1;
      }
      const bool of_numbers = object.scalar->isRealFloatingType();
      const bool known = source.extents.empty() || source.extents.front() >= 0;
      const bool constant = source.by_value || source.declaration->getType()->getPointeeType().isConstQualified();
      if (used == 0 && !(of_numbers && known && constant)) continue;
      ImportedParameter parameter{source.declaration->getNameAsString(), {}, next};
      std::int64_t count = 1;
      for (std::size_t i = source.extents.size(); i-- > 0;) {
        const std::int64_t extent = source.extents[i] >= 0 ? source.extents[i] : (used + count - 1) / count;
        parameter.extents.insert(parameter.extents.begin(), static_cast<int>(extent));
        count *= extent;
      }
      first_slots[s] = next;
      next += static_cast<int>(count);
      imported.parameters.push_back(std::move(parameter));
    }
    return first_slots;
  }

  /// The interpreter's graph with the inputs numbered as the parameters are.
  void add_graph(const std::vector<int>& first_slots, ImportedFunction& imported) {
    const dsl::Graph& graph = interpreter_.graph();
    const auto at = [&](dsl::NodeId id) { return id == dsl::no_node ? id : image_[static_cast<std::size_t>(id)]; };
    for (dsl::NodeId id = 0; id < graph.size(); ++id) {
      dsl::Node node = graph[id];
      node.a = at(node.a), node.b = at(node.b), node.c = at(node.c);
      if (node.op == dsl::Op::input) {
        const auto& [parameter, cell] = interpreter_.inputs()[static_cast<std::size_t>(node.index)];
        node.index = first_slots[static_cast<std::size_t>(parameter)] + static_cast<std::int32_t>(cell);
      }
      image_.push_back(imported.graph.intern(node));
    }
    for (const auto& [node, name] : interpreter_.names()) imported.names.try_emplace(at(node), name);
    for (const auto& [node, order] : interpreter_.written_order()) {
      imported.written_order.try_emplace(at(node), at(order.first), at(order.second));
    }
  }

  void add_outputs(const std::vector<Value>& result, ImportedFunction& imported) {
    if (!result.empty()) {
      ImportedOutput output;
      output.array = function_->getReturnType()->isRecordType();
      for (std::size_t i = 0; i < result.size(); ++i) add_cell(result[i], static_cast<int>(i), output);
      imported.outputs.push_back(std::move(output));
    }
    for (const Source& source : sources_) {
      const Object& object = interpreter_.objects()[static_cast<std::size_t>(source.place.object)];
      if (source.by_value) continue;
      ImportedOutput output;
      output.name = source.declaration->getNameAsString();
      output.array = !source.extents.empty();
      for (std::size_t i = 0; i < object.written.size(); ++i) {
        if (object.written[i]) add_cell(object.cells[i], static_cast<int>(i), output);
      }
      if (!output.nodes.empty()) imported.outputs.push_back(std::move(output));
    }
    if (imported.outputs.empty())
      throw ImportError{function_->getLocation(), "the function returns nothing and sets nothing"};
  }

  void add_cell(const Value& value, int cell, ImportedOutput& output) {
    if (value.kind != Value::Kind::number) {
      throw ImportError{function_->getLocation(), "a result that is no number (return the number whose sign decides)"};
    }
    output.cells.push_back(cell);
    output.nodes.push_back(image_[static_cast<std::size_t>(value.node)]);
  }

  const clang::ASTContext& context_;
  const clang::FunctionDecl* function_;
  Interpreter interpreter_;
  std::vector<Source> sources_;
  std::vector<dsl::NodeId> image_;  ///< by node of the interpreter's graph
};

const clang::FunctionDecl* find_function(clang::ASTContext& context, const std::string& file, const std::string& name,
                                         std::string& errors) {
  Finder finder(name);
  finder.TraverseDecl(context.getTranslationUnitDecl());
  if (finder.found.size() == 1) return finder.found.front();
  if (finder.found.empty()) {
    errors = fmt::format("{}: error: no function `{}` with a body{}\n", file, name,
                         finder.templates.empty() ? "" : "; it is a template that nothing instantiates");
    return nullptr;
  }
  for (const clang::FunctionDecl* f : finder.found) {
    errors += error_at(context.getSourceManager(), f->getLocation(),
                       fmt::format("`{}` is one of {} functions of this name; give the qualified name of one that is "
                                   "not overloaded",
                                   f->getQualifiedNameAsString(), finder.found.size()));
  }
  return nullptr;
}

}  // namespace

std::optional<ImportedFunction> import_function(const std::string& file, const std::string& code,
                                                const std::string& function, const std::vector<std::string>& flags,
                                                std::string& errors) {
  const ParsedCode parsed = parse_file(code, file, flags);
  errors = parsed.errors;
  if (!errors.empty()) return std::nullopt;
  clang::ASTContext& context = parsed_context(parsed);
  const clang::FunctionDecl* found = find_function(context, file, function, errors);
  if (found == nullptr) return std::nullopt;
  try {
    return Importer(context, found).run();
  } catch (const ImportError& error) {
    errors = error_at(context.getSourceManager(), error.where, error.what);
    return std::nullopt;
  }
}

}  // namespace tightrope::codegen
