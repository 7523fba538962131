#pragma once
/// Times of impact against the exact first time of contact.

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "query_io/query_block.h"
#include "tightrope/ccd.h"

namespace tightrope::ccd {

class TimeCheck {
 public:
  /// What the times promise: not after the first contact, and at most `tolerance` before it, or less than the distance
  /// of two doubles where that is more; 0 only where the contact is at 0 or before the smallest positive double.
  /// Contacts after `t_max` do not count.
  TimeCheck(double tolerance, double t_max) : tolerance_(tolerance), t_max_(t_max) {}

  /// time: what a method answers; none: no contact.
  void add(Kind kind, std::span<const double, coordinates_per_query> points, std::optional<double> time);

  struct Counts {
    std::uint64_t queries = 0;
    std::uint64_t contacts = 0;    ///< true ones
    std::uint64_t missed = 0;      ///< contacts without a time
    std::uint64_t false_ones = 0;  ///< times without a contact
    std::uint64_t late = 0;
    std::uint64_t early = 0;
    double largest_gap = 0;  ///< from a time to the contact
  };
  const Counts& counts() const { return counts_; }

 private:
  double tolerance_;
  double t_max_;
  Counts counts_;
};

/// One line for people.
std::string summary(const TimeCheck::Counts& counts, double tolerance);

}  // namespace tightrope::ccd
