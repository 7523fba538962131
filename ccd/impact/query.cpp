/// Method `tightrope`: a filter in floating point, then exact arithmetic, so that the answer is exact; and the time of
/// impact by the same stages.

#include "edge_edge.safe.double.h"
#include "edge_edge.tight.double.h"
#include "separating_plane.safe.double.h"
#include "separating_plane.safe.float.h"
#include "subdivision.float.double.h"
#include "subdivision.tight.double.h"
#include "vertex_face.safe.double.h"
#include "vertex_face.tight.double.h"

// After the generated headers:
#include "ccd/impact/filter.h"
#include "ccd/impact/query.h"
#include "ccd/impact/weights.h"
#include "ccd/query.h"

namespace tightrope::ccd {
namespace {

template <class Real>
bool decide_after(const Filtered& f, Kind kind, const Real* points) {
  if (f.stage != Stage::exact) return f.finding.verdict == Verdict::contact;
  const auto& exact_points = in_double_precision(points);
  return !has_finite_coordinates(points) || exact_contact(pair_of(kind), exact_points.data());
}

template <class Real, class Signs>
bool decide(Kind kind, const Real* points, Signs& signs) {
  return decide_after(filtered(kind, points, Question::whether, 1, signs), kind, points);
}

/// The time of first contact; coordinates are finite.
std::optional<TimeBracket> first_contact(Kind kind, const double* points, const Filtered& f, double tolerance,
                                         double t_max) {
  switch (f.finding.verdict) {
    case Verdict::no_contact:
      return std::nullopt;
    case Verdict::contact: {
      const TimeBracket& time = f.finding.time;
      const bool fine = time.upper - time.lower <= tolerance && time.lower > 0;
      return fine ? time : sharpened(kind, points, time, tolerance);
    }
    case Verdict::open:
      return exact_first_contact(pair_of(kind), points, tolerance, t_max);
  }
  return TimeBracket{0, t_max};
}

}  // namespace

template <class Real>
bool tightrope_collides(Kind kind, const Real* points) {
  SignReader signs;
  return decide(kind, points, signs);
}
template <class Real>
bool tightrope_collides(Kind kind, const Real* points, CountingSignReader& signs) {
  return decide(kind, points, signs);
}
template bool tightrope_collides(Kind, const double*);
template bool tightrope_collides(Kind, const double*, CountingSignReader&);
template bool tightrope_collides(Kind, const float*);
template bool tightrope_collides(Kind, const float*, CountingSignReader&);

bool tightrope_collides_unseparated(Kind kind, const double* points) {
  SignReader signs;
  return decide_after(filtered_unseparated(kind, points, Question::whether, 1, signs), kind, points);
}

template <class Real>
Stage deciding_stage(Kind kind, const Real* points, Question question) {
  SignReader signs;
  return filtered(kind, points, question, 1, signs).stage;
}
template Stage deciding_stage(Kind, const double*, Question);
template Stage deciding_stage(Kind, const float*, Question);

template <class Real>
std::optional<Impact> first_touch(Kind kind, const Real* points, double tolerance, double t_max) {
  SignReader signs;
  const Filtered f = filtered(kind, points, Question::when, t_max, signs);
  if (f.stage != Stage::exact && f.finding.verdict == Verdict::no_contact) return std::nullopt;
  const auto& exact_points = in_double_precision(points);
  if (!has_finite_coordinates(points)) return Impact{0, weights_of_first_vertices(kind)};
  const auto time = first_contact(kind, exact_points.data(), f, tolerance, t_max);
  if (!time) return std::nullopt;
  return Impact{time->lower, contact_weights(kind, exact_points.data(), time->lower + (time->upper - time->lower) / 2)};
}
template std::optional<Impact> first_touch(Kind, const double*, double, double);
template std::optional<Impact> first_touch(Kind, const float*, double, double);

}  // namespace tightrope::ccd
