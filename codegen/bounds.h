#pragma once
/// Graph to graph with error bounds: the common shape of all bound modes.

#include <string>
#include <vector>

#include "dsl/program.h"

namespace tightrope::codegen {

/// How a generated predicate knows its signs. The first five give every value a bound (`add_bounds`); `exact` and
/// `staged` give four-valued signs of their own.
enum class BoundMode {
  none,      ///< no bounds
  safe,      ///< SafeBound: safe_bound.h
  tight,     ///< TightBound: tight_bound.h
  fixed,     ///< "static": from declared ranges alone, at compile time
  interval,  ///< interval arithmetic
  exact,     ///< exact arithmetic
  staged,    ///< `fixed` or `safe`, then `tight`, then `exact`, as far as needed
};
struct FloatFormat;  // codegen/precision.h
enum class Precision { binary64, binary32 };

const char* name(BoundMode mode);       ///< as the command line spells it: "float", "safe", "tight", "static" ...
const char* name(Precision precision);  ///< "double", "float"

/// Value and bound of one output element: |value - exact| <= bound, evaluated as floating point in the graph's order.
struct BoundedNode {
  dsl::NodeId value = dsl::no_node;
  dsl::NodeId bound = dsl::no_node;
};

/// What is known of an output at compile time (for headers and reports).
struct OutputBound {
  std::vector<BoundedNode> elements;  ///< as Output::nodes
  int roundings = 0;                  ///< safe: k; else 0
  std::string magnitude;              ///< safe: B as text, "6 b_x b_y b_z"; else empty
  std::string assumption;  ///< what the bound rests on beyond the model, e.g. the declared ranges; may be empty
  double constant = 0;     ///< static: the largest bound of the elements
};

struct BoundedStage {
  std::vector<OutputBound> outputs;  ///< as Stage::outputs
};

/// A predicate's graph with bounds. Input slots 0 .. n-1 are those of the predicate; slot n + i is the bound that comes
/// with bounded input i (n = Predicate::slots.size()).
struct BoundedPredicate {
  dsl::Graph graph;
  std::vector<BoundedStage> stages;
  bool recomputes = false;  ///< later stages compute anew what earlier ones have found: nothing is kept for them
};

/// Test hook: leaves one term out of every bound, to show that the tests notice.
enum class Weakening {
  none,
  drop_rounding_of_sums,         ///< u |a + b|
  drop_rounding_of_products,     ///< u |a b|
  drop_rounding_of_differences,  ///< u |x - y| of two inputs
  drop_first_factor_error,       ///< R_a |b|
  drop_second_factor_error,      ///< |a| R_b
  drop_operand_error_of_sums,    ///< R_b of a + b
  drop_division_rounding,        ///< u |a / c|
  drop_input_bound,              ///< the bound of a bounded input
  drop_underflow,                ///< every underflow term
  halve_unit_roundoff,           ///< u / 2 in place of u
  drop_product_of_errors,        ///< R_a R_b
  drop_dividend_error,           ///< R_a of a / b
  drop_divisor_error,            ///< R_b of a / b, in the numerator
  drop_divisor_margin,           ///< R_b of a / b, in the denominator
  drop_root_rounding,            ///< u |sqrt(a)|
  drop_radicand_error,           ///< R_a of sqrt(a)
  drop_fma_rounding,             ///< u |a b + c|
  drop_guards,                   ///< the tests of divisors and radicands
  drop_second_alternative,       ///< of the values that `either` selects from, what the first one's bound does not say
};

const char* name(Weakening weakening);  ///< as the enumerator; "" for a number that none of them has

/// Adds bounds to a predicate; errors (an operation without a bound in this mode, a constant that the precision does
/// not hold) go to `diagnostics` with the place of the output.
BoundedPredicate add_bounds(const dsl::Predicate& predicate, BoundMode mode, Precision precision,
                            dsl::Diagnostics& diagnostics, Weakening weakening = Weakening::none);

/// The same for any floating-point format (the tests have one with few enough numbers to try them all). `format` must
/// outlive the call only.
BoundedPredicate add_bounds(const dsl::Predicate& predicate, BoundMode mode, const FloatFormat& format,
                            dsl::Diagnostics& diagnostics, Weakening weakening = Weakening::none);

}  // namespace tightrope::codegen
