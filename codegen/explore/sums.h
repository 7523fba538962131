#pragma once
/// Sums as lists of terms: what the passes that associate sums anew have in common.

#include <functional>
#include <vector>

#include "dsl/program.h"

namespace tightrope::codegen::explore {

/// A summand with its sign.
struct Term {
  dsl::NodeId node = dsl::no_node;
  bool negative = false;
  bool product = false;  ///< a product that nothing but this sum uses
};

/// Makes a sum of two or more terms in the graph.
using Summation = std::function<Term(dsl::Graph&, std::vector<Term>)>;

/// The predicate, simplified, with every sum made anew by `summation` from its terms in the order written. A sum within
/// a sum is taken apart if nothing else uses it, else it is one term, so that common subexpressions stay common; the
/// difference of two inputs is one term, too: relative positions are what keeps rounding errors small.
///
/// No term is dropped, added or changed, so the exact value is the same; and every input still reaches every output
/// that depended on it, so non-finite inputs leave no sign.
dsl::Predicate with_sums(const dsl::Predicate& predicate, const Summation& summation);

/// The sum of two terms, in one operation.
Term sum(dsl::Graph& graph, const Term& a, const Term& b);

}  // namespace tightrope::codegen::explore
