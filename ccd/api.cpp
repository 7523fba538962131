#include "ccd/geometry.h"
#include "ccd/query.h"
#include "tightrope/ccd.h"

namespace tightrope::ccd {
namespace {

template <class Real, class... Points>
std::array<Real, numbers_per_query> gather(const Points&... points) {
  std::array<Real, numbers_per_query> query;
  Real* next = query.data();
  ((next = std::copy_n(points.data(), 3, next)), ...);
  return query;
}

template <class Real>
using Decide = bool (*)(Kind, const Real*);
template <class Real>
using DecideAndCount = bool (*)(Kind, const Real*, CountingSignReader&);

/// Both forms of one method.
template <class Real>
struct Decision {
  Decide<Real> decide;
  DecideAndCount<Real> decide_and_count;
};

template <class Real>
Decision<Real> decision(Method method) {
  switch (method) {
    case Method::bsc_float:
      return {bsc_float_collides<Real>, bsc_float_collides<Real>};
    case Method::bsc_safe:
      return {bsc_safe_collides<Real>, bsc_safe_collides<Real>};
    case Method::tight:
      return {tight_collides<Real>, tight_collides<Real>};
    case Method::bsc_exact:
      return {bsc_exact_collides<Real>, bsc_exact_collides<Real>};
    case Method::safe:
      return {safe_collides<Real>, safe_collides<Real>};
    case Method::safe_tight:
      return {safe_tight_collides<Real>, safe_tight_collides<Real>};
    case Method::tightrope:
      return {tightrope_collides<Real>, tightrope_collides<Real>};
  }
  return {tight_collides<Real>, tight_collides<Real>};
}

template <class Real>
void decide_all(Kind kind, const Real* points, std::size_t count, unsigned char* results, Method method) {
  const Decide<Real> decide = decision<Real>(method).decide;
  for (std::size_t i = 0; i < count; ++i) results[i] = decide(kind, points + numbers_per_query * i) ? 1 : 0;
}

}  // namespace

template <class Real>
bool collides(Kind kind, const Real* points, Method method, SignCounts& counts) {
  CountingSignReader signs;
  const bool result = decision<Real>(method).decide_and_count(kind, points, signs);
  counts.read += signs.counts().read;
  counts.uncertain += signs.counts().uncertain;
  return result;
}
template bool collides(Kind, const double*, Method, SignCounts&);
template bool collides(Kind, const float*, Method, SignCounts&);

bool collides(Kind kind, const double* points, Method method) { return decision<double>(method).decide(kind, points); }
bool collides(Kind kind, const float* points, Method method) { return decision<float>(method).decide(kind, points); }

void collides(Kind kind, const double* points, std::size_t count, unsigned char* results, Method method) {
  decide_all(kind, points, count, results, method);
}
void collides(Kind kind, const float* points, std::size_t count, unsigned char* results, Method method) {
  decide_all(kind, points, count, results, method);
}

bool vertex_face_collides(const Eigen::Vector3d& v_t0, const Eigen::Vector3d& f0_t0, const Eigen::Vector3d& f1_t0,
                          const Eigen::Vector3d& f2_t0, const Eigen::Vector3d& v_t1, const Eigen::Vector3d& f0_t1,
                          const Eigen::Vector3d& f1_t1, const Eigen::Vector3d& f2_t1, Method method) {
  const auto query = gather<double>(v_t0, f0_t0, f1_t0, f2_t0, v_t1, f0_t1, f1_t1, f2_t1);
  return collides(Kind::vertex_face, query.data(), method);
}

bool vertex_face_collides(const Eigen::Vector3f& v_t0, const Eigen::Vector3f& f0_t0, const Eigen::Vector3f& f1_t0,
                          const Eigen::Vector3f& f2_t0, const Eigen::Vector3f& v_t1, const Eigen::Vector3f& f0_t1,
                          const Eigen::Vector3f& f1_t1, const Eigen::Vector3f& f2_t1, Method method) {
  const auto query = gather<float>(v_t0, f0_t0, f1_t0, f2_t0, v_t1, f0_t1, f1_t1, f2_t1);
  return collides(Kind::vertex_face, query.data(), method);
}

bool edge_edge_collides(const Eigen::Vector3d& ea0_t0, const Eigen::Vector3d& ea1_t0, const Eigen::Vector3d& eb0_t0,
                        const Eigen::Vector3d& eb1_t0, const Eigen::Vector3d& ea0_t1, const Eigen::Vector3d& ea1_t1,
                        const Eigen::Vector3d& eb0_t1, const Eigen::Vector3d& eb1_t1, Method method) {
  const auto query = gather<double>(ea0_t0, ea1_t0, eb0_t0, eb1_t0, ea0_t1, ea1_t1, eb0_t1, eb1_t1);
  return collides(Kind::edge_edge, query.data(), method);
}

bool edge_edge_collides(const Eigen::Vector3f& ea0_t0, const Eigen::Vector3f& ea1_t0, const Eigen::Vector3f& eb0_t0,
                        const Eigen::Vector3f& eb1_t0, const Eigen::Vector3f& ea0_t1, const Eigen::Vector3f& ea1_t1,
                        const Eigen::Vector3f& eb0_t1, const Eigen::Vector3f& eb1_t1, Method method) {
  const auto query = gather<float>(ea0_t0, ea1_t0, eb0_t0, eb1_t0, ea0_t1, ea1_t1, eb0_t1, eb1_t1);
  return collides(Kind::edge_edge, query.data(), method);
}

}  // namespace tightrope::ccd
