#pragma once
/// SafeCCD's decision of one query (MATH 7), sound without exceptions: an answer of `false` is a proof for every time.
///
/// After Huamin Wang, "Defending Continuous Collision Detection against Errors", 2014. The published method proves that
/// the times it computes are close to the exact ones, and accepts a contact in a neighbourhood of these. Where features
/// are collinear, coincident or of zero length its gates (|N| against tau, |x_ji|^2 against lambda^2) skip the very
/// test that would find the contact. Here a query is free of contact only if all of [0, 1] is proved to be:
///
/// 1. Culling: a direction in which one feature is beyond the other at t = 0 and at t = 1 separates them all the time,
///    since differences are linear in t. No gap is needed: the signs of differences are exact, of sums have bounds.
/// 2. Cubic solver (safe_cubic.h): intervals that hold all roots of F; elsewhere the points are not in one plane.
/// 3. In each of these, inside test and vertex-edge test in one: contact needs moments x_0i x x_ji = weight * normal
/// with
///    non-negative weights, so that no coordinate shows two of them with opposite signs (MATH 1.4 a). Unlike the
///    weights N . (x_0i x x_ji) this has degree 2 instead of 4 and holds, and decides, where the normal N vanishes.
/// 4. There, vertex-vertex test: what moments cannot tell apart lies on one line, and is apart in a coordinate or not
/// at
///    all (MATH 1.4 c).
/// 5. Where neither decides on a wide interval - F vanishes identically, the normal turns - the interval is halved;
/// what
///    is left when the budget is spent is a contact.
///
/// Who includes this includes the generated headers of its bound mode first.

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "ccd/geometry.h"
#include "ccd/methods/safe_cubic.h"
#include "ccd/methods/safe_culling.h"
#include "ccd/methods/safe_naming.h"
#include "ccd/methods/safe_vertex_edge.h"

namespace tightrope::generated {
template <class Bound, class Real>
struct vertex_face;
template <class Bound, class Real>
struct edge_edge;
template <class Bound, class Real>
struct safe_piece;
template <class Bound, class Real>
struct safe_diagonals;
template <class Bound, class Real>
struct safe_apart;
}  // namespace tightrope::generated

namespace tightrope::ccd::safe {

/// Quadratics in t, the coordinates of the features' moments: [axis][function], three functions (vertex-face: weights
/// of a, b, c) or four (edge-edge: of a, b, c, d).
template <class Real>
using Moments = std::array<std::array<std::array<Bounded<Real>, 3>, 4>, 3>;

template <class Bound, class Real, class Signs>
class Decision {
 public:
  /// `scaled`: the points come from `normalize`, which may have lost something.
  TIGHTROPE_HOST_DEVICE Decision(Kind kind, const Real* points, bool scaled, Signs& signs)
      : names_(kind, points), functions_(kind == Kind::vertex_face ? 3 : 4), scaled_(scaled), signs_(signs) {}

  /// The first part of the step that may hold a contact; none: no contact in [0, 1].
  TIGHTROPE_HOST_DEVICE std::optional<Interval<Real>> first_contact() {
    std::array<Bounded<Real>, 4> k = cubic();
    if (hull(k) != Sign::uncertain) return std::nullopt;
    compute_moments();
    if (moments_exclude() || diagonal_excludes()) return std::nullopt;
    if (!rescale(k)) return Interval<Real>{0, 1};
    const Cubic<Bound, Real> f(k);
    const Roots<Real> candidates = roots(f, signs_);
    if (candidates.count == 0) return std::nullopt;
    if (!rescale(std::span(&moments_[0][0][0], 36))) return candidates.at[0];
    for (std::size_t i = 0; i < candidates.count; ++i) {
      if (const auto contact = first_contact(f, candidates.at[i])) return contact;
    }
    return std::nullopt;
  }

  TIGHTROPE_HOST_DEVICE const Naming<Real>& names() const { return names_; }

