#pragma once
/// One function a method: decides the query of 24 coordinates at `points` (see ccd.h), Real being double or float. With
/// a reader the same decision, whose signs the reader counts.

#include "ccd/sign_reader.h"
#include "tightrope/method.h"

namespace tightrope::ccd {

template <class Real>
bool bsc_float_collides(Kind kind, const Real* points);
template <class Real>
bool bsc_float_collides(Kind kind, const Real* points, CountingSignReader& signs);
template <class Real>
bool bsc_safe_collides(Kind kind, const Real* points);
template <class Real>
bool bsc_safe_collides(Kind kind, const Real* points, CountingSignReader& signs);
template <class Real>
bool tight_collides(Kind kind, const Real* points);
template <class Real>
bool tight_collides(Kind kind, const Real* points, CountingSignReader& signs);
template <class Real>
bool safe_collides(Kind kind, const Real* points);
template <class Real>
bool safe_collides(Kind kind, const Real* points, CountingSignReader& signs);
template <class Real>
bool safe_tight_collides(Kind kind, const Real* points);
template <class Real>
bool safe_tight_collides(Kind kind, const Real* points, CountingSignReader& signs);

template <class Real>
bool tightrope_collides(Kind kind, const Real* points);
template <class Real>
bool tightrope_collides(Kind kind, const Real* points, CountingSignReader& signs);

template <class Real>
bool bsc_exact_collides(Kind kind, const Real* points);
template <class Real>
bool bsc_exact_collides(Kind kind, const Real* points, CountingSignReader& signs);

/// Adds to `counts` the signs that the method reads for this query; returns its answer.
template <class Real>
bool collides(Kind kind, const Real* points, Method method, SignCounts& counts);

}  // namespace tightrope::ccd
