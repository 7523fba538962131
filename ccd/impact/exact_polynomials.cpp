#include "ccd/impact/exact_polynomials.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "edge_edge.exact.double.h"
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

/// Times which power of two exact numbers are shortest: the largest coordinate in [2^60, 2^61) times a power of 2^64.
/// Then differences of coordinates are a multiple of 2^64 times a number below 2^62, one word for numbers that are not
/// much smaller, and products of n of them n words. Nothing is lost by scaling up; numbers near overflow stay as they
/// are.
double shortening(std::span<const double> points) {
  double largest = 0;
  for (const double x : points) largest = std::max(largest, magnitude(x));
  const int exponent = std::max(static_cast<int>(std::bit_cast<std::uint64_t>(largest) >> 52), 1) - 1023;
  const int factor = (60 - exponent) & 63;
  return exponent + factor > 1000 ? 1 : std::bit_cast<double>(static_cast<std::uint64_t>(factor + 1023) << 52);
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

}  // namespace

Cubic elevated(const Quadratic& j) {
  auto cubic = generated::quadratic_elevated<bound::exact, double>::evaluate_values(j.exact.data());
  return polynomial(values(cubic.k));
}
Cubic elevated(const Line& l) {
  auto quadratic = generated::line_elevated<bound::exact, double>::evaluate_values(l.data());
  return elevated(polynomial(values(quadratic.j)));
}

Features::Features(Pair pair, const double* points)
    : pair_(pair), count_(std::array{2U, 3U, 4U, 4U}[static_cast<std::size_t>(pair)]) {
  const std::span given(points, 6 * count_);
  const double factor = shortening(given);
  std::transform(given.begin(), given.end(), points_.begin(), [&](double x) { return x * factor; });
}

Cubic Features::coplanarity() const {
  const auto a = moving_point(points_.data(), 0), b = moving_point(points_.data(), 1);
  const auto c = moving_point(points_.data(), 2), d = moving_point(points_.data(), 3);
  if (pair_ == Pair::vertex_face) {
    using predicate = generated::vertex_face<bound::exact, double>;
    auto y = predicate::coplanarity_values(a.t0, a.t1, b.t0, b.t1, c.t0, c.t1, d.t0, d.t1);
    return polynomial(values(y.k));
  }
  using predicate = generated::edge_edge<bound::exact, double>;
  auto y = predicate::coplanarity_values(a.t0, a.t1, b.t0, b.t1, c.t0, c.t1, d.t0, d.t1, c.t0, c.t1, a.t0, a.t1);
  return polynomial(values(y.k));
}

Functions<Quadratic> Features::moments(std::size_t axis) const {
  std::array<std::array<double, 2>, 8> projected;
  for (std::size_t i = 0; i < 2 * count_; ++i) {
    projected[i] = {coordinate(i, (axis + 1) % 3), coordinate(i, (axis + 2) % 3)};
  }
  const auto at_0 = [&](std::size_t i) { return projected[i].data(); };
  const auto at_1 = [&](std::size_t i) { return projected[i + count_].data(); };
  switch (pair_) {
    case Pair::vertex_vertex:
      return {};
    case Pair::vertex_edge: {
      using predicate = generated::edge_moment<bound::exact, double>;
      auto moment = predicate::evaluate_values(at_0(0), at_1(0), at_0(1), at_1(1), at_0(2), at_1(2));
      return {1, {polynomial(values(moment.m))}};
    }
    case Pair::vertex_face: {
      using predicate = generated::face_moments<bound::exact, double>;
      auto face = predicate::evaluate_values(at_0(0), at_1(0), at_0(1), at_1(1), at_0(2), at_1(2), at_0(3), at_1(3));
      return {3, {polynomial(values(face.m[0])), polynomial(values(face.m[1])), polynomial(values(face.m[2]))}};
    }
    case Pair::edge_edge: {
      using predicate = generated::edge_moments<bound::exact, double>;
      auto edges = predicate::evaluate_values(at_0(0), at_1(0), at_0(1), at_1(1), at_0(2), at_1(2), at_0(3), at_1(3));
      return {4,
              {polynomial(values(edges.m[0])), polynomial(values(edges.m[1])), polynomial(values(edges.m[2])),
               polynomial(values(edges.m[3]))}};
    }
  }
  return {};
}

Functions<Line> Features::offsets(std::size_t axis) const {
  Functions<Line> result;
  for (const auto& pair : pairs_of_points(pair_)) {
    const auto i = static_cast<std::size_t>(pair[0]), j = static_cast<std::size_t>(pair[1]);
    using predicate = generated::offset_in_axis<bound::exact, double>;
    auto offset = predicate::evaluate_values(coordinate(i, axis), coordinate(i + count_, axis), coordinate(j, axis),
                                             coordinate(j + count_, axis));
    result.of[result.count++] = values(offset.path);
  }
  return result;
}

}  // namespace tightrope::ccd::exact
