#include "ccd/geometry.h"
#include "ccd/query.h"
#include "tightrope/plain.h"

namespace tightrope::ccd {
namespace {

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

}  // namespace tightrope::ccd
