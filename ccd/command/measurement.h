#pragma once
/// What methods answer on queries in memory, and how long they take.

#include <cstdint>
#include <span>

#include "tightrope/ccd.h"

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

/// Runs all methods over the queries in `points` (24 numbers each) and adds to their tallies. The time of a method is
/// the median of several passes; the methods take turns, so that a change of the machine's speed meets all of them.
/// Uncertain signs are counted in another pass, which is not timed. `truths`: one a query, or empty if not known.
template <class Real>
void measure(Kind kind, std::span<const Real> points, std::span<const unsigned char> truths, std::span<Tally> tallies);

}  // namespace tightrope::ccd