  /// The moments on a part of the step; the middle coefficient of each is about its value in the middle.
  TIGHTROPE_HOST_DEVICE Moments<Real> moments_on(Interval<Real> part) const {
    Moments<Real> restricted_moments;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < 4; ++i) {
        restricted_moments[axis][i] = restricted<Bound>(moments_[axis][i], part.l, part.r);
      }
    }
    return restricted_moments;
  }

 private:
  template <std::size_t N>
  TIGHTROPE_HOST_DEVICE Sign hull(const std::array<Bounded<Real>, N>& c) const {
    Sign all = signs_(c[0]);
    for (std::size_t i = 1; i < N; ++i) all = common(all, signs_(c[i]));
    return all;
  }

  TIGHTROPE_HOST_DEVICE std::array<Bounded<Real>, 4> cubic() {
    const auto& [a, b, c, d] = names_.x;
    const auto finish = [&](auto& k) {
      if (scaled_) widen<Real>(k);
      return std::array<Bounded<Real>, 4>{k[0], k[1], k[2], k[3]};
    };
    if (functions_ == 3) {
      auto result = Face::coplanarity_in_range(a.t0, a.t1, b.t0, b.t1, c.t0, c.t1, d.t0, d.t1, face_);
      return finish(result.k);
    }
    auto result = Edges::coplanarity_in_range(a.t0, a.t1, b.t0, b.t1, c.t0, c.t1, d.t0, d.t1, names_.near_b.t0,
                                              names_.near_b.t1, names_.near_d.t0, names_.near_d.t1, edges_);
    return finish(result.k);
  }

  TIGHTROPE_HOST_DEVICE void place(std::size_t function, const Bounded<Real> (&m)[3][3]) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < 3; ++i) moments_[axis][function][i] = m[i][axis];
    }
  }

  TIGHTROPE_HOST_DEVICE void compute_moments() {
    const auto& [a, b, c, d] = names_.x;
    moments_ = {};
    if (functions_ == 3) {
      const auto m = Face::inside_in_range(a.t0, a.t1, b.t0, b.t1, c.t0, c.t1, d.t0, d.t1, face_);
      place(0, m.m_bc);
      place(1, m.m_ca);
      place(2, m.m_ab);
    } else {
      const auto m = Edges::inside_in_range(a.t0, a.t1, b.t0, b.t1, c.t0, c.t1, d.t0, d.t1, names_.near_b.t0,
                                            names_.near_b.t1, names_.near_d.t0, names_.near_d.t1, edges_);
      place(0, m.m_b);
      place(1, m.m_a);
      place(2, m.m_d);
      place(3, m.m_c);
    }
    if (scaled_) widen<Real>({&moments_[0][0][0], 36});
  }

  /// Step 3: do two moments contradict each other in a coordinate, by their signs on a part of the step?
  template <class SignOf>
  TIGHTROPE_HOST_DEVICE bool moments_exclude(const SignOf& sign_of) const {
    for (const auto& axis : moments_) {
      bool negative = false, positive = false;
      for (std::size_t i = 0; i < functions_; ++i) {
        const Sign s = sign_of(axis[i]);
        negative |= s == Sign::negative;
        positive |= s == Sign::positive;
      }
      if (negative && positive) return true;
    }
    return false;
  }
  TIGHTROPE_HOST_DEVICE bool moments_exclude() const {
    return moments_exclude([&](const std::array<Bounded<Real>, 3>& m) { return hull(m); });
  }
  TIGHTROPE_HOST_DEVICE bool moments_exclude(Interval<Real> part) const {
    return moments_exclude(
        [&](const std::array<Bounded<Real>, 3>& m) { return hull(restricted<Bound>(m, part.l, part.r)); });
  }

  /// Step 4: is one feature beyond the other in a coordinate all over the interval?
  TIGHTROPE_HOST_DEVICE bool coordinate_excludes(Interval<Real> part) const {
    const std::span<const PointPair> pairs = pairs_across(functions_ == 3 ? Kind::vertex_face : Kind::edge_edge);
    std::array<Sign, 3> sides{};
    for (const PointPair& pair : pairs) {
      const auto& p = names_.x[pair.first];
      const auto& q = names_.x[pair.second];
      auto d = generated::safe_apart<Bound, Real>::evaluate_in_range(p.t0, p.t1, q.t0, q.t1, part.l, part.r);
      if (scaled_) {
        widen<Real>(d.at_l);
        widen<Real>(d.at_r);
      }
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Sign side = common(signs_(d.at_l[axis]), signs_(d.at_r[axis]));
        sides[axis] = &pair == pairs.data() ? side : common(sides[axis], side);
      }
    }
    return sides[0] != Sign::uncertain || sides[1] != Sign::uncertain || sides[2] != Sign::uncertain;
  }

  /// Step 1, diagonals: does one of the directions x+-y, y+-z, z+-x separate the features all the time?
  TIGHTROPE_HOST_DEVICE bool diagonal_excludes() const {
    std::array<Sign, 6> sides{};
    const std::span<const PointPair> pairs = pairs_across(functions_ == 3 ? Kind::vertex_face : Kind::edge_edge);
    for (const PointPair& pair : pairs) {
      const MovingPoint<Real>& p = names_.x[pair.first];
      const MovingPoint<Real>& q = names_.x[pair.second];
      auto d = generated::safe_diagonals<Bound, Real>::evaluate_in_range(p.t0, p.t1, q.t0, q.t1);
      const std::array<Bounded<Real>*, 6> directions{d.xy, d.x_y, d.yz, d.y_z, d.zx, d.z_x};
      for (std::size_t i = 0; i < directions.size(); ++i) {
        Bounded<Real>* ends = directions[i];
        if (scaled_) widen<Real>(std::span(ends, 2));
        const Sign side = common(signs_(ends[0]), signs_(ends[1]));
        sides[i] = &pair == pairs.data() ? side : common(sides[i], side);
      }
    }
    bool separated = false;
    for (const Sign side : sides) separated |= side != Sign::uncertain;
    return separated;
  }

  TIGHTROPE_HOST_DEVICE bool cubic_excludes(const Cubic<Bound, Real>& f, Interval<Real> part) const {
    const auto piece = generated::safe_piece<Bound, Real>::evaluate_in_range(f.coefficients().data(), part.l, part.r);
    return hull(std::array<Bounded<Real>, 4>{piece.part[0], piece.part[1], piece.part[2], piece.part[3]}) !=
           Sign::uncertain;
  }

  /// Is the part free of contact by steps 2 to 4?
  TIGHTROPE_HOST_DEVICE bool excluded(const Cubic<Bound, Real>& f, Interval<Real> part) const {
    return moments_exclude(part) || coordinate_excludes(part) || cubic_excludes(f, part);
  }

  /// The first part of an interval of roots that may hold a contact.
  TIGHTROPE_HOST_DEVICE std::optional<Interval<Real>> first_contact(const Cubic<Bound, Real>& f, Interval<Real> roots) {
    if (moments_exclude(roots) || coordinate_excludes(roots)) return std::nullopt;
    if (roots.r - roots.l < narrow) return roots;
    Candidates<Real> candidates(roots);
    for (const auto& axis : moments_) {
      for (std::size_t i = 0; i < functions_; ++i) candidates.add_component(axis[i]);
    }
    for (const PointPair& pair : pairs_across(functions_ == 3 ? Kind::vertex_face : Kind::edge_edge)) {
      const auto& p = names_.x[pair.first];
      const auto& q = names_.x[pair.second];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        candidates.add_difference(q.t0[axis] - p.t0[axis], q.t1[axis] - p.t1[axis]);
      }
    }
    std::optional<Interval<Real>> found;
    candidates.any_part([&](Interval<Real> part) { return (found = first_open(f, part)).has_value(); });
    return found;
  }

  /// The first part of `whole`, halved as long as it is wide and the budget lasts, that is not excluded (step 5).
  TIGHTROPE_HOST_DEVICE std::optional<Interval<Real>> first_open(const Cubic<Bound, Real>& f, Interval<Real> whole) {
    std::array<Real, most_halved + 1> ends;  // of the part that is looked at, on top, and of those after it
    std::size_t waiting = 0;
    ends[waiting++] = whole.r;
    for (Real l = whole.l; waiting > 0;) {
      const Interval<Real> part{l, ends[waiting - 1]};
      if (excluded(f, part)) {
        l = part.r;
        --waiting;
        continue;
      }
      const Real middle = part.l + (part.r - part.l) / 2;
      if (part.r - part.l < narrow || budget_ <= 0 || middle <= part.l || middle >= part.r) return part;
      --budget_;
      ends[waiting++] = middle;
    }
    return std::nullopt;
  }

  /// Narrower parts are not halved: a contact in the limits of rounding.
  static constexpr Real narrow = sizeof(Real) == 8 ? Real(0x1p-26) : Real(0x1p-12);

  static constexpr int most_halved = 64;

  using Face = generated::vertex_face<Bound, Real>;
  using Edges = generated::edge_edge<Bound, Real>;
  Naming<Real> names_;
  std::size_t functions_;
  bool scaled_;
  Signs& signs_;
  int budget_ = most_halved;  ///< intervals that may be halved
  typename Face::State face_;
  typename Edges::State edges_;
  Moments<Real> moments_;
};

