#pragma once
/// How many operations values and bounds take.

#include <string>
#include <vector>

#include "codegen/schedule.h"

namespace tightrope::codegen {

struct OperationCount {
  int sums = 0;         ///< add, sub
  int products = 0;     ///< mul
  int divisions = 0;    ///< div, sqrt
  int comparisons = 0;  ///< min, max, max_magnitude, select, certain_nonzero, certain_nonnegative
  int exact = 0;        ///< neg, abs, mul_pow2
  int total() const { return sums + products + divisions + comparisons + exact; }
  void add(dsl::Op op);
};

/// Operations that make the values, and those that are there for the bounds alone.
struct Cost {
  OperationCount value;
  OperationCount bound;
};

/// What each stage's function computes (nodes shared with an earlier stage are counted there).
std::vector<Cost> stage_costs(const BoundedPredicate& predicate, const Schedule& schedule);

/// What one output takes on its own.
Cost output_cost(const BoundedPredicate& predicate, const OutputBound& output);

/// "34 (14 sums, 18 products, 2 exact)"
std::string text(const OperationCount& count);

}  // namespace tightrope::codegen
