#pragma once
/// Translation validation: what the C++ compiler will see is what was analysed.

#include <span>
#include <string>

#include "codegen/bounds.h"
#include "codegen/print_cpp.h"

namespace tightrope::codegen {

/// A predicate and the graph that its code must compute.
struct AnalysedPredicate {
  const dsl::Predicate* predicate = nullptr;
  const BoundedPredicate* bounded = nullptr;
};

/// Proves that the text of a generated header means the analysed graphs: parses it with Clang against the runtime's
/// headers and follows every function, statement by statement. Returns "" or what differs first, with its line
/// ("door.tight.double.h:123: ...").
///
/// What is proved, for every predicate and every stage, from the syntax tree alone (after macros, overload resolution
/// and implicit conversions):
///   * every `const real` local is an operation of the analysed graph on values already known, in the type `real`
///     throughout: operator, operands in order, callee (the runtime's own), literals exact and of the type;
///   * every element of every output is assigned exactly once, its value and its bound being the analysed nodes;
///   * State members are set once, to what later stages take them for;
///   * in_range tests exactly the declared ranges, and the checked functions answer `uncertain` where it says no;
///   * nothing else stands in the file: no other statement, member, declaration or preprocessor line.
///
/// The proof shares nothing with the printer but the two published contracts: docs/generated-code.md (names of
/// functions, order of arguments and elements) and the graph. Names of locals and the order of statements are free.
///
/// A header for lanes is read with one lane, where Lanes<double> is double (runtime/tightrope/lanes.h): the same
/// operations in the same order; what a vector class makes of each of them is its own affair.
std::string validate(const std::string& text, const std::string& file_name,
                     std::span<const AnalysedPredicate> predicates, BoundMode mode, Precision precision,
                     Form form = Form::scalar);

}  // namespace tightrope::codegen
