#include "codegen/explore/exploration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "codegen/charts/pareto.h"

namespace tightrope::codegen::explore {
namespace {

bool is_default(const Scheme& scheme) { return scheme == Scheme{.bound = scheme.bound}; }

/// Whether `other` makes it pointless to time `entry`.
bool outdoes(const Entry& other, const Entry& entry, std::size_t stage) {
  return other.candidate.scheme.bound == entry.candidate.scheme.bound &&
         other.candidate.operations(stage) * dismissal_factor < entry.candidate.operations(stage) &&
         other.accuracy.size <= entry.accuracy.size && other.accuracy.undecided <= entry.accuracy.undecided;
}

/// Filters in single precision count operations of the filter alone: they are always timed.
void dismiss(std::vector<Entry>& entries, std::size_t stage) {
  for (Entry& entry : entries) {
    if (is_default(entry.candidate.scheme) || entry.candidate.filter) continue;
    entry.dismissed = std::any_of(entries.begin(), entries.end(), [&](const Entry& other) {
      return !other.candidate.filter && outdoes(other, entry, stage);
    });
  }
}

std::string time_entries(std::vector<Entry>& entries, const std::vector<Row>& rows, const TimingRequest& request) {
  std::vector<const Candidate*> timed;
  std::vector<Entry*> owners;
  for (Entry& entry : entries) {
    if (entry.dismissed) continue;
    timed.push_back(&entry.candidate);
    owners.push_back(&entry);
  }
  std::vector<Time> times;
  const std::string error = measure_times(timed, rows, request, times);
  for (std::size_t i = 0; error.empty() && i < times.size(); ++i) owners[i]->time = times[i];
  return error;
}

}  // namespace

double Exploration::cost(const Entry& entry) const {
  return timed ? entry.time.median : entry.candidate.operations(stages.size() - 1);
}

bool is_of_use(const Exploration& exploration, const Entry& entry) {
  return std::isfinite(entry.accuracy.size) && (exploration.near_zero == 0 || entry.accuracy.undecided < 1);
}

void mark_front(Exploration& exploration) {
  std::vector<Entry*> eligible;
  std::vector<charts::Cost> costs;
  for (Entry& entry : exploration.entries) {
    entry.on_front = false;
    const bool has_cost = !exploration.timed || entry.time.median > 0;
    // Operations of a filter say nothing of the cost of what it leaves open.
    const bool comparable = exploration.timed || !entry.candidate.filter;
    if (entry.candidate.scheme.bound == BoundMode::none || !entry.accuracy.sound || !has_cost || !comparable) continue;
    if (!is_of_use(exploration, entry)) continue;
    eligible.push_back(&entry);
    costs.push_back({exploration.cost(entry), entry.accuracy.size});
  }
  for (const std::size_t i : charts::pareto_front(costs)) eligible[i]->on_front = true;
}

Exploration explore(const Lowerings& lowerings, const std::vector<Row>& rows, const ExplorationRequest& request,
                    std::string& error) {
  const dsl::Predicate& written = lowerings.written();
  const std::size_t last_stage = request.timing.last_stage;
  Exploration result;
  result.predicate = written.name;
  for (std::size_t s = 0; s <= last_stage; ++s) result.stages.push_back(written.stages[s].name);
  result.inputs = request.timing.inputs;
  result.timed = request.time;
  result.flags = fmt::format("{}", fmt::join(request.timing.flags, " "));
  const Samples measured = samples(written, rows, request.timing.inputs, last_stage);
  result.rows = measured.rows.size();
  result.near_zero = measured.near_zero.size();
  for (Candidate& candidate : candidates(lowerings, request.timing.inputs)) {
    if (candidate.scheme.recomputes && last_stage == 0) continue;  // the first stage has nothing to recompute
    result.entries.push_back({.candidate = std::move(candidate)});
  }
  const Candidate& first = result.entries.front().candidate;
  result.reference = first.name();
  const auto reference = compute_all(first, measured.rows, last_stage);
  for (Entry& entry : result.entries) {
    entry.accuracy = measure_accuracy(entry.candidate, reference, measured, last_stage);
  }
  if (!request.all) dismiss(result.entries, last_stage);
  if (request.time) error = time_entries(result.entries, rows, request.timing);
  mark_front(result);
  std::stable_sort(result.entries.begin(), result.entries.end(), [&](const Entry& a, const Entry& b) {
    return a.dismissed != b.dismissed ? b.dismissed : result.cost(a) < result.cost(b);
  });
  return result;
}

}  // namespace tightrope::codegen::explore
