#pragma once
/// Single precision first, double where that leaves a sign open.

#include <optional>

#include "codegen/explore/candidate.h"

namespace tightrope::codegen::explore {

/// The filter: the predicate in single precision. Inputs of type float it takes as they are. Inputs of type double are
/// rounded to float and come with their rounding error as a bound: x^ = fl32(x), |x^ - x|, which double arithmetic
/// gives exactly (no digit of x^ - x lies below the last of x nor above the first of x^ that was rounded), rounded
/// upwards. So numbers that are floats already are exact inputs. Declared ranges are those of the unrounded inputs: the
/// filter of rounded ones does without.
///
/// Sound by composition: the filter's bounds hold for its own inputs and their errors (MATH 4.3), and where all signs
/// of a stage are definite they are final; else the stage is that of double, whose bounds hold.
FloatFilter float_filter(const dsl::Predicate& predicate, BoundMode mode, Precision inputs,
                         dsl::Diagnostics& diagnostics);

/// The float nearest to x and a bound of its distance from x; an infinite bound where x is no float's neighbour.
struct RoundedInput {
  float value;
  float bound;
};
RoundedInput rounded_input(double x);

/// Whether a predicate can have such a filter: none of its inputs comes with an error of its own, nor is any
/// normalized, by powers of two that would be others in single precision; and every stage has signs that say whether it
/// is settled.
bool admits_float_first(const dsl::Predicate& predicate);

/// The filter under the name NAME_filter, the predicate in double as NAME_in_double, and NAME itself with the interface
/// of docs/generated-code.md, which asks the one, then the other. In double every stage computes all it needs anew: it
/// is rarely asked.
std::string print_float_first(const Candidate& candidate, const std::string& name, Precision inputs);

/// The two that print_float_first prints, as predicates of their own names.
dsl::Predicate named_filter(const Candidate& candidate, const std::string& name);
dsl::Predicate named_in_double(const Candidate& candidate, const std::string& name);

}  // namespace tightrope::codegen::explore
