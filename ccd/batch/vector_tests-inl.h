/// The methods' tests on lanes, one query a lane: each tells of which lanes it proves that the method answers `false`.
///
/// The same predicates, the same order of operations and the same bounds as the functions for one query
/// (ccd/classification.h, ccd/impact/filter.h, ccd/methods/safe_query.h), on which the answers of methods that are not
/// exact depend. Included once for each instruction set, with the generated headers before it.

#if defined(TIGHTROPE_VECTOR_TESTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TIGHTROPE_VECTOR_TESTS_INL_H
#undef TIGHTROPE_VECTOR_TESTS_INL_H
#else
#define TIGHTROPE_VECTOR_TESTS_INL_H
#endif

namespace tightrope::TIGHTROPE_LANES {

using ccd::Kind;
using ccd::least_spread;
using ccd::power_of_two;

template <class Bound, class Real>
struct vertex_face;
template <class Bound, class Real>
struct edge_edge;
template <class Bound, class Real>
struct plane_of_face;
template <class Bound, class Real>
struct plane_of_edges;

template <class Real>
using Mask = hn::Mask<typename Lanes<Real>::Tag>;
template <class Real>
using BoundedLanes = Bounded<Lanes<Real>>;

/// The 24 coordinates of as many queries as there are lanes.
template <class Real>
struct Tile {
  Lanes<Real> x[24];  ///< points at t = 0, then at t = 1, three coordinates each

  /// Without a loop: g++ would leave it one, and the numbers in memory.
  HWY_INLINE Tile(const Real* numbers, std::size_t pitch) : Tile(numbers, pitch, std::make_index_sequence<24>()) {}
  HWY_INLINE const Lanes<Real>* t0(std::size_t point) const { return x + 3 * point; }
  HWY_INLINE const Lanes<Real>* t1(std::size_t point) const { return x + 12 + 3 * point; }

 private:
  template <std::size_t... C>
  HWY_INLINE Tile(const Real* numbers, std::size_t pitch, std::index_sequence<C...>)
      : x{Lanes<Real>::load(numbers + C * pitch)...} {}
};

/// A point that moves, in registers: names of points differ from lane to lane.
template <class Real>
struct MovingLanes {
  Lanes<Real> t0[3], t1[3];

  MovingLanes() = default;
  HWY_INLINE MovingLanes(const Tile<Real>& tile, std::size_t point) {
    for (std::size_t i = 0; i < 3; ++i) {
      t0[i] = tile.t0(point)[i];
      t1[i] = tile.t1(point)[i];
    }
  }
};

template <class Real>
HWY_INLINE Lanes<Real> selected(Mask<Real> mask, Lanes<Real> yes, Lanes<Real> no) {
  return hn::IfThenElse(mask, yes.v, no.v);
}

template <class Real>
HWY_INLINE MovingLanes<Real> selected(Mask<Real> mask, const MovingLanes<Real>& yes, const MovingLanes<Real>& no) {
  MovingLanes<Real> result;
  for (std::size_t i = 0; i < 3; ++i) {
    result.t0[i] = selected<Real>(mask, yes.t0[i], no.t0[i]);
    result.t1[i] = selected<Real>(mask, yes.t1[i], no.t1[i]);
  }
  return result;
}

template <class Real>
HWY_INLINE void swap_where(Mask<Real> mask, Lanes<Real>& a, Lanes<Real>& b) {
  const Lanes<Real> before = a;
  a = selected<Real>(mask, b, a);
  b = selected<Real>(mask, before, b);
}
template <class Real>
HWY_INLINE void swap_where(Mask<Real> mask, MovingLanes<Real>& a, MovingLanes<Real>& b) {
  const MovingLanes<Real> before = a;
  a = selected<Real>(mask, b, a);
  b = selected<Real>(mask, before, b);
}

/// Are all numbers certainly positive, or all certainly negative?
template <class Real, std::size_t N>
HWY_INLINE Mask<Real> have_one_sign(const BoundedLanes<Real> (&x)[N]) {
  auto positive = is_positive(x[0]), negative = is_negative(x[0]);
  for (std::size_t i = 1; i < N; ++i) {
    positive = hn::And(positive, is_positive(x[i]));
    negative = hn::And(negative, is_negative(x[i]));
  }
  return hn::Or(positive, negative);
}

/// No coordinate exceeds `limit` in magnitude; not so for NaN.
template <class Real>
HWY_INLINE Mask<Real> are_within(const Tile<Real>& tile, Real limit) {
  const Lanes<Real> most(limit);
  auto within = hn::Le(magnitude(tile.x[0]).v, most.v);
  for (std::size_t c = 1; c < 24; ++c) within = hn::And(within, hn::Le(magnitude(tile.x[c]).v, most.v));
  return within;
}

/// has_moderate_coordinates (ccd/geometry.h).
template <class Real>
HWY_INLINE Mask<Real> are_moderate(const Tile<Real>& tile) {
  return are_within<Real>(tile, power_of_two<Real>(sizeof(Real) == 8 ? 53 : 32));
}

/// spread(points) >= least_spread (ccd/geometry.h). Coordinates are finite.
template <class Real>
HWY_INLINE Mask<Real> are_spread(const Tile<Real>& tile) {
  Lanes<Real> largest(Real(0));
  for (std::size_t c = 0; c < 24; c += c % 12 == 2 ? 10 : 1) {
    const auto a = tile.x[c].v, b = tile.x[c + 3].v, d = tile.x[c + 6].v, e = tile.x[c + 9].v;
    const auto low = hn::Min(hn::Min(a, b), hn::Min(d, e)), high = hn::Max(hn::Max(a, b), hn::Max(d, e));
    largest = hn::Max(largest.v, hn::Sub(high, low));
  }
  return hn::Ge(largest.v, Lanes<Real>(least_spread<Real>).v);
}

/// Is one feature beyond the other in a coordinate, at t = 0 and at t = 1 (MATH 1.4 c)? Coordinates are finite.
template <Kind kind, class Real>
HWY_INLINE Mask<Real> are_separated_on_axis(const Tile<Real>& tile) {
  auto separated = hn::Lt(tile.x[0].v, tile.x[0].v);  // none
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto below = hn::Not(hn::Lt(tile.x[0].v, tile.x[0].v)), above = below;
    for (std::size_t end = 0; end < 24; end += 12) {
      const auto a = tile.x[end + axis].v, b = tile.x[end + axis + 3].v;
      const auto c = tile.x[end + axis + 6].v, d = tile.x[end + axis + 9].v;
      if constexpr (kind == Kind::vertex_face) {
        below = hn::And(below, hn::Lt(a, hn::Min(b, hn::Min(c, d))));
        above = hn::And(above, hn::Gt(a, hn::Max(b, hn::Max(c, d))));
      } else {
        below = hn::And(below, hn::Lt(hn::Max(a, b), hn::Min(c, d)));
        above = hn::And(above, hn::Gt(hn::Min(a, b), hn::Max(c, d)));
      }
    }
    separated = hn::Or(separated, hn::Or(below, above));
  }
  return separated;
}

