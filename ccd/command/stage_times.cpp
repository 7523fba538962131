#include "command/stage_times.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <span>

#include "ccd/impact/query.h"
#include "command/progress.h"
#include "query_io/query_files.h"
#include "scenes/single_precision.h"
#include "tightrope/impact.h"

namespace tightrope::ccd {
namespace {

using Clock = std::chrono::steady_clock;

/// What one stage decided so far, of one kind.
struct Group {
  std::uint64_t queries = 0;
  double nanoseconds = 0;
};
using Groups = std::array<Group, stages_in_order.size()>;

/// Answers all queries; the sum of the answers, so that they are not optimised away.
template <class Real>
double answer_all(Kind kind, std::span<const Real> points, Question question) {
  const Pair pair = pair_of(kind);
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); i += coordinates_per_query) {
    switch (question) {
      case Question::whether:
        sum += collides(kind, &points[i], Method::tightrope) ? 1 : 0;
        break;
      case Question::when:
        if (const auto impact = first_impact(pair, &points[i])) sum += impact->time;
        break;
    }
  }
  return sum;
}

/// Nanoseconds of one pass over the queries: the median of several, each long enough for the clock.
template <class Real>
double pass_time(Kind kind, std::span<const Real> points, Question question) {
  constexpr double least_pass = 2e4, whole_time = 2e7;
  volatile double sink = 0;  // the answers are wanted
  const auto measured = [&](int repeats) {
    const auto begin = Clock::now();
    for (int i = 0; i < repeats; ++i) sink = sink + answer_all(kind, points, question);
    return std::chrono::duration<double, std::nano>(Clock::now() - begin).count() / repeats;
  };
  const double first = std::max(measured(1), 1.0);
  const int repeats = static_cast<int>(std::ceil(std::max(least_pass / first, 1.0)));
  const int passes = std::clamp(static_cast<int>(whole_time / (first * repeats)), 5, 101);
  std::vector<double> times;
  for (int pass = 0; pass < passes; ++pass) times.push_back(measured(repeats));
  const auto middle = times.begin() + passes / 2;
  std::nth_element(times.begin(), middle, times.end());
  return *middle;
}

template <class Real>
void add_block(Kind kind, std::span<const Real> points, Question question, Groups& groups) {
  std::array<std::vector<Real>, stages_in_order.size()> of_stage;
  for (std::size_t i = 0; i < points.size(); i += coordinates_per_query) {
    const std::span<const Real> query = points.subspan(i, coordinates_per_query);
    auto& group = of_stage[static_cast<std::size_t>(deciding_stage(kind, query.data(), question))];
    group.insert(group.end(), query.begin(), query.end());
  }
  for (std::size_t s = 0; s < groups.size(); ++s) {
    if (of_stage[s].empty()) continue;
    groups[s].queries += of_stage[s].size() / coordinates_per_query;
    groups[s].nanoseconds += pass_time<Real>(kind, of_stage[s], question);
  }
}

void add_rows(Kind kind, const Groups& groups, std::vector<StageRow>& rows) {
  double queries = 0, nanoseconds = 0;
  for (const Group& group : groups) {
    queries += static_cast<double>(group.queries);
    nanoseconds += group.nanoseconds;
  }
  if (queries == 0) return;
  for (std::size_t s = 0; s < groups.size(); ++s) {
    const double of_stage = static_cast<double>(groups[s].queries);
    rows.push_back({.kind = kind,
                    .stage = stages_in_order[s],
                    .queries = groups[s].queries,
                    .fraction = of_stage / queries,
                    .ns_per_query = of_stage > 0 ? groups[s].nanoseconds / of_stage : 0,
                    .time_share = groups[s].nanoseconds / nanoseconds});
  }
}

}  // namespace

std::string_view name(Stage stage) {
  switch (stage) {
    case Stage::first_look:
      return "first-look";
    case Stage::separation:
      return "separation";
    case Stage::hull:
      return "hull";
    case Stage::subdivision:
      return "subdivision";
    case Stage::exact:
      return "exact";
  }
  return {};
}

std::variant<std::vector<StageRow>, FileError> stage_times(const StagesRequest& request) {
  auto found = find_query_files(request.paths, request.kind);
  if (auto* wrong = std::get_if<FileError>(&found)) return *wrong;
  QueryStream stream(std::get<std::vector<QueryFile>>(std::move(found)));
  Progress progress("timing");
  std::array<Groups, 2> kinds{};
  QueryBlock block;
  std::uint64_t done = 0;
  while (true) {
    constexpr std::size_t queries_per_block = 65536;
    if (auto wrong = stream.next(queries_per_block, block)) return *wrong;
    if (block.size() == 0) break;
    Groups& groups = kinds[static_cast<std::size_t>(block.kind)];
    switch (request.precision) {
      case Precision::in_double:
        add_block<double>(block.kind, block.points, request.question, groups);
        break;
      case Precision::in_float:
        add_block<float>(block.kind, in_single_precision(block, false).points, request.question, groups);
        break;
    }
    done += block.size();
    progress.show(done);
  }
  std::vector<StageRow> rows;
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    add_rows(kind, kinds[static_cast<std::size_t>(kind)], rows);
  }
  return rows;
}

}  // namespace tightrope::ccd
