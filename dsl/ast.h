#pragma once
/// The abstract syntax tree: what the parser makes of the text, names unresolved, nothing typed.
///
/// Expressions live in one arena per module, operands before users, and the nodes of one expression are contiguous:
/// an analysis of an expression is one forward loop over [begin, end), never a recursion (comprehension bodies, which
/// are loops of the language itself, are the one exception and nest at most `max_nesting` deep).

#include <cstdint>
#include <string>
#include <vector>

#include "dsl/diagnostic.h"

namespace tightrope::dsl {

/// How deeply parentheses, brackets, calls, unary operators and blocks may nest.
inline constexpr int max_nesting = 200;

using ExprId = std::int32_t;
inline constexpr ExprId no_expr = -1;

enum class ExprKind : std::uint8_t {
  number,  ///< text = the literal
  name,    ///< text = the identifier
  negate,  ///< operands[0]
  add,     ///< operands[0], operands[1]
  subtract,
  multiply,
  divide,
  power,          ///< operands[0] ^ operands[1]
  call,           ///< text = the function's name; operands = the arguments
  index,          ///< operands[0] [ operands[1] ]
  component,      ///< operands[0] . text, text = x, y or z
  at,             ///< operands[0] at operands[1]: evaluation at a parameter value
  at_ratio,       ///< operands[0] at operands[1] / operands[2]: homogeneous evaluation, scaled by operands[2]^degree
  split_ratio,    ///< split(operands[0], operands[1] / operands[2]): homogeneous split
  array,          ///< [ operands... ]
  comprehension,  ///< [ body for text in operands[0] .. operands[1] ]; the body is [body_begin, body_end)
};

struct Expr {
  ExprKind kind = ExprKind::number;
  SourceSpan span;
  std::string text;
  std::vector<ExprId> operands;
  ExprId body_begin = no_expr;  ///< comprehension only; the body's root is body_end - 1. The body's nodes stand inside
  ExprId body_end = no_expr;  ///< the enclosing expression's range, before the comprehension node; a walker skips them.
};

/// An expression: nodes [begin, end) of `Module::exprs`, the root last. Empty (begin == end) after a syntax error.
struct ExprRange {
  ExprId begin = 0;
  ExprId end = 0;
  ExprId root() const { return end - 1; }
  bool empty() const { return begin == end; }
};

enum class StatementKind : std::uint8_t { let, sign, value, for_loop, stage };

struct Statement {
  StatementKind kind = StatementKind::let;
  SourceSpan span;
  std::string
      name;  ///< let: the name; for_loop: the variable; stage: its name; sign/value: the name after `as`, or empty
  SourceSpan name_span;
  ExprRange expr;         ///< let: the value; sign/value: what is output (one statement an expression of the list)
  ExprRange first, last;  ///< for_loop: `for name in first .. last`, last excluded
  std::vector<Statement> body;  ///< for_loop, stage
};

/// "bounded moving point p[2]": one declared parameter, of a predicate or (annotations optional) of a function.
struct ParameterDecl {
  std::string name;
  SourceSpan span;
  bool bounded = false;
  enum class Motion : std::uint8_t { unspecified, fixed, moving } motion = Motion::unspecified;
  enum class Kind : std::uint8_t { unspecified, scalar, vec2, vec3, point, point2 } kind = Kind::unspecified;
  std::vector<ExprRange> array;  ///< extents
};

/// `range |a, b| <= limit`
struct RangeDecl {
  SourceSpan span;
  std::vector<std::pair<std::string, SourceSpan>> names;
  ExprRange limit;
};

/// `group all` / `group axis, displacements` / `group (a, b), (c)`
struct GroupDecl {
  SourceSpan span;
  std::vector<std::pair<std::string, SourceSpan>> words;
  std::vector<std::vector<std::pair<std::string, SourceSpan>>> lists;  ///< parameter names
};

/// `normalize a, b`
struct NormalizeDecl {
  SourceSpan span;
  std::vector<std::pair<std::string, SourceSpan>> names;
};

/// `property antisymmetric(a, b) of Y, Z` / `property scale(3)` / `property translation_invariant`
struct PropertyDecl {
  SourceSpan span;
  std::string name;
  std::vector<std::pair<std::string, SourceSpan>> arguments;  ///< parameter names
  ExprRange number;                                           ///< scale's exponent
  std::vector<std::pair<std::string, SourceSpan>> outputs;    ///< after `of`; empty: all outputs
};

struct PredicateDecl {
  std::string name;
  SourceSpan name_span;
  std::string doc;  ///< the `//` comment lines directly above, without the slashes, joined by newlines
  std::vector<ParameterDecl> parameters;
  std::vector<RangeDecl> ranges;
  std::vector<GroupDecl> groups;
  std::vector<NormalizeDecl> normalizations;
  std::vector<PropertyDecl> properties;
  std::vector<Statement> body;
};

/// `function f(a, b) = expr`, or `function f(a, b) { let ... return expr }`
struct FunctionDecl {
  std::string name;
  SourceSpan name_span;
  std::vector<ParameterDecl> parameters;
  std::vector<Statement> body;  ///< lets and for loops of lets only
  ExprRange result;
};

/// `instance vertex_static_face = vertex_face(a, b, c: static)`
struct InstanceDecl {
  std::string name;
  SourceSpan name_span;
  std::string doc;
  std::string predicate;
  SourceSpan predicate_span;
  struct Change {
    std::string parameter;
    SourceSpan span;
    ParameterDecl::Motion motion;
  };
  std::vector<Change> changes;
};

struct ImportDecl {
  std::string path;
  SourceSpan span;
};

/// One parsed file.
struct Module {
  std::uint32_t file = 0;
  std::vector<Expr> exprs;
  std::vector<ImportDecl> imports;
  std::vector<FunctionDecl> functions;
  std::vector<PredicateDecl> predicates;
  std::vector<InstanceDecl> instances;
};

}  // namespace tightrope::dsl
