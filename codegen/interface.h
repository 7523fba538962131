#pragma once
/// The C++ face of a predicate: what its arguments, results and numbers are called (docs/generated-code.md).

#include <string>
#include <string_view>
#include <vector>

#include "codegen/bounds.h"

namespace tightrope::codegen {

/// One C++ argument: a parameter, or a moving parameter at one of its two times.
struct Argument {
  std::string name;  ///< "p", "p_t0"; an underscore is appended where generated code uses the name itself
  int parameter = 0;
  bool bounded = false;    ///< of type Bounded<real>, not real
  bool pointer = false;    ///< an array of scalars, not one
  std::vector<int> slots;  ///< input slots in the order of the array
};

std::vector<Argument> arguments(const dsl::Predicate& predicate);

/// "p_t0[1]", "k[2].value" for every input slot, then "k[2].bound" for every slot's bound (empty if it has none).
std::vector<std::string> slot_expressions(const dsl::Predicate& predicate);

/// "bound::tight"
std::string_view tag(BoundMode mode);

/// A floating-point literal of exactly this value: "0x1.8p+1", with suffix f in single precision; infinities as the
/// compilers' built-ins. The precision must hold the value.
std::string literal(double value, Precision precision);

/// Text that may stand in a `//` comment: no line ends, no backslash at the end, no bidirectional controls.
std::string comment_text(std::string_view text);

/// "// ..." lines of at most 120 columns behind `indent`, with line ends; continued lines stand two further in.
std::string comment_lines(std::string_view indent, std::string_view text);

/// `head`, then the words separated by blanks, broken to lines of at most 120 columns that start below the first word.
std::string wrap(std::string_view head, const std::vector<std::string>& words);

/// The same for a `head` that ends in an open parenthesis: the words start on the line below, four further in than
/// `head`, if that takes fewer lines.
std::string wrap_call(std::string_view head, const std::vector<std::string>& words);

/// "[4][3]"
std::string extents_text(const std::vector<int>& extents);

/// "[2][0]": the subscripts of element `element` (row-major) of an array with these extents.
std::string subscripts(const std::vector<int>& extents, int element);

}  // namespace tightrope::codegen
