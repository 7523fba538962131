#pragma once
/// Bernstein sign classification of one query, one template over the bound mode (MATH 2, variant "M": the inside test
/// on projected quadratics, theorem 1.4). `false` is a proof that there is no contact in [0, 1]: every step either
/// rejects by definite signs or keeps a root.
///
/// Who includes this includes the generated headers of his bound mode first.

#include <array>
#include <cstddef>
#include <span>
#include <utility>

#include "ccd/geometry.h"
#include "ccd/roots.h"

namespace tightrope::generated {
template <class Bound, class Real>
struct vertex_face;
template <class Bound, class Real>
struct edge_edge;
template <class Bound, class Real>
struct differences;
template <class Bound, class Real>
struct split_cubic;
template <class Bound, class Real>
struct split_quadratic;
}  // namespace tightrope::generated

namespace tightrope::ccd {

/// Coefficients of the projected quadratics, [axis][function][coefficient]. Functions: 3 (vertex-face) or 4
/// (edge-edge), in each axis without opposite signs at a contact.
template <class Real, std::size_t Functions>
using Quadratics = std::array<std::array<std::array<Bounded<Real>, 3>, Functions>, 3>;

/// Puts one vector-valued quadratic of a generated predicate, [coefficient][axis], into its place.
template <class Real, std::size_t Functions>
TIGHTROPE_HOST_DEVICE void place(Quadratics<Real, Functions>& z, std::size_t function, const Bounded<Real> (&m)[3][3]) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < 3; ++i) z[axis][function][i] = m[i][axis];
  }
}

/// Signs that the quadratics have on all of [0, 1], [axis][function].
template <std::size_t Functions>
using HullSigns = std::array<std::array<Sign, Functions>, 3>;

template <class Signs, class Real, std::size_t Functions>
TIGHTROPE_HOST_DEVICE HullSigns<Functions> hull_signs(const Quadratics<Real, Functions>& z, Signs& signs) {
  HullSigns<Functions> result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t f = 0; f < Functions; ++f) {
      const auto& j = z[axis][f];
      const std::array<Sign, 3> each{signs(j[0]), signs(j[1]), signs(j[2])};
      result[axis][f] = common(each);
    }
  }
  return result;
}

/// Do two of the signs contradict each other: no contact (MATH 1.4 a)?
template <std::size_t N>
constexpr bool any_opposite(const std::array<Sign, N>& s) {
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = i + 1; j < N; ++j) {
      if (opposite(s[i], s[j])) return true;
    }
  }
  return false;
}

/// The inside test at the possible roots of a piece: removes those at which in some axis two functions have opposite
/// signs. True if none is left. `hulls`: signs that the functions are known to have on the whole piece.
template <class Bound, class Real, class Signs, std::size_t Functions>
TIGHTROPE_HOST_DEVICE bool reject_roots(Piece<Real>& piece, Quadratics<Real, Functions>& z,
                                        const HullSigns<Functions>& hulls, Signs& signs) {
  for (std::size_t axis = 0; axis < 3 && piece.any(); ++axis) {
    if (any_opposite(hulls[axis])) return true;
    std::array<Sign, Functions> first = hulls[axis];
    std::array<Sign, Functions> second = hulls[axis];
    for (std::size_t f = 0; f < Functions && piece.any(); ++f) {
      if (hulls[axis][f] != Sign::uncertain || !rescale(z[axis][f])) continue;
      const Branches<Sign> at_roots = quadratic_signs<Bound>(piece, z[axis][f], signs);
      first[f] = at_roots.first;
      second[f] = at_roots.second;
      piece.possible.first &= !any_opposite(first);
      piece.possible.second &= !any_opposite(second);
    }
  }
  return !piece.any();
}

/// One of the two parts of [0, 1] at an inflection: classification, then inside test. True if it holds no contact.
template <class Bound, class Real, class Signs, std::size_t Functions>
TIGHTROPE_HOST_DEVICE bool reject_part(const Bounded<Real> (&k)[4], const Bounded<Real> (&q)[3], Sign bend,
                                       Quadratics<Real, Functions>& z, Signs& signs) {
  Piece<Real> piece;
  const std::array<Sign, 4> k_signs = read_all(signs, k);
  const std::array<Sign, 3> q_signs = read_all(signs, q);
  copy_numbers(k, 4, piece.k.data());
  copy_numbers(q, 3, piece.q.data());
  if (!rescale(piece.k) || !rescale(piece.q)) return false;
  classify_piece(piece, k_signs, q_signs, bend, true);
  if (piece.possible.first && piece.possible.second && misses_zero<Bound>(piece, k_signs, q_signs, signs)) return true;
  return reject_roots<Bound>(piece, z, hull_signs(z, signs), signs);
}

