#pragma once
/// What the code that `tightrope-ccd fit` writes is made of: a first look cut down to a scene, and the full query
/// behind it. The look tests at run time what it takes for granted; queries that break it get the full query.
///
/// A model says what a look takes for granted:
///
///     struct Model {
///       using Real = double;                      // or float: of the coordinates
///       using Plane = generated::..;              // plane_of_face or plane_of_edges of a fit
///       using AtRest = generated::..;             // face_at_rest or edge_at_rest of a fit; void: not looked for
///       static constexpr Real range = 0x1p-6;     // as declared by these predicates; infinity: they declare none
///       static constexpr bool both_ends = false;  // try the plane at t = 1, too
///     };

#include <tightrope/sign.h>

#include <cstddef>
#include <limits>
#include <type_traits>

#include "tightrope/ccd.h"

namespace tightrope::ccd::fitted {

/// Does `holds` hold for all of the `count` numbers at `x` (and those at `y`)? Several at a time; `holds` takes and
/// gives vectors where the compiler has them, else single numbers. The last vector may overlap the one before.
template <class Real, class Holds>
TIGHTROPE_FUNCTION bool all_hold(const Real* x, const Real* y, std::size_t count, const Holds& holds) {
#if defined(__GNUC__)
  typedef Real Vector __attribute__((vector_size(16)));
  constexpr std::size_t lanes = sizeof(Vector) / sizeof(Real);
  const auto part = [&](std::size_t first) {
    Vector u;
    Vector v;
    __builtin_memcpy(&u, x + first, sizeof(u));
    __builtin_memcpy(&v, y + first, sizeof(v));
    return holds(u, v);
  };
  auto all = part(count - lanes);
  for (std::size_t i = 0; i + lanes < count; i += lanes) all &= part(i);
  bool result = true;
  for (std::size_t lane = 0; lane < lanes; ++lane) result &= all[lane] != 0;
  return result;
#else
  bool all = true;
  for (std::size_t i = 0; i < count; ++i) all &= holds(x[i], y[i]);
  return all;
#endif
}

/// Are the `count` >= 4 numbers at `x` at most `limit` in magnitude? False for NaN. Without branches.
template <class Real>
TIGHTROPE_FUNCTION bool within(const Real* x, std::size_t count, Real limit) {
  return all_hold(x, x, count, [limit](const auto& u, const auto&) { return (u <= limit) & (u >= -limit); });
}

/// Are the `count` >= 4 numbers at `x` the same at both ends of the step? False for NaN; 0 and -0 are one number.
template <class Real>
TIGHTROPE_FUNCTION bool at_rest(const Real* x, std::size_t count) {
  constexpr std::size_t numbers_per_end = 12;
  return all_hold(x, x + numbers_per_end, count, [](const auto& u, const auto& v) { return u == v; });
}

/// Do all sides have one strict sign? One branch: which of the signs it is cannot be foretold.
template <class Real, std::size_t N>
TIGHTROPE_FUNCTION bool on_one_side(const Bounded<Real>& near, const Bounded<Real> (&far)[N]) {
  int sum = static_cast<int>(sign(near));
  for (const Bounded<Real>& x : far) sum += static_cast<int>(sign(x));
  return sum * sum == static_cast<int>((N + 1) * (N + 1));
}

/// The same where all values are finite, as in a declared range: fewer operations.
template <class Real, std::size_t N>
TIGHTROPE_FUNCTION bool finite_on_one_side(const Bounded<Real>& near, const Bounded<Real> (&far)[N]) {
  Real low = near.value;
  Real high = near.value;
  Real bound = near.bound;
  for (const Bounded<Real>& x : far) {
    low = x.value < low ? x.value : low;
    high = x.value > high ? x.value : high;
    bound = x.bound > bound ? x.bound : bound;
  }
  return (low > -high ? low : -high) > bound;
}

/// Where the range has been tested, the function that does not test it again.
template <class Predicate, class... Points>
TIGHTROPE_FUNCTION bool one_side(const Points*... points) {
  if constexpr (requires { Predicate::evaluate_in_range(points...); }) {
    const auto sides = Predicate::evaluate_in_range(points...);
    return finite_on_one_side(sides.near, sides.far);
  } else {
    const auto sides = Predicate::evaluate(points...);
    return on_one_side(sides.near, sides.far);
  }
}

template <class Model>
constexpr bool has_range = Model::range < std::numeric_limits<typename Model::Real>::infinity();
template <class Model>
constexpr bool looks_for_rest = !std::is_void_v<typename Model::AtRest>;

/// The general look; x: the points at the end of the step that gives the plane, y: at the other.
template <class Plane, class Real>
TIGHTROPE_FUNCTION bool apart_by_plane(const Real* x, const Real* y) {
  return one_side<Plane>(x, x + 3, x + 6, x + 9, y, y + 3, y + 6, y + 9);
}

/// Is there a plane of fixed direction that separates the features all the time (MATH 3.4a)? True is a proof, for every
/// input: the range and the rest are tested here, and NaN and infinity have no sign or are out of range.
template <Kind kind, class Model>
TIGHTROPE_FUNCTION bool apart(const typename Model::Real* x) {
  constexpr auto range = Model::range;
  const auto* y = x + 12;
  const auto small = [&](const auto* numbers, std::size_t count) {
    if constexpr (has_range<Model>) return within(numbers, count, range);
    return true;
  };
  if constexpr (looks_for_rest<Model> && kind == Kind::vertex_face) {
    // The first 15 numbers are all there are.
    if (at_rest(x + 3, 9)) return small(x, 15) && one_side<typename Model::AtRest>(x, x + 3, x + 6, x + 9, y);
  }
  if constexpr (looks_for_rest<Model> && kind == Kind::edge_edge) {
    if (at_rest(x + 6, 6)) {
      if (small(x, 18) && one_side<typename Model::AtRest>(x, x + 3, x + 6, x + 9, y, y + 3)) return true;
      if constexpr (!Model::both_ends) return false;
    } else if (at_rest(x, 6)) {
      if (small(x, 24) && one_side<typename Model::AtRest>(x + 6, x + 9, x, x + 3, y + 6, y + 9)) return true;
      if constexpr (!Model::both_ends) return false;
    }
  }
  if (!small(x, 24)) return false;
  if (apart_by_plane<typename Model::Plane>(x, y)) return true;
  if constexpr (Model::both_ends) return apart_by_plane<typename Model::Plane>(y, x);
  return false;
}

/// The query: `points` as `collides` has them; `method` decides what the look leaves open.
template <Kind kind, class Model>
TIGHTROPE_FUNCTION bool contact(const typename Model::Real* points, Method method) {
  return !apart<kind, Model>(points) && collides(kind, points, method);
}

/// `count` queries, as `collides` has them.
template <Kind kind, class Model>
void contacts(const typename Model::Real* points, std::size_t count, unsigned char* results, Method method) {
  for (std::size_t i = 0; i < count; ++i) results[i] = contact<kind, Model>(points + 24 * i, method) ? 1 : 0;
}

}  // namespace tightrope::ccd::fitted
