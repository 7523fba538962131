#include "codegen/explore/balance.h"

#include <span>

#include "codegen/explore/sums.h"

namespace tightrope::codegen::explore {
namespace {

/// Recursion as deep as the logarithm of the number of terms.
Term in_halves(dsl::Graph& graph, std::span<const Term> terms) {
  if (terms.size() == 1) return terms.front();
  const std::size_t half = (terms.size() + 1) / 2;
  const Term first = in_halves(graph, terms.first(half));
  return sum(graph, first, in_halves(graph, terms.subspan(half)));
}

}  // namespace

dsl::Predicate balance_sums(const dsl::Predicate& predicate) {
  return with_sums(predicate,
                   [](dsl::Graph& graph, const std::vector<Term>& terms) { return in_halves(graph, terms); });
}

}  // namespace tightrope::codegen::explore