/// The quadratics on the part of [0, 1] before (after) t / (s + t).
template <class Bound, class Real, std::size_t Functions>
TIGHTROPE_HOST_DEVICE std::pair<Quadratics<Real, Functions>, Quadratics<Real, Functions>> split(
    Quadratics<Real, Functions>& z, const Bounded<Real>& s, const Bounded<Real>& t) {
  std::pair<Quadratics<Real, Functions>, Quadratics<Real, Functions>> parts;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t f = 0; f < Functions; ++f) {
      rescale(z[axis][f]);
      const auto part = generated::split_quadratic<Bound, Real>::evaluate_in_range(z[axis][f].data(), s, t);
      copy_numbers(part.before, 3, parts.first[axis][f].data());
      copy_numbers(part.after, 3, parts.second[axis][f].data());
    }
  }
  return parts;
}

/// Splits at the inflection, where Y'' = 0: Y' is exactly monotone on both sides of its exact parameter, and the two
/// parts cover [0, 1] wherever that lies (MATH 3.1). True if neither part holds a contact.
template <class Bound, class Real, class Signs, std::size_t Functions>
TIGHTROPE_HOST_DEVICE bool reject_parts(const Piece<Real>& whole, const Bounded<Real> (&c)[2], Sign fall,
                                        const std::array<Sign, 2>& bends, Quadratics<Real, Functions>& z,
                                        Signs& signs) {
  // The bend vanishes at c0 / (c0 - c1) = t / (s + t) with (s, t) = (-c1, c0) sg(c0 - c1), so that s + t > 0.
  Bounded<Real> weights[2] = {{-c[1].value, c[1].bound}, c[0]};
  if (fall == Sign::negative) {
    for (Bounded<Real>& weight : weights) weight.value = -weight.value;
  }
  if (!rescale(weights)) return false;
  const auto& [s, t] = weights;
  const auto cubic = generated::split_cubic<Bound, Real>::evaluate_in_range(whole.k.data(), whole.q.data(), s, t);
  auto parts = split<Bound>(z, s, t);
  return reject_part<Bound>(cubic.k_before, cubic.q_before, bends[0], parts.first, signs) &&
         reject_part<Bound>(cubic.k_after, cubic.q_after, bends[1], parts.second, signs);
}

/// The whole decision, given the coefficients k of the cubic and a function that computes the quadratics.
template <class Bound, class Real, class Signs, class ComputeQuadratics>
TIGHTROPE_HOST_DEVICE bool may_touch(const Bounded<Real> (&k)[4], Signs& signs,
                                     const ComputeQuadratics& compute_quadratics) {
  const std::array<Sign, 4> k_signs = read_all(signs, k);
  if (common(k_signs) != Sign::uncertain) return false;
  Piece<Real> whole;
  copy_numbers(k, 4, whole.k.data());
  if (!rescale(whole.k)) return true;
  const auto slopes = generated::differences<Bound, Real>::evaluate_in_range(whole.k.data());
  const std::array<Sign, 3> q_signs = read_all(signs, slopes.q);
  const std::array<Sign, 2> bends = read_all(signs, slopes.c);
  copy_numbers(slopes.q, 3, whole.q.data());
  if (!rescale(whole.q)) return true;
  classify_piece(whole, k_signs, q_signs, bends[0], common(bends) != Sign::uncertain);
  if (!whole.any()) return false;

  auto z = compute_quadratics();
  const auto hulls = hull_signs(z, signs);
  for (const auto& axis : hulls) {
    if (any_opposite(axis)) return false;
  }
  if (whole.course == Course::unknown) {
    const Sign fall = signs(slopes.fall);
    return fall == Sign::uncertain || !reject_parts<Bound>(whole, slopes.c, fall, bends, z, signs);
  }
  if (whole.possible.first && whole.possible.second && misses_zero<Bound>(whole, k_signs, q_signs, signs)) return false;
  return !reject_roots<Bound>(whole, z, hulls, signs);
}

