#include "cgal_predicates.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <vector>

namespace tightrope::bench {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

struct CgalPoints::Points {
  std::vector<Kernel::Point_3> points;
};

CgalPoints::CgalPoints(const PointTuples& tuples) : points_(std::make_unique<Points>()) {
  for (std::size_t i = 0; i < tuples.coordinates.size(); i += 3) {
    const double* x = &tuples.coordinates[i];
    points_->points.emplace_back(x[0], x[1], x[2]);
  }
}

CgalPoints::~CgalPoints() = default;

int CgalPoints::orient3d() const {
  const auto& p = points_->points;
  int sum = 0;
  for (std::size_t i = 0; i + 3 < p.size(); i += 4) sum += CGAL::orientation(p[i], p[i + 1], p[i + 2], p[i + 3]);
  return sum;
}

int CgalPoints::insphere() const {
  const auto& p = points_->points;
  int sum = 0;
  for (std::size_t i = 0; i + 4 < p.size(); i += 5) {
    sum += CGAL::side_of_oriented_sphere(p[i], p[i + 1], p[i + 2], p[i + 3], p[i + 4]);
  }
  return sum;
}

}  // namespace tightrope::bench
