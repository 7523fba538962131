#include "fit/look.h"

#include <fmt/format.h>

#include <cmath>

namespace tightrope::ccd {
namespace {

constexpr std::string_view vertex_face_predicates = R"(
// A plane of fixed direction, that of the face at one end of the step: points without a number are at that end, those with
// a 1 at the other.
predicate {0}_plane_of_face(point p, a, b, c, p1, a1, b1, c1) {{{1}
  let n = cross(b - a, c - a)
  sign dot(n, a - p) as near, [dot(n, a1 - p1), dot(n, b1 - p1), dot(n, c1 - p1)] as far
}}

// The same for a face at rest.
predicate {0}_face_at_rest(point p, a, b, c, p1) {{{2}
  let n = cross(b - a, c - a)
  sign dot(n, a - p) as near, [dot(n, a - p1)] as far
}}
)";

constexpr std::string_view edge_edge_predicates = R"(
// A plane of fixed direction, along both edges at one end of the step: points without a number are at that end, those with
// a 1 at the other.
predicate {0}_plane_of_edges(point a, b, c, d, a1, b1, c1, d1) {{{1}
  let n = cross(b - a, d - c)
  sign dot(n, c - a) as near, [dot(n, c1 - a1), dot(n, d1 - a1), dot(n, c1 - b1), dot(n, d1 - b1)] as far
}}

// The same for an edge cd at rest.
predicate {0}_edge_at_rest(point a, b, c, d, a1, b1) {{{2}
  let n = cross(b - a, d - c)
  sign dot(n, c - a) as near, [dot(n, c - a1), dot(n, c - b1)] as far
}}
)";

}  // namespace

std::optional<int> range_exponent(double largest, bool single) {
  if (!std::isfinite(largest)) return std::nullopt;
  int exponent = 0;
  if (largest > 0 && std::frexp(largest, &exponent) == 0.5) --exponent;  // frexp's fraction is in [1/2, 1)
  const int limit =
      single ? 32 : 300;  // bounds are of degree 3, and smaller than the values by a factor of 2^50 (2^21)
  if (exponent > limit || exponent < -limit) return std::nullopt;
  return exponent;
}

std::string predicates(std::string_view prefix, Kind kind, std::optional<int> exponent) {
  const auto range = [&](std::string_view points) {
    return exponent ? fmt::format("\n  range |{}| <= 2^{}", points, *exponent) : std::string();
  };
  if (kind == Kind::vertex_face) {
    return fmt::format(fmt::runtime(vertex_face_predicates), prefix, range("p, a, b, c, p1, a1, b1, c1"),
                       range("p, a, b, c, p1"));
  }
  return fmt::format(fmt::runtime(edge_edge_predicates), prefix, range("a, b, c, d, a1, b1, c1, d1"),
                     range("a, b, c, d, a1, b1"));
}

}  // namespace tightrope::ccd
