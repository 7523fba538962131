/// The exact stage on queries that floating point does not decide: time of every query on its own, the least of several
/// runs; median, 99th percentile and greatest over the set. Sets: every degenerate family and, where they are, the
/// public benchmark's sample queries and the contacts in tests/data/hard. Run: exact_bench [FILTER [TOLERANCE]].

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <variant>
#include <vector>

#include "ccd/impact/exact_time.h"
#include "ccd/methods/bsc_exact.h"
#include "query_io/query_files.h"
#include "scenes/scene.h"

namespace {

using namespace tightrope::ccd;

constexpr std::size_t numbers_per_query = 24;

struct QuerySet {
  std::string name;
  Kind kind;
  std::vector<double> points;
};

/// Leaves those that the filter of `bsc-exact` does not decide.
void leave_undecided(QuerySet& set) {
  std::vector<double> left;
  for (auto p = set.points.begin(); p != set.points.end(); p += numbers_per_query) {
    if (!collides(set.kind, &*p, Method::tight) || exact::filtered_contact(set.kind, &*p)) continue;
    left.insert(left.end(), p, p + numbers_per_query);
  }
  set.points = std::move(left);
}

QuerySet read(const std::string& name, const std::string& path, Kind kind) {
  QuerySet set{name, kind, {}};
  const std::vector<std::string> paths{path};
  auto found = find_query_files(paths, kind);
  if (std::holds_alternative<FileError>(found)) return set;
  QueryStream stream(std::get<std::vector<QueryFile>>(found));
  QueryBlock block;
  while (!stream.next(1 << 16, block) && block.size() != 0) {
    set.points.insert(set.points.end(), block.points.begin(), block.points.end());
  }
  return set;
}

/// Those whose name contains `filter`, if there is one.
std::vector<QuerySet> all_sets(const char* filter) {
  const char* named = std::getenv("TIGHTROPE_SAMPLE_QUERIES");
  const std::string samples = named != nullptr ? named : TIGHTROPE_SOURCE_DIR "/../shared/data/sample-queries";
  const auto wanted = [&](std::string_view set) { return filter == nullptr || set.find(filter) != set.npos; };
  std::vector<QuerySet> sets;
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    if (wanted("samples")) sets.push_back(read("samples", samples, kind));
    if (wanted("hard")) sets.push_back(read("hard", TIGHTROPE_SOURCE_DIR "/tests/data/hard", kind));
    for (const SceneInfo& info : scenes()) {
      if (!wanted(info.name)) continue;
      QuerySet set{std::string(info.name), kind, std::vector<double>(numbers_per_query * 400)};
      generate(info.scene, kind, 400, 1)->fill(set.points);
      sets.push_back(std::move(set));
    }
  }
  for (QuerySet& set : sets) leave_undecided(set);
  std::erase_if(sets, [](const QuerySet& set) { return set.points.empty(); });
  return sets;
}

template <class Decide>
std::vector<double> nanoseconds(const QuerySet& set, const Decide& decide) {
  std::vector<double> times;
  for (auto p = set.points.begin(); p != set.points.end(); p += numbers_per_query) {
    double least = 1e300;
    for (int run = 0; run < 5; ++run) {
      const auto start = std::chrono::steady_clock::now();
      decide(&*p);
      const std::chrono::duration<double, std::nano> passed = std::chrono::steady_clock::now() - start;
      least = std::min(least, passed.count());
    }
    times.push_back(least);
  }
  std::sort(times.begin(), times.end());
  return times;
}

}  // namespace

int main(int argc, char** argv) {
  const double tolerance = argc > 2 ? std::atof(argv[2]) : 1e-6;
  std::vector<double> all;
  std::printf("%-20s %-12s %8s %10s %10s %10s   ns\n", "set", "kind", "queries", "median", "99 %", "greatest");
  const auto print = [](const char* set, std::string_view kind, const std::vector<double>& times) {
    std::printf("%-20s %-12s %8zu %10.0f %10.0f %10.0f\n", set, std::string(kind).c_str(), times.size(),
                times[times.size() / 2], times[times.size() * 99 / 100], times.back());
  };
  for (const QuerySet& set : all_sets(argc > 1 ? argv[1] : nullptr)) {
    const Pair pair = set.kind == Kind::vertex_face ? Pair::vertex_face : Pair::edge_edge;
    const auto times = nanoseconds(set, [&](const double* points) {
      volatile bool contact = exact_first_contact(pair, points, tolerance, 1).has_value();
      (void)contact;
    });
    print(set.name.c_str(), name(set.kind), times);
    all.insert(all.end(), times.begin(), times.end());
  }
  if (all.empty()) return 1;
  std::sort(all.begin(), all.end());
  print("all", "", all);
}
