#pragma once
/// SafeCCD. Who includes this includes the generated headers of his bound mode first.

#include "ccd/gpu/stages.h"
#include "ccd/methods/safe_query.h"
#include "ccd/sign_reader.h"

namespace tightrope::ccd::gpu {

/// Culling; all the rest.
template <class Bound, class Real>
struct SafeStages {
  static constexpr int count = 2;

  template <int Stage>
  TIGHTROPE_HOST_DEVICE static Answer look(Kind kind, const Real* points) {
    SignReader signs;
    if constexpr (Stage == 0) {
      return apart_or(safe::culled(kind, points, signs), Answer::next);
    } else {
      return answer(safe::may_touch<Bound>(kind, points, signs));
    }
  }
};

template <class Real>
struct Stages<Method::safe, Real> : SafeStages<bound::safe, Real> {};
template <class Real>
struct Stages<Method::safe_tight, Real> : SafeStages<bound::tight, Real> {};

}  // namespace tightrope::ccd::gpu
