#pragma once
/// What methods answer on queries in memory, and how long they take.

#include <cstdint>
#include <span>

#include "command/device.h"
#include "tightrope/batch.h"

namespace tightrope::ccd {

/// One method's sums over blocks of queries.
struct Tally {
  Method method{};
  double nanoseconds = 0;
  std::uint64_t answers_true = 0;
  std::uint64_t false_positives = 0;
  std::uint64_t false_negatives = 0;
  std::uint64_t uncertain = 0;  ///< signs read that the method could not tell
};

/// Runs all methods over the queries as batches and adds to their tallies. The time of a method is the median of
/// several passes; the methods take turns, so that a change of the machine's speed meets all of them. Uncertain signs
/// are counted in another pass, one query after another, which is not timed. `truths`: one a query, or empty if not
/// known. After anything but `done` the tallies are worth nothing.
template <class Real>
[[nodiscard]] BatchStatus measure(const Queries<Real>& queries, std::span<const unsigned char> truths,
                                  const Execution& execution, std::span<Tally> tallies);

}  // namespace tightrope::ccd
