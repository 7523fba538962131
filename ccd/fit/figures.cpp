#include "fit/figures.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tightrope::ccd {
namespace {

constexpr std::size_t numbers_per_query = 24;
constexpr std::size_t numbers_per_end = 12;

int significant_bits(double x) {
  if (x == 0) return 0;
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);
  const auto integer = static_cast<std::int64_t>(std::ldexp(fraction, 53));
  return 53 - std::countr_zero(static_cast<std::uint64_t>(std::abs(integer)));
}

bool is_float(double x) {
  volatile float rounded = static_cast<float>(x);  // rounded here, whatever the compiler makes of the comparison
  return static_cast<double>(rounded) == x;
}

void add_query(SceneFigures& figures, Kind kind, const double* x) {
  ++figures.queries;
  if (!std::all_of(x, x + numbers_per_query, [](double c) { return std::isfinite(c); })) {
    ++figures.not_finite;
    return;
  }
  for (std::size_t i = 0; i < numbers_per_query; ++i) {
    const double size = std::abs(x[i]);
    figures.largest = std::max(figures.largest, size);
    if (size > 0 && (figures.smallest == 0 || size < figures.smallest)) figures.smallest = size;
    if (figures.bits < 53) figures.bits = std::max(figures.bits, significant_bits(x[i]));
  }
  for (std::size_t end = 0; end < numbers_per_query; end += numbers_per_end) {
    for (std::size_t i = 3; i < numbers_per_end; ++i) {
      for (std::size_t j = i % 3; j < i; j += 3) {
        figures.difference = std::max(figures.difference, std::abs(x[end + i] - x[end + j]));
      }
    }
  }
  for (std::size_t i = 0; i < numbers_per_end; ++i) {
    figures.displacement = std::max(figures.displacement, std::abs(x[i + numbers_per_end] - x[i]));
  }
  if (std::all_of(x, x + numbers_per_query, is_float)) ++figures.floats;
  const std::size_t first = kind == Kind::vertex_face ? 3 : 6;  // numbers of the first feature
  const bool first_rests = std::equal(x, x + first, x + numbers_per_end);
  const bool second_rests = std::equal(x + first, x + numbers_per_end, x + numbers_per_end + first);
  figures.first_at_rest += first_rests ? 1 : 0;
  figures.second_at_rest += second_rests ? 1 : 0;
  figures.either_at_rest += first_rests || second_rests ? 1 : 0;
}

}  // namespace

void add(SceneFigures& figures, Kind kind, std::span<const double> points) {
  for (std::size_t i = 0; i < points.size(); i += numbers_per_query) add_query(figures, kind, &points[i]);
}

void SceneSample::add(std::span<const double> points) {
  ccd::add(figures_, kind_, points);
  for (std::size_t i = 0; i < points.size(); i += numbers_per_query, ++seen_) {
    if (seen_ % stride_ != 0) continue;
    if (points_.size() == capacity_ * numbers_per_query) {  // every other one stays
      for (std::size_t kept = 0; 2 * kept < capacity_; ++kept) {
        std::copy_n(points_.begin() + static_cast<std::ptrdiff_t>(2 * kept * numbers_per_query), numbers_per_query,
                    points_.begin() + static_cast<std::ptrdiff_t>(kept * numbers_per_query));
      }
      points_.resize((capacity_ + 1) / 2 * numbers_per_query);
      stride_ *= 2;
      if (seen_ % stride_ != 0) continue;
    }
    points_.insert(points_.end(), points.begin() + static_cast<std::ptrdiff_t>(i),
                   points.begin() + static_cast<std::ptrdiff_t>(i + numbers_per_query));
  }
}

}  // namespace tightrope::ccd
