#include "command/measurement.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "ccd/query.h"
#include "query_io/query_block.h"

namespace tightrope::ccd {
namespace {

using Clock = std::chrono::steady_clock;

/// Passes of methods over one batch.
template <class Real>
class Passes {
 public:
  Passes(const Queries<Real>& queries, const Execution& execution) : queries_(queries), execution_(execution) {}

  /// Nanoseconds of `repeats` passes over the queries.
  double time(Method method, int repeats, std::vector<unsigned char>& answers) {
    const auto begin = Clock::now();
    for (int i = 0; i < repeats; ++i) {
      const BatchStatus status = collides(queries_, answers.data(), method, execution_);
      if (status != BatchStatus::done) status_ = status;
    }
    return std::chrono::duration<double, std::nano>(Clock::now() - begin).count();
  }

  BatchStatus status() const { return status_; }  ///< of all passes so far

 private:
  const Queries<Real>& queries_;
  const Execution& execution_;
  BatchStatus status_ = BatchStatus::done;
};

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Nanoseconds of one pass of each method; `answers`: of each method, one byte a query.
template <class Real>
std::vector<double> times(Passes<Real>& run, std::span<const Tally> tallies,
                          std::vector<std::vector<unsigned char>>& answers) {
  constexpr double least_pass = 2e4;  // ns: far above the clock's resolution
  constexpr double whole_time = 2e7;  // ns a method, for small blocks
  std::vector<int> repeats;
  double slowest = 0;
  for (std::size_t m = 0; m < tallies.size(); ++m) {
    const double first = std::max(run.time(tallies[m].method, 1, answers[m]), 1.0);
    repeats.push_back(static_cast<int>(std::ceil(std::max(least_pass / first, 1.0))));
    slowest = std::max(slowest, first * repeats.back());
  }
  const int passes = std::clamp(static_cast<int>(whole_time / slowest), 5, 101);
  std::vector<std::vector<double>> measured(tallies.size());
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t m = 0; m < tallies.size(); ++m) {
      measured[m].push_back(run.time(tallies[m].method, repeats[m], answers[m]) / repeats[m]);
    }
  }
  std::vector<double> medians;
  for (std::vector<double>& values : measured) medians.push_back(median(values));
  return medians;
}

template <class Real>
std::uint64_t uncertain_signs(const Queries<Real>& queries, Method method) {
  SignCounts counts;
  for (std::size_t i = 0; i < queries.count; ++i) {
    collides(queries.kind, queries.points + coordinates_per_query * i, method, counts);
  }
  return counts.uncertain;
}

}  // namespace

template <class Real>
BatchStatus measure(const Queries<Real>& queries, std::span<const unsigned char> truths, const Execution& execution,
                    std::span<Tally> tallies) {
  if (queries.count == 0) return BatchStatus::done;
  std::vector<std::vector<unsigned char>> answers(tallies.size(), std::vector<unsigned char>(queries.count));
  Passes<Real> passes(queries, execution);
  const std::vector<double> nanoseconds = times(passes, tallies, answers);
  for (std::size_t m = 0; m < tallies.size(); ++m) {
    Tally& tally = tallies[m];
    tally.nanoseconds += nanoseconds[m];
    tally.uncertain += uncertain_signs(queries, tally.method);
    for (const unsigned char answer : answers[m]) tally.answers_true += answer;
    for (std::size_t i = 0; i < truths.size(); ++i) {
      tally.false_positives += answers[m][i] > truths[i] ? 1 : 0;
      tally.false_negatives += answers[m][i] < truths[i] ? 1 : 0;
    }
  }
  return passes.status();
}

template BatchStatus measure(const Queries<double>&, std::span<const unsigned char>, const Execution&,
                             std::span<Tally>);
template BatchStatus measure(const Queries<float>&, std::span<const unsigned char>, const Execution&, std::span<Tally>);

}  // namespace tightrope::ccd
