#pragma once
/// All schemes of a predicate, measured, and the front of the best ones.

#include <string>
#include <vector>

#include "codegen/explore/accuracy.h"
#include "codegen/explore/timing.h"

namespace tightrope::codegen::explore {

struct Entry {
  Candidate candidate;
  Accuracy accuracy = {};
  Time time = {};          ///< zeros if not timed
  bool dismissed = false;  ///< too many operations for what it is worth: not timed
  bool on_front = false;
};

struct Exploration {
  std::string predicate;
  std::vector<std::string> stages;  ///< those that a call evaluates
  Precision inputs = Precision::binary64;
  bool timed = false;
  std::string flags;  ///< of the compiler
  std::size_t rows = 0;
  std::size_t near_zero = 0;
  bool given_inputs = false;
  std::string reference;       ///< whose bounds are 1
  std::vector<Entry> entries;  ///< by rising cost

  /// What the front weighs against the size of the bound: nanoseconds, or operations if nothing was timed.
  double cost(const Entry& entry) const;
};

/// A scheme is dismissed if one with the same bound takes fewer operations by this factor, and is no worse in size of
/// bound and undecided signs. Fewer operations need not be faster: balanced sums have as many as others and wait less.
/// The factor leaves room for that. The default of each bound stays.
inline constexpr double dismissal_factor = 1.1;

struct ExplorationRequest {
  TimingRequest timing;
  bool time = true;
  bool all = false;  ///< dismiss none
};

/// Measures every candidate on `rows`. `error`: what kept schemes from being timed.
Exploration explore(const Lowerings& lowerings, const std::vector<Row>& rows, const ExplorationRequest& request,
                    std::string& error);

/// Whether the bounds are finite and decide anything at all near zero.
bool is_of_use(const Exploration& exploration, const Entry& entry);

/// Marks the entries that no other beats: cheaper without a larger bound, or a smaller bound at no higher cost. Schemes
/// without a bound, or with one that is of no use on these inputs, are never on the front; of equals the first is.
void mark_front(Exploration& exploration);

/// A table of them, and which are on the front.
std::string text(const Exploration& exploration);
std::string json(const Exploration& exploration);

}  // namespace tightrope::codegen::explore
