#include "command/time_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "oracle/contact_time.h"

namespace tightrope::ccd {
namespace {

/// The first contact of a query, enclosed as finely as the comparisons need.
class FirstContact {
 public:
  FirstContact(Kind kind, std::span<const double, coordinates_per_query> points)
      : kind_(kind), points_(points), width_(mpq_class(1) >> 60), time_(oracle::first_contact(kind, points, width_)) {}

  bool exists() const { return time_.has_value(); }

  /// Is it before (-1), at (0) or after (1) the time x? An irrational one is at no rational x: the loop ends.
  int compare(const mpq_class& x) {
    while (time_->lower < x && x < time_->upper) {
      width_ *= width_;
      time_ = oracle::first_contact(kind_, points_, width_);
    }
    if (time_->lower == time_->upper) return cmp(time_->lower, x);
    return x <= time_->lower ? 1 : -1;
  }

  const mpq_class& upper() const { return time_->upper; }

 private:
  Kind kind_;
  std::span<const double, coordinates_per_query> points_;
  mpq_class width_;
  std::optional<oracle::TimeInterval> time_;
};

}  // namespace

void TimeCheck::add(Kind kind, std::span<const double, coordinates_per_query> points, std::optional<double> time) {
  ++counts_.queries;
  FirstContact contact(kind, points);
  const bool counts = contact.exists() && contact.compare(mpq_class(t_max_)) <= 0;
  counts_.contacts += counts ? 1 : 0;
  counts_.missed += counts && !time ? 1 : 0;
  counts_.false_ones += time && !counts ? 1 : 0;
  if (!counts || !time) return;
  const mpq_class answer(*time);
  const double next = std::nextafter(*time, std::numeric_limits<double>::infinity());
  const bool next_is_not_late = contact.compare(mpq_class(next)) >= 0;
  const bool within = *time > 0 && contact.compare(answer + mpq_class(tolerance_)) <= 0;
  counts_.late += contact.compare(answer) < 0 ? 1 : 0;
  counts_.early += next_is_not_late && !within ? 1 : 0;
  const mpq_class gap = contact.upper() - answer;
  counts_.largest_gap = std::max(counts_.largest_gap, gap.get_d());
}

std::string summary(const TimeCheck::Counts& counts, double tolerance) {
  return fmt::format(
      "{} queries, {} contacts: {} missed, {} false; {} times late, {} early by more than {}; largest gap {:.2g}",
      counts.queries, counts.contacts, counts.missed, counts.false_ones, counts.late, counts.early, tolerance,
      counts.largest_gap);
}

}  // namespace tightrope::ccd
