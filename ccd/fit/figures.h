#pragma once
/// What the queries of a scene are like, as far as a model of them depends on it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tightrope/ccd.h"

namespace tightrope::ccd {

/// Of the queries of one kind. Lengths are the largest of one coordinate.
struct SceneFigures {
  std::uint64_t queries = 0;
  std::uint64_t not_finite = 0;      ///< queries with a coordinate that is not finite; they count in nothing below
  double largest = 0;                ///< coordinate, in magnitude
  double smallest = 0;               ///< nonzero coordinate, in magnitude; 0: there is none
  double difference = 0;             ///< of two points of one query at one end of the step
  double displacement = 0;           ///< of a point over the step
  int bits = 0;                      ///< significant bits that the coordinates have at most
  std::uint64_t floats = 0;          ///< queries whose coordinates are all numbers of type float
  std::uint64_t first_at_rest = 0;   ///< queries whose vertex, or first edge, is the same at both ends of the step
  std::uint64_t second_at_rest = 0;  ///< the face, or the second edge
  std::uint64_t either_at_rest = 0;
};

/// Adds queries, 24 numbers each.
void add(SceneFigures& figures, Kind kind, std::span<const double> points);

/// Queries of one kind, spread evenly over all that are added, with the figures of all.
class SceneSample {
 public:
  SceneSample(Kind kind, std::size_t capacity) : kind_(kind), capacity_(capacity) {}

  void add(std::span<const double> points);

  Kind kind() const { return kind_; }
  const SceneFigures& figures() const { return figures_; }
  std::span<const double> points() const { return points_; }  ///< 24 a query, at most `capacity` queries

 private:
  Kind kind_;
  std::size_t capacity_;
  std::size_t stride_ = 1;  ///< every stride-th query is kept
  std::uint64_t seen_ = 0;
  std::vector<double> points_;
  SceneFigures figures_;
};

}  // namespace tightrope::ccd
