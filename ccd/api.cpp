#include "ccd/geometry.h"
#include "ccd/query.h"
#include "tightrope/ccd.h"

namespace tightrope::ccd {
namespace {

using Query = std::array<double, numbers_per_query>;

template <class... Points>
Query gather(const Points&... points) {
  Query query;
  double* next = query.data();
  ((next = std::copy_n(points.data(), 3, next)), ...);
  return query;
}

using Decide = bool (*)(Kind, const double*);

Decide decision(Method method) {
  switch (method) {
    case Method::bsc_float:
      return bsc_float_collides;
    case Method::bsc_safe:
      return bsc_safe_collides;
    case Method::tight:
      return tight_collides;
  }
  return tight_collides;
}

}  // namespace

bool collides(Kind kind, const double* points, Method method) { return decision(method)(kind, points); }

void collides(Kind kind, const double* points, std::size_t count, unsigned char* results, Method method) {
  const Decide decide = decision(method);
  for (std::size_t i = 0; i < count; ++i) results[i] = decide(kind, points + numbers_per_query * i) ? 1 : 0;
}

bool vertex_face(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& f0_t0, const Eigen::Vector3d& f1_t0,
                 const Eigen::Vector3d& f2_t0, const Eigen::Vector3d& v_t1, const Eigen::Vector3d& f0_t1,
                 const Eigen::Vector3d& f1_t1, const Eigen::Vector3d& f2_t1, Method method) {
  const Query query = gather(v_t0, f0_t0, f1_t0, f2_t0, v_t1, f0_t1, f1_t1, f2_t1);
  return collides(Kind::vertex_face, query.data(), method);
}

bool edge_edge(const Eigen::Vector3d& ea0_t0, const Eigen::Vector3d& ea1_t0, const Eigen::Vector3d& eb0_t0,
               const Eigen::Vector3d& eb1_t0, const Eigen::Vector3d& ea0_t1, const Eigen::Vector3d& ea1_t1,
               const Eigen::Vector3d& eb0_t1, const Eigen::Vector3d& eb1_t1, Method method) {
  const Query query = gather(ea0_t0, ea1_t0, eb0_t0, eb1_t0, ea0_t1, ea1_t1, eb0_t1, eb1_t1);
  return collides(Kind::edge_edge, query.data(), method);
}

}  // namespace tightrope::ccd
