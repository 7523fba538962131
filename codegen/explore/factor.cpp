#include "codegen/explore/factor.h"

#include <map>

#include "codegen/explore/sums.h"

namespace tightrope::codegen::explore {
namespace {

using dsl::Graph;
using dsl::no_node;
using dsl::NodeId;

bool has_factor(const Graph& graph, const Term& term, NodeId factor) {
  return term.product && (graph[term.node].a == factor || graph[term.node].b == factor);
}

/// The factor of most products, or none that two of them share.
NodeId common_factor(const Graph& graph, const std::vector<Term>& terms) {
  std::map<NodeId, int> frequency;
  for (const Term& term : terms) {
    if (!term.product) continue;
    const dsl::Node& n = graph[term.node];
    ++frequency[n.a];
    if (n.b != n.a) ++frequency[n.b];
  }
  NodeId best = no_node;
  int most = 1;
  for (const auto& [factor, count] : frequency) {
    if (count > most) best = factor, most = count;
  }
  return best;
}

Term left_to_right(Graph& graph, const std::vector<Term>& terms) {
  Term total = terms.front();
  for (std::size_t i = 1; i < terms.size(); ++i) total = sum(graph, total, terms[i]);
  return total;
}

/// The terms with `factor` taken out of all that have it; what is left of them stands where the first of them stood.
std::vector<Term> taken_out(Graph& graph, const std::vector<Term>& terms, NodeId factor) {
  std::vector<Term> rest;
  std::vector<Term> cofactors;
  std::size_t place = 0;
  for (const Term& term : terms) {
    if (!has_factor(graph, term, factor)) {
      rest.push_back(term);
      continue;
    }
    if (cofactors.empty()) place = rest.size();
    const dsl::Node& n = graph[term.node];
    cofactors.push_back({n.a == factor ? n.b : n.a, term.negative});
  }
  const Term cofactor = left_to_right(graph, cofactors);
  const Term product = {graph.mul(factor, cofactor.node), cofactor.negative, true};
  rest.insert(rest.begin() + static_cast<std::ptrdiff_t>(place), product);
  return rest;
}

Term factored(Graph& graph, std::vector<Term> terms) {
  for (NodeId factor = common_factor(graph, terms); factor != no_node; factor = common_factor(graph, terms)) {
    terms = taken_out(graph, terms, factor);
  }
  return left_to_right(graph, terms);
}

}  // namespace

dsl::Predicate factor_sums(const dsl::Predicate& predicate) { return with_sums(predicate, factored); }

}  // namespace tightrope::codegen::explore