/// Does a plane along the features as they are at t = 0 (`Start`) or t = 1 separate them (MATH 3.4a)?
template <Kind kind, bool Start, class Real, template <class, class> class PlaneOfFace = plane_of_face,
          template <class, class> class PlaneOfEdges = plane_of_edges>
HWY_INLINE Mask<Real> are_separated_by_plane(const Tile<Real>& tile) {
  const Lanes<Real>*x = tile.x + (Start ? 0 : 12), *y = tile.x + (Start ? 12 : 0);
  if constexpr (kind == Kind::vertex_face) {
    const auto s = PlaneOfFace<bound::safe, Real>::evaluate(x, x + 3, x + 6, x + 9, y, y + 3, y + 6, y + 9);
    const BoundedLanes<Real> sides[] = {s.near, s.far[0], s.far[1], s.far[2]};
    return have_one_sign<Real>(sides);
  } else {
    const auto s = PlaneOfEdges<bound::safe, Real>::evaluate(x, x + 3, x + 6, x + 9, y, y + 3, y + 6, y + 9);
    const BoundedLanes<Real> sides[] = {s.near, s.far[0], s.far[1], s.far[2], s.far[3]};
    return have_one_sign<Real>(sides);
  }
}

/// Are the four points never in one plane, by the points as they are named (ccd/classification.h)? Moderate
/// coordinates.
template <Kind kind, class Bound, class Real>
HWY_INLINE Mask<Real> are_never_coplanar(const Tile<Real>& q) {
  if constexpr (kind == Kind::vertex_face) {
    using predicate = vertex_face<Bound, Real>;
    typename predicate::State state;
    return have_one_sign<Real>(
        predicate::coplanarity_in_range(q.t0(0), q.t1(0), q.t0(1), q.t1(1), q.t0(2), q.t1(2), q.t0(3), q.t1(3), state)
            .k);
  } else {
    using predicate = edge_edge<Bound, Real>;
    typename predicate::State state;
    return have_one_sign<Real>(predicate::coplanarity_in_range(q.t0(0), q.t1(0), q.t0(1), q.t1(1), q.t0(2), q.t1(2),
                                                               q.t0(3), q.t1(3), q.t0(2), q.t1(2), q.t0(0), q.t1(0),
                                                               state)
                                   .k);
  }
}

/// distance_estimate (ccd/geometry.h).
template <class Real>
HWY_INLINE Lanes<Real> distance_estimate(const MovingLanes<Real>& p, const MovingLanes<Real>& q) {
  Lanes<Real> largest(Real(0));
  for (std::size_t i = 0; i < 3; ++i) {
    largest = max_magnitude(largest, magnitude(p.t0[i] - q.t0[i]));
    largest = max_magnitude(largest, magnitude(p.t1[i] - q.t1[i]));
  }
  return largest;
}

