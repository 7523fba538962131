#include "ccd/impact/exact_polynomials.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "edge_edge.exact.double.h"
#include "exact_classification.exact.double.h"
#include "exact_roots.exact.double.h"
#include "vertex_face.exact.double.h"

// After the generated headers:
#include "ccd/geometry.h"

namespace tightrope::ccd::exact {
namespace {

/// Exact outputs of generated predicates: there, since inputs are finite and nothing is divided.
template <std::size_t N>
std::array<Dyadic, N> values(std::optional<Dyadic> (&outputs)[N]) {
  std::array<Dyadic, N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = *std::move(outputs[i]);
  return result;
}

/// Adds a vector-valued quadratic of a generated predicate, [coefficient][axis].
void add(PerAxis<Quadratic>& moments, std::optional<Dyadic> (&m)[3][3]) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    moments.of[axis][moments.count] = polynomial<3>({*m[0][axis], *m[1][axis], *m[2][axis]});
  }
  ++moments.count;
}

MovingPoint<double> point(Pair pair, const double* points, int index) {
  static constexpr std::array<int, 4> count{2, 3, 4, 4};
  return {points + 3 * index, points + 3 * (index + count[static_cast<std::size_t>(pair)])};
}

/// The pairs of points of different features.
std::span<const std::array<int, 2>> pairs_of_points(Pair pair) {
  static constexpr std::array<std::array<int, 2>, 2> vertex{{{0, 1}, {0, 2}}};
  switch (pair) {
    case Pair::vertex_vertex:
      return std::span(vertex).first(1);
    case Pair::vertex_edge:
      return vertex;
    case Pair::vertex_face:
      return pairs_of_features(Kind::vertex_face);
    case Pair::edge_edge:
      return pairs_of_features(Kind::edge_edge);
  }
  return {};
}

}  // namespace

/// The numbers are scaled by a power of 2^64 so that the largest is in [1, 2^64). Rounding to nearest errs by u |x| or,
/// below the normal numbers, by half of the smallest.
template <std::size_t N>
Polynomial<N> polynomial(std::array<Dyadic, N> exact) {
  Polynomial<N> p{std::move(exact), {}};
  std::int64_t high = std::numeric_limits<std::int64_t>::min();
  for (const Dyadic& x : p.exact) {
    if (x.sign() != 0) high = std::max(high, x.high_exponent());
  }
  for (std::size_t i = 0; i < N; ++i) {
    if (p.exact[i].sign() == 0) continue;
    const double x = mul_pow2(p.exact[i], -(high - (high & 63))).to_double();
    p.near[i] = {x, magnitude(x) * 0x1p-53 + 0x1p-1074};
  }
  return p;
}
template Line polynomial(std::array<Dyadic, 2>);
template Quadratic polynomial(std::array<Dyadic, 3>);
template Cubic polynomial(std::array<Dyadic, 4>);

Cubic elevated(const Quadratic& j) {
  auto cubic = generated::elevated_quadratic<bound::exact, double>::evaluate_values(j.exact.data());
  return polynomial(values(cubic.k));
}
Cubic elevated(const Line& l) {
  auto quadratic = generated::elevated_line<bound::exact, double>::evaluate_values(l.exact.data());
  return elevated(polynomial(values(quadratic.j)));
}

Cubic coplanarity(Kind kind, const double* points) {
  const auto a = moving_point(points, 0), b = moving_point(points, 1);
  const auto c = moving_point(points, 2), d = moving_point(points, 3);
  if (kind == Kind::vertex_face) {
    using predicate = generated::vertex_face<bound::exact, double>;
    auto y = predicate::coplanarity_values(a.t0, a.t1, b.t0, b.t1, c.t0, c.t1, d.t0, d.t1);
    return polynomial(values(y.k));
  }
  using predicate = generated::edge_edge<bound::exact, double>;
  auto y = predicate::coplanarity_values(a.t0, a.t1, b.t0, b.t1, c.t0, c.t1, d.t0, d.t1, c.t0, c.t1, a.t0, a.t1);
  return polynomial(values(y.k));
}

PerAxis<Quadratic> moments(Pair pair, const double* points) {
  PerAxis<Quadratic> result;
  const auto p = [&](int index) { return point(pair, points, index); };
  switch (pair) {
    case Pair::vertex_vertex:
      break;
    case Pair::vertex_edge: {
      using predicate = generated::edge_moment<bound::exact, double>;
      auto inside = predicate::evaluate_values(p(0).t0, p(0).t1, p(1).t0, p(1).t1, p(2).t0, p(2).t1);
      add(result, inside.m);
      break;
    }
    case Pair::vertex_face: {
      using predicate = generated::vertex_face<bound::exact, double>;
      auto inside = predicate::inside_values(p(0).t0, p(0).t1, p(1).t0, p(1).t1, p(2).t0, p(2).t1, p(3).t0, p(3).t1);
      add(result, inside.m_ab);
      add(result, inside.m_bc);
      add(result, inside.m_ca);
      break;
    }
    case Pair::edge_edge: {
      using predicate = generated::edge_edge<bound::exact, double>;
      auto inside = predicate::inside_values(p(0).t0, p(0).t1, p(1).t0, p(1).t1, p(2).t0, p(2).t1, p(3).t0, p(3).t1,
                                             p(2).t0, p(2).t1, p(0).t0, p(0).t1);
      add(result, inside.m_b);
      add(result, inside.m_a);
      add(result, inside.m_d);
      add(result, inside.m_c);
      break;
    }
  }
  return result;
}

PerAxis<Line> offsets(Pair pair, const double* points) {
  PerAxis<Line> result;
  for (const auto& [i, j] : pairs_of_points(pair)) {
    const auto x = point(pair, points, i), y = point(pair, points, j);
    const auto line = generated::offset<bound::exact, double>::evaluate_values(x.t0, x.t1, y.t0, y.t1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result.of[axis][result.count] = polynomial<2>({*line.path[0][axis], *line.path[1][axis]});
    }
    ++result.count;
  }
  return result;
}

}  // namespace tightrope::ccd::exact