/// Evaluates the polynomials of a vertex-face query (MATH 1.3) whose coordinates are of moderate size, `scaled` if they
/// come from `normalize`; `decide` gets the coefficients of the cubic and a function that computes the quadratics.
template <class Bound, class Real, class Decide>
TIGHTROPE_HOST_DEVICE bool with_vertex_face_polynomials(const Real* points, bool scaled, const Decide& decide) {
  using predicate = generated::vertex_face<Bound, Real>;
  const MovingPoint<Real> p = moving_point(points, 0);
  std::array<std::pair<Real, MovingPoint<Real>>, 3> face;  // nearest vertex first
  for (int i = 0; i < 3; ++i) {
    const MovingPoint<Real> vertex = moving_point(points, i + 1);
    face[static_cast<std::size_t>(i)] = {distance_estimate(p, vertex), vertex};
  }
  const auto order = [&](std::size_t i, std::size_t j) {
    if (face[j].first < face[i].first) std::swap(face[i], face[j]);
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  const MovingPoint<Real> a = face[0].second, b = face[1].second, c = face[2].second;
  typename predicate::State state;
  auto coplanarity = predicate::coplanarity_in_range(p.t0, p.t1, a.t0, a.t1, b.t0, b.t1, c.t0, c.t1, state);
  if (scaled) widen(std::span<Bounded<Real>>(coplanarity.k));
  return decide(coplanarity.k, [&] {
    const auto inside = predicate::inside_in_range(p.t0, p.t1, a.t0, a.t1, b.t0, b.t1, c.t0, c.t1, state);
    Quadratics<Real, 3> z;
    place(z, 0, inside.m_ab);
    place(z, 1, inside.m_bc);
    place(z, 2, inside.m_ca);
    if (scaled) widen(std::span<Bounded<Real>>(&z[0][0][0], 27));
    return z;
  });
}

/// Edge-edge, likewise.
template <class Bound, class Real, class Decide>
TIGHTROPE_HOST_DEVICE bool with_edge_edge_polynomials(const Real* points, bool scaled, const Decide& decide) {
  using predicate = generated::edge_edge<Bound, Real>;
  MovingPoint<Real> a = moving_point(points, 0), b = moving_point(points, 1);
  MovingPoint<Real> c = moving_point(points, 2), d = moving_point(points, 3);
  Real ac = distance_estimate(a, c), ad = distance_estimate(a, d);
  Real bc = distance_estimate(b, c), bd = distance_estimate(b, d);
  if (std::min(bc, bd) < std::min(ac, ad)) {
    std::swap(a, b);
    std::swap(ac, bc);
    std::swap(ad, bd);
  }
  if (ad < ac) {
    std::swap(c, d);
    std::swap(ac, ad);
    std::swap(bc, bd);
  }
  const MovingPoint<Real> near_b = bd < bc ? d : c, near_d = bd < ad ? b : a;
  typename predicate::State state;
  auto coplanarity = predicate::coplanarity_in_range(a.t0, a.t1, b.t0, b.t1, c.t0, c.t1, d.t0, d.t1, near_b.t0,
                                                     near_b.t1, near_d.t0, near_d.t1, state);
  if (scaled) widen(std::span<Bounded<Real>>(coplanarity.k));
  return decide(coplanarity.k, [&] {
    const auto inside = predicate::inside_in_range(a.t0, a.t1, b.t0, b.t1, c.t0, c.t1, d.t0, d.t1, near_b.t0, near_b.t1,
                                                   near_d.t0, near_d.t1, state);
    Quadratics<Real, 4> z;
    place(z, 0, inside.m_b);
    place(z, 1, inside.m_a);
    place(z, 2, inside.m_d);
    place(z, 3, inside.m_c);
    if (scaled) widen(std::span<Bounded<Real>>(&z[0][0][0], 36));
    return z;
  });
}

template <class Bound, class Real, class Decide>
TIGHTROPE_HOST_DEVICE bool with_polynomials(Kind kind, const Real* points, bool scaled, const Decide& decide) {
  switch (kind) {
    case Kind::vertex_face:
      return with_vertex_face_polynomials<Bound>(points, scaled, decide);
    case Kind::edge_edge:
      return with_edge_edge_polynomials<Bound>(points, scaled, decide);
  }
  return true;
}

template <class Bound, class Real, class Signs>
TIGHTROPE_HOST_DEVICE bool may_touch(Kind kind, const Real* points, bool scaled, Signs& signs) {
  return with_polynomials<Bound>(kind, points, scaled, [&](const auto& k, const auto& compute_quadratics) {
    return may_touch<Bound>(k, signs, compute_quadratics);
  });
}

/// The bound mode of the first look: SafeBound costs little more than the values, and nearly every query of a broad
/// phase ends there (MATH 8). What it cannot reject is looked at again, with the sharper bound and geometry.
template <class Bound>
struct FirstLook {
  using type = bound::safe;
};
template <>
struct FirstLook<bound::none> {
  using type = bound::none;
};

/// Are the four points never in one plane, by the signs of the cubic's coefficients (MATH 2.1, step 1)?
template <class Bound, class Real, class Signs>
TIGHTROPE_HOST_DEVICE bool never_coplanar(Kind kind, const Real* points, Signs& signs) {
  const MovingPoint<Real> a = moving_point(points, 0), b = moving_point(points, 1);
  const MovingPoint<Real> c = moving_point(points, 2), d = moving_point(points, 3);
  switch (kind) {
    case Kind::vertex_face: {
      using predicate = generated::vertex_face<Bound, Real>;
      typename predicate::State state;
      const auto result = predicate::coplanarity_in_range(a.t0, a.t1, b.t0, b.t1, c.t0, c.t1, d.t0, d.t1, state);
      return common(read_all(signs, result.k)) != Sign::uncertain;
    }
    case Kind::edge_edge: {
      using predicate = generated::edge_edge<Bound, Real>;
      typename predicate::State state;
      const auto result = predicate::coplanarity_in_range(a.t0, a.t1, b.t0, b.t1, c.t0, c.t1, d.t0, d.t1, c.t0, c.t1,
                                                          a.t0, a.t1, state);
      return common(read_all(signs, result.k)) != Sign::uncertain;
    }
  }
  return false;
}

/// Is one feature on one side of the other along a coordinate axis during the whole step (MATH 1.4 c)? Differences of
/// points are linear in t, so the ends of the step decide, and the sign of a rounded difference is exact.
template <class Real, class Signs>
TIGHTROPE_HOST_DEVICE bool separated(Kind kind, const Real* points, Signs& signs) {
  for (int axis = 0; axis < 3; ++axis) {
    std::array<Sign, 8> sides;
    std::size_t count = 0;
    for (const auto& [i, j] : pairs_of_features(kind)) {
      const MovingPoint<Real> x = moving_point(points, i), y = moving_point(points, j);
      sides[count++] = signs(Bounded<Real>{y.t0[axis] - x.t0[axis], 0});
      sides[count++] = signs(Bounded<Real>{y.t1[axis] - x.t1[axis], 0});
    }
    if (common(std::span<const Sign>(sides).first(count)) != Sign::uncertain) return true;
  }
  return false;
}

/// Is it clear at the first look that there is no contact?
template <class Bound, class Real, class Signs>
TIGHTROPE_HOST_DEVICE bool rejected_at_first_look(Kind kind, const Real* points, Signs& signs) {
  return has_moderate_coordinates(points) && never_coplanar<typename FirstLook<Bound>::type>(kind, points, signs);
}

/// All but the first look.
template <class Bound, class Real, class Signs>
TIGHTROPE_HOST_DEVICE bool collides_by_second_look(Kind kind, const Real* points, Signs& signs) {
  if (has_moderate_coordinates(points) && spread(points) >= least_spread<Real>) {
    return may_touch<Bound>(kind, points, false, signs) && !separated(kind, points, signs);
  }
  const NormalizedQuery<Real> query = normalize(points);
  switch (query.kind) {
    case NormalizedQuery<Real>::Kind::scaled:
      return may_touch<Bound>(kind, query.points.data(), true, signs) && !separated(kind, points, signs);
    case NormalizedQuery<Real>::Kind::not_finite:
    case NormalizedQuery<Real>::Kind::coincident:
      return true;
  }
  return true;
}

/// Any query: `points` holds 24 numbers. Not finite: true. Contact needs coplanar points, no contradiction among the
/// projected quadratics, and no separating axis (MATH 1.4); each is asked only where the ones before leave it open.
template <class Bound, class Real, class Signs>
TIGHTROPE_HOST_DEVICE bool collides(Kind kind, const Real* points, Signs& signs) {
  return !rejected_at_first_look<Bound>(kind, points, signs) && collides_by_second_look<Bound>(kind, points, signs);
}

}  // namespace tightrope::ccd