/// Steps before any root finding: is it clear that there is no contact?
template <class Real, class Signs>
TIGHTROPE_HOST_DEVICE bool culled(Kind kind, const Real* points, Signs& signs) {
  return has_moderate_coordinates(points) &&
         (safe::never_coplanar<bound::safe>(kind, points, signs) || separated_on_an_axis(kind, points, signs));
}

/// Calls `decide` with the points of a query that is not culled, as they are, or scaled where that is needed. Not
/// finite, or all points one all the time: `always`.
template <class Real, class Signs, class Result, class Decide>
TIGHTROPE_HOST_DEVICE Result unculled(Kind kind, const Real* points, Signs& signs, const Result& never,
                                      const Result& always, const Decide& decide) {
  if (has_moderate_coordinates(points) && spread(points) >= least_spread<Real>) return decide(points, false);
  const NormalizedQuery<Real> query = normalize(points);
  if (query.kind != NormalizedQuery<Real>::Kind::scaled) return always;
  if (separated_on_an_axis(kind, points, signs)) return never;
  return decide(query.points.data(), true);
}

/// All but the culling.
template <class Bound, class Real, class Signs>
TIGHTROPE_RARE bool may_touch(Kind kind, const Real* points, Signs& signs) {
  return unculled(kind, points, signs, false, true, [&](const Real* prepared, bool scaled) {
    return Decision<Bound, Real, Signs>(kind, prepared, scaled, signs).first_contact().has_value();
  });
}

template <class Bound, class Real, class Signs>
TIGHTROPE_HOST_DEVICE bool collides(Kind kind, const Real* points, Signs& signs) {
  return !culled(kind, points, signs) && may_touch<Bound>(kind, points, signs);
}

}  // namespace tightrope::ccd::safe
