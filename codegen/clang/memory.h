#pragma once
/// What the variables of an imported C++ function hold while it is followed.

#include <clang/AST/ASTContext.h>

#include <cstdint>
#include <string>
#include <vector>

#include "dsl/graph.h"

namespace tightrope::codegen {

/// Thrown at code that cannot become a predicate.
struct ImportError {
  clang::SourceLocation where;
  std::string what;
};

/// A cell of an object. Every scalar is one cell; arrays and structs are their members' cells in order.
struct Place {
  int object = -1;
  std::int64_t offset = 0;
  bool operator==(const Place&) const = default;
};

/// What one cell holds: a number of the graph, a whole number known at compile time, or where something stands.
struct Value {
  enum class Kind { none, number, integer, place };
  Kind kind = Kind::none;
  dsl::NodeId node = dsl::no_node;
  std::int64_t integer = 0;
  Place place;

  bool operator==(const Value&) const = default;
  static Value number(dsl::NodeId node) { return {Kind::number, node, 0, {}}; }
  static Value whole(std::int64_t integer) { return {Kind::integer, dsl::no_node, integer, {}}; }
  static Value pointer(Place place) { return {Kind::place, dsl::no_node, 0, place}; }
};

struct Object {
  std::string name;  ///< empty: nothing is named after it
  clang::QualType type;
  clang::QualType scalar;  ///< of a parameter's cells
  std::vector<Value> cells;
  int parameter = -1;               ///< its first value is an input of the imported function
  bool grows = false;               ///< behind a pointer: as many elements as are used
  std::vector<bool> read, written;  ///< of a parameter
};

/// Cells of a type; throws for what cannot be held.
std::int64_t cells_of(clang::QualType type, const clang::ASTContext& context, clang::SourceLocation where);

/// Cells before a member.
std::int64_t offset_of(const clang::FieldDecl* field, const clang::ASTContext& context, clang::SourceLocation where);

/// What tells a cell from the others of its object: "_x", "_2", "" if there is one only.
std::string cell_label(clang::QualType type, std::int64_t offset, const clang::ASTContext& context);

}  // namespace tightrope::codegen
