#pragma once
/// What `either` leaves in a graph: selections (Op::select) between alternatives, and the sizes that decide them.

#include <vector>

#include "dsl/program.h"

namespace tightrope::codegen {

/// The nodes that outputs are computed from. Not: what is only needed to decide which alternative is taken, of which
/// the bounds of values know nothing.
std::vector<bool> value_nodes(const dsl::Predicate& predicate);

/// The predicate without selections: the first alternative each time, which is equal to the others. For exact
/// arithmetic, where no alternative is better than another. Simplified.
dsl::Predicate first_alternatives(const dsl::Predicate& predicate);

}  // namespace tightrope::codegen
