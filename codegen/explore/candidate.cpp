#include "codegen/explore/candidate.h"

#include <fmt/format.h>
#include <tightrope/enclosure.h>

#include <algorithm>
#include <map>
#include <random>

#include "codegen/compile.h"
#include "codegen/explore/balance.h"
#include "codegen/explore/factor.h"
#include "codegen/explore/float_first.h"
#include "codegen/fuse.h"
#include "codegen/simplify.h"
#include "dsl/evaluate.h"

namespace tightrope::codegen::explore {
namespace {

constexpr int points_of_comparison = 4;

OperationCount plus(const OperationCount& a, const OperationCount& b) {
  return {a.sums + b.sums, a.products + b.products, a.divisions + b.divisions, a.comparisons + b.comparisons,
          a.exact + b.exact};
}

/// The code of a predicate as text: equal texts, equal code.
std::string code(const dsl::Predicate& predicate) {
  std::string text = print(predicate.graph);
  for (const dsl::Stage& stage : predicate.stages) {
    for (const dsl::Output& output : stage.outputs) {
      for (const dsl::NodeId id : output.nodes) text += fmt::format(" {}", id);
    }
  }
  return text;
}

dsl::Predicate value_graph(const Lowerings& lowerings, const Scheme& scheme) {
  const auto& lowered = lowerings.predicates[static_cast<int>(scheme.products)][static_cast<int>(scheme.evaluation)];
  dsl::Predicate result;
  switch (scheme.sums) {
    case Sums::written:
      result = simplify(lowered);
      break;
    case Sums::balanced:
      result = balance_sums(lowered);
      break;
    case Sums::factored:
      result = factor_sums(lowered);
      break;
  }
  return scheme.fma ? contract_products(result) : result;
}

/// Whether some stage takes over what an earlier one has found.
bool keeps_values(BoundedPredicate bounded) {
  bounded.recomputes = false;
  const std::vector<bool> saved = schedule(bounded).saved;
  return std::find(saved.begin(), saved.end(), true) != saved.end();
}

}  // namespace

OperationCount Candidate::values(std::size_t stage) const {
  OperationCount total;
  for (std::size_t s = 0; s <= stage; ++s) total = plus(total, costs[s].value);
  return total;
}

OperationCount Candidate::bounds(std::size_t stage) const {
  OperationCount total;
  for (std::size_t s = 0; s <= stage; ++s) total = plus(total, costs[s].bound);
  return total;
}

std::string load_lowerings(const std::string& file, const std::string& name, dsl::SourceMap& sources,
                           dsl::Diagnostics& diagnostics, Lowerings& lowerings, std::uint64_t& hash) {
  for (const auto products : {dsl::ProductScheme::direct, dsl::ProductScheme::karatsuba}) {
    for (const auto evaluation : {dsl::EvaluationScheme::horner, dsl::EvaluationScheme::de_casteljau}) {
      sources = dsl::SourceMap();
      dsl::Program program =
          dsl::load_program(file, sources, diagnostics, {.products = products, .evaluation = evaluation});
      if (diagnostics.has_errors()) return "";
      hash = source_hash(program, sources);
      std::string known;
      dsl::Predicate* found = nullptr;
      for (dsl::Predicate& predicate : program.predicates) {
        known += (known.empty() ? "" : ", ") + predicate.name;
        if (name.empty() ? program.predicates.size() == 1 : predicate.name == name) found = &predicate;
      }
      if (found == nullptr && name.empty()) return fmt::format("--predicate: choose one of {}: {}", file, known);
      if (found == nullptr) return fmt::format("--predicate: {} has no '{}' (it has {})", file, name, known);
      lowerings.predicates[static_cast<int>(products)][static_cast<int>(evaluation)] = std::move(*found);
    }
  }
  return "";
}

namespace {

/// The candidate with its bounds; nothing if the scheme is none for this predicate.
std::optional<Candidate> made(const Scheme& scheme, dsl::Predicate predicate, Precision inputs) {
  Candidate candidate;
  candidate.scheme = scheme;
  candidate.predicate = std::move(predicate);
  candidate.precision = scheme.float_first ? Precision::binary64 : inputs;
  if (scheme.float_first && !admits_float_first(candidate.predicate)) return std::nullopt;
  dsl::Diagnostics errors;
  candidate.bounded = add_bounds(candidate.predicate, scheme.bound, candidate.precision, errors);
  if (scheme.float_first) candidate.filter = float_filter(candidate.predicate, scheme.bound, inputs, errors);
  if (errors.has_errors()) return std::nullopt;
  candidate.bounded.recomputes = scheme.recomputes || scheme.float_first;
  const BoundedPredicate& first = candidate.filter ? candidate.filter->bounded : candidate.bounded;
  candidate.costs = stage_costs(first, schedule(first));
  return candidate;
}

}  // namespace

std::vector<Candidate> candidates(const Lowerings& lowerings, Precision inputs) {
  std::vector<Candidate> result;
  std::map<std::string, std::size_t> known;  // code to candidate
  for (const Scheme& scheme : all_schemes()) {
    dsl::Predicate predicate = value_graph(lowerings, scheme);
    const std::string identity =
        fmt::format("{} {}\n{}", codegen::name(scheme.bound), scheme.float_first, code(predicate));
    const auto same = known.find(identity + (scheme.recomputes ? "r" : ""));
    if (same != known.end()) {
      result[same->second].aliases.push_back(name(scheme));
      continue;
    }
    if (!equal_at_random_points(lowerings.written(), predicate, scheme.recomputes ? 0 : points_of_comparison)) {
      throw UnequalScheme(fmt::format("{} of `{}`", name(scheme), predicate.name));
    }
    std::optional<Candidate> candidate = made(scheme, std::move(predicate), inputs);
    if (!candidate) continue;
    if (scheme.recomputes && !keeps_values(candidate->bounded)) {  // asked of a graph that is known without it
      result[known.at(identity)].aliases.push_back(name(scheme));
      continue;
    }
    known.emplace(identity + (scheme.recomputes ? "r" : ""), result.size());
    result.push_back(std::move(*candidate));
  }
  return result;
}

bool equal_at_random_points(const dsl::Predicate& a, const dsl::Predicate& b, int points) {
  std::mt19937_64 random(1980);
  for (int point = 0; point < points; ++point) {
    std::vector<Enclosure> slots;
    for (std::size_t i = 0; i < 2 * a.slots.size(); ++i) {
      slots.emplace_back(i < a.slots.size() ? static_cast<double>(static_cast<int>(random() % (1 << 20)) - (1 << 19))
                                            : 0.0);
    }
    const auto of_a = dsl::evaluate<Enclosure>(a.graph, slots);
    const auto of_b = dsl::evaluate<Enclosure>(b.graph, slots);
    for (std::size_t s = 0; s < a.stages.size(); ++s) {
      for (std::size_t o = 0; o < a.stages[s].outputs.size(); ++o) {
        const auto& nodes = a.stages[s].outputs[o].nodes;
        for (std::size_t e = 0; e < nodes.size(); ++e) {
          const Enclosure& x = of_a[static_cast<std::size_t>(nodes[e])];
          const Enclosure& y = of_b[static_cast<std::size_t>(b.stages[s].outputs[o].nodes[e])];
          if (!x.is_number() || !y.is_number()) continue;
          const Enclosure difference = x - y;
          if (difference.lower().sign() > 0 || difference.upper().sign() < 0) return false;
        }
      }
    }
  }
  return true;
}

}  // namespace tightrope::codegen::explore
