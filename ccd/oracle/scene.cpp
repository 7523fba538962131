#include "ccd/oracle/scene.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

namespace tightrope::ccd::oracle {
namespace {

/// A finite double as significand * 2^exponent with an odd significand (or 0).
struct Decomposed {
  std::int64_t significand;
  int exponent;
};

Decomposed decompose(double x) {
  const auto pattern = std::bit_cast<std::uint64_t>(x);
  const int biased = static_cast<int>(pattern >> 52 & 0x7ff);
  auto significand = static_cast<std::int64_t>(pattern & ((std::uint64_t{1} << 52) - 1));
  if (biased != 0) significand |= std::int64_t{1} << 52;
  if (significand == 0) return {0, 0};
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(significand));
  significand >>= zeros;
  return {pattern >> 63 != 0 ? -significand : significand, std::max(biased, 1) - 1075 + zeros};
}

}  // namespace

IntegerPoints integer_points(Kind kind, std::span<const double, 24> points) {
  std::array<Decomposed, 24> numbers;
  int lowest = std::numeric_limits<int>::max();
  for (std::size_t i = 0; i < 24; ++i) {
    numbers[i] = decompose(points[i]);
    if (numbers[i].significand != 0) lowest = std::min(lowest, numbers[i].exponent);
  }
  const bool vertex_first = kind == Kind::vertex_face;  // stored v f0 f1 f2: corner d is stored first
  IntegerPoints result;
  for (std::size_t point = 0; point < 8; ++point) {
    const std::size_t corner = point % 4;
    const std::size_t stored = point - corner + (vertex_first ? (corner + 1) % 4 : corner);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Decomposed& number = numbers[3 * stored + axis];
      if (number.significand == 0) continue;
      result[point][axis] = static_cast<long>(number.significand);
      result[point][axis] <<= static_cast<mp_bitcnt_t>(number.exponent - lowest);
    }
  }
  return result;
}

Vector difference(const IntegerPoints& points, Corner p, Corner q) {
  const auto i = static_cast<std::size_t>(p), j = static_cast<std::size_t>(q);
  Vector r = {Form(1), Form(1), Form(1)};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    r[axis][0] = points[i][axis] - points[j][axis];
    r[axis][1] = points[i + 4][axis] - points[j + 4][axis];
  }
  return r;
}

Vector operator+(const Vector& u, const Vector& v) { return {u[0] + v[0], u[1] + v[1], u[2] + v[2]}; }

Form dot(const Vector& u, const Vector& v) {
  Form r(u[0].degree() + v[0].degree());
  for (std::size_t axis = 0; axis < 3; ++axis) add_product(r, u[axis], v[axis]);
  return r;
}

Vector cross(const Vector& u, const Vector& v) {
  const int degree = u[0].degree() + v[0].degree();
  Vector r = {Form(degree), Form(degree), Form(degree)};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t next = (axis + 1) % 3, last = (axis + 2) % 3;
    add_product(r[axis], u[next], v[last]);
    subtract_product(r[axis], u[last], v[next]);
  }
  return r;
}

bool is_zero(const Vector& u) { return u[0].is_zero() && u[1].is_zero() && u[2].is_zero(); }

bool swept_boxes_apart(Kind kind, std::span<const double, 24> points) {
  const std::size_t split = kind == Kind::vertex_face ? 1 : 2;  // how many of the four points the first feature has
  for (std::size_t axis = 0; axis < 3; ++axis) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    std::array<double, 2> low = {inf, inf}, high = {-inf, -inf};
    for (std::size_t point = 0; point < 8; ++point) {
      const std::size_t feature = point % 4 < split ? 0 : 1;
      const double x = points[3 * point + axis];
      low[feature] = std::min(low[feature], x);
      high[feature] = std::max(high[feature], x);
    }
    if (high[0] < low[1] || high[1] < low[0]) return true;
  }
  return false;
}

}  // namespace tightrope::ccd::oracle
