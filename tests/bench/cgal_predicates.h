#pragma once
/// The predicates of CGAL's Exact_predicates_inexact_constructions_kernel, for comparison. Behind an interface without
/// CGAL's headers, since these want compiler flags of their own.

#include <memory>

#include "points.h"

namespace tightrope::bench {

/// A copy of the tuples as CGAL's points.
class CgalPoints {
 public:
  explicit CgalPoints(const PointTuples& tuples);
  ~CgalPoints();

  /// The sum of the signs of all tuples.
  int orient3d() const;
  int insphere() const;

 private:
  struct Points;
  std::unique_ptr<Points> points_;
};

}  // namespace tightrope::bench
