#pragma once
/// Rows of evaluations that were not run.

#include <random>
#include <vector>

#include "command/chart.h"

namespace tightrope::ccd {

inline EvaluationRow row_of(Method method, Kind kind, Precision precision, double nanoseconds,
                            std::uint64_t false_positives, std::uint64_t false_negatives) {
  return {.method = method,
          .kind = kind,
          .precision = precision,
          .queries = 3000,
          .answers_true = 500 + false_positives - false_negatives,
          .mistakes = Mistakes{500, false_positives, false_negatives},
          .uncertain = 12,
          .ns_per_query = nanoseconds,
          .time_ratio_to_tight = nanoseconds / 100};
}

/// Every method, kind and precision, with times and false positives drawn; methods without promise miss.
inline std::vector<EvaluationRow> random_rows(std::uint64_t seed, std::vector<Precision> precisions) {
  std::mt19937_64 random(seed);
  std::vector<EvaluationRow> rows;
  const std::uint64_t widest = 1 + random() % 900;
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    for (const Precision precision : precisions) {
      for (const MethodInfo& info : methods()) {
        const auto nanoseconds = static_cast<double>(50 + random() % widest);
        const std::uint64_t false_positives = info.exact ? 0 : random() % 3 * (random() % 50);
        rows.push_back(row_of(info.method, kind, precision, nanoseconds, false_positives,
                              info.conservative ? 0 : 1 + random() % 40));
      }
    }
  }
  return rows;
}

}  // namespace tightrope::ccd