/// Have two of the quadratics opposite signs in some coordinate, by their Bernstein coefficients (MATH 1.4 a)?
/// m[function][coefficient][axis].
template <class Real, std::size_t Functions>
HWY_INLINE Mask<Real> are_contradictory(const BoundedLanes<Real> (*const (&m)[Functions])[3]) {
  auto contradictory = hn::Lt(m[0][0][0].value.v, m[0][0][0].value.v);  // none
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto positive = hn::Lt(m[0][0][0].value.v, m[0][0][0].value.v), negative = positive;
    for (std::size_t f = 0; f < Functions; ++f) {
      positive = hn::Or(positive, hn::And(is_positive(m[f][0][axis]),
                                          hn::And(is_positive(m[f][1][axis]), is_positive(m[f][2][axis]))));
      negative = hn::Or(negative, hn::And(is_negative(m[f][0][axis]),
                                          hn::And(is_negative(m[f][1][axis]), is_negative(m[f][2][axis]))));
    }
    contradictory = hn::Or(contradictory, hn::And(positive, negative));
  }
  return contradictory;
}

/// Do the hulls of Y or of the quadratics exclude a contact, in the geometry with the shortest vectors (MATH 1.3, 1.4;
/// with_polynomials in ccd/classification.h)? Moderate coordinates that are spread.
template <Kind kind, class Bound, class Real>
HWY_INLINE Mask<Real> are_excluded_by_hulls(const Tile<Real>& tile) {
  MovingLanes<Real> p(tile, 0), q(tile, 1), r(tile, 2), s(tile, 3);
  if constexpr (kind == Kind::vertex_face) {
    auto to_q = distance_estimate<Real>(p, q), to_r = distance_estimate<Real>(p, r),
         to_s = distance_estimate<Real>(p, s);
    auto nearer = hn::Lt(to_r.v, to_q.v);
    swap_where<Real>(nearer, to_q, to_r), swap_where<Real>(nearer, q, r);
    nearer = hn::Lt(to_s.v, to_r.v);
    swap_where<Real>(nearer, to_r, to_s), swap_where<Real>(nearer, r, s);
    nearer = hn::Lt(to_r.v, to_q.v);
    swap_where<Real>(nearer, q, r);
    using predicate = vertex_face<Bound, Real>;
    typename predicate::State state;
    const auto y = predicate::coplanarity_in_range(p.t0, p.t1, q.t0, q.t1, r.t0, r.t1, s.t0, s.t1, state);
    const auto z = predicate::inside_in_range(p.t0, p.t1, q.t0, q.t1, r.t0, r.t1, s.t0, s.t1, state);
    const BoundedLanes<Real>(*const m[])[3] = {z.m_ab, z.m_bc, z.m_ca};
    return hn::Or(have_one_sign<Real>(y.k), are_contradictory<Real>(m));
  } else {
    auto pr = distance_estimate<Real>(p, r), ps = distance_estimate<Real>(p, s);
    auto qr = distance_estimate<Real>(q, r), qs = distance_estimate<Real>(q, s);
    const auto second = hn::Lt(hn::Min(qr.v, qs.v), hn::Min(pr.v, ps.v));
    swap_where<Real>(second, p, q), swap_where<Real>(second, pr, qr), swap_where<Real>(second, ps, qs);
    const auto fourth = hn::Lt(ps.v, pr.v);
    swap_where<Real>(fourth, r, s), swap_where<Real>(fourth, pr, ps), swap_where<Real>(fourth, qr, qs);
    const MovingLanes<Real> near_q = selected<Real>(hn::Lt(qs.v, qr.v), s, r);
    const MovingLanes<Real> near_s = selected<Real>(hn::Lt(qs.v, ps.v), q, p);
    using predicate = edge_edge<Bound, Real>;
    typename predicate::State state;
    const auto y = predicate::coplanarity_in_range(p.t0, p.t1, q.t0, q.t1, r.t0, r.t1, s.t0, s.t1, near_q.t0, near_q.t1,
                                                   near_s.t0, near_s.t1, state);
    const auto z = predicate::inside_in_range(p.t0, p.t1, q.t0, q.t1, r.t0, r.t1, s.t0, s.t1, near_q.t0, near_q.t1,
                                              near_s.t0, near_s.t1, state);
    const BoundedLanes<Real>(*const m[])[3] = {z.m_b, z.m_a, z.m_d, z.m_c};
    return hn::Or(have_one_sign<Real>(y.k), are_contradictory<Real>(m));
  }
}

/// One bit a lane, that of query i being bit i: set where the mask is not.
template <class Real>
HWY_INLINE unsigned bits_of_others(Mask<Real> settled) {
  static_assert(hn::MaxLanes(typename Lanes<Real>::Tag()) <= 16);
  constexpr unsigned all = (1U << hn::MaxLanes(typename Lanes<Real>::Tag())) - 1;
  std::uint8_t bytes[8] = {};  // StoreMaskBits may write as many
  hn::StoreMaskBits(typename Lanes<Real>::Tag(), settled, bytes);
  return ~(bytes[0] | static_cast<unsigned>(bytes[1]) << 8) & all;
}

}  // namespace tightrope::TIGHTROPE_LANES

#endif  // include guard that foreach_target.h turns over
