#pragma once
/// The filter of vertex against edge, in space and in the plane: what floating point can decide.
///
/// With the moment m = (a - p) x (b - p) there is contact at a time if and only if m = 0 and no coordinate axis
/// strictly separates p from both ends (a - p and b - p both positive or both negative in that coordinate). Proof. m =
/// 0 puts p, a, b on one line. If p is on the segment, a - p and b - p are opposite, or one is 0: no axis separates,
/// and m = 0. If p is on the line outside of the segment, they are positive multiples of one vector, which is not 0 in
/// some coordinate: that axis separates. QED. (An edge of length 0 is included: m = 0, b - p = a - p.)
///
/// The coordinates of m are quadratics in t (the plane has one), those of a - p and b - p linear functions. A part of
/// the step is free of contact where a quadratic's Bernstein coefficients have one sign, or an axis separates at both
/// ends.
///
/// Where a coordinate of m has opposite signs at the ends of a part, it has exactly one root there, being quadratic:
/// all is decided by a bracket of that root. No contact: there another coordinate of m has one sign, or an axis
/// separates. In the plane, where m has no other coordinate, a certain contact: there p is strictly between a and b in
/// a coordinate, since at the root the three are on one line.
///
/// Who includes this includes the generated headers of his bound mode (vertex_edge.pred) and of SafeBound first.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

#include "ccd/geometry.h"
#include "ccd/rescale.h"
#include "ccd/tables.h"

namespace tightrope::generated {
template <class Bound, class Real>
struct vertex_edge;
template <class Bound, class Real>
struct vertex_edge_2d;
template <class Bound, class Real>
struct vertex_edge_part;
template <class Bound, class Real>
struct vertex_edge_offset;
}  // namespace tightrope::generated

namespace tightrope::ccd::vertex_edge_query {

enum class Answer { never, touches, open };

/// touches: the first contact is in [from, to], from < to.
struct Finding {
  Answer answer;
  double from = 0, to = 0;
};

/// Is p beyond both ends of the edge in a coordinate, at t = 0 and at t = 1? Then at every time between. The signs of
/// rounded differences are exact. Overflow keeps them; NaN separates nothing.
template <std::size_t Dimension>
bool separated_on_an_axis(const double* points) {
  for (std::size_t axis = 0; axis < Dimension; ++axis) {
    const double* const x = points + axis;
    constexpr std::size_t end = 3 * Dimension;
    const double at[4]{x[Dimension] - x[0], x[2 * Dimension] - x[0], x[end + Dimension] - x[end],
                       x[end + 2 * Dimension] - x[end]};
    if (at[0] > 0 && at[1] > 0 && at[2] > 0 && at[3] > 0) return true;
    if (at[0] < 0 && at[1] < 0 && at[2] < 0 && at[3] < 0) return true;
  }
  return false;
}

template <class Bound, std::size_t Dimension>
class Search {
 public:
  /// `points`: moderate, see scaled_points.h; `scaled` if they come from `scaled_to_one`.
  Search(const double* points, bool scaled) : points_(points), scaled_(scaled) {
    if (extent(0, 2) < extent(0, 1)) std::swap(near_, far_);
  }

  Finding first_contact(double t_max) {
    if (hulls_exclude(moments<bound::safe>())) return {Answer::never};
    moments_ = moments<Bound>();
    if (hulls_exclude(moments_)) return {Answer::never};
    if (!rescale(std::span(&moments_[0][0], 3 * moments_.size()))) return {Answer::open};
    std::array<Part, most_halvings + 2> parts;  // to do, the earliest last
    std::size_t count = 0;
    parts[count++] = {0, t_max, 0};
    for (int nodes = 0; count > 0; ++nodes) {
      const Part part = parts[--count];
      double split = 0.5;
      const std::optional<Finding> finding = settled(part, split);
      if (finding && finding->answer == Answer::never) continue;
      if (finding || part.depth == most_halvings || nodes == most_nodes) return finding.value_or(Finding{Answer::open});
      const double middle = part.l + (part.r - part.l) * split;
      parts[count++] = {middle, part.r, part.depth + 1};
      parts[count++] = {part.l, middle, part.depth + 1};
    }
    return {Answer::never};
  }

 private:
  static constexpr std::size_t most_halvings = 16;
  static constexpr int most_nodes = 32;

  struct Part {
    double l, r;
    std::size_t depth;
  };
  using Quadratic = std::array<Bounded<double>, 3>;
  using Moments = std::array<Quadratic, Dimension == 2 ? 1 : 3>;

  const double* at_0(std::size_t point) const { return points_ + Dimension * point; }
  const double* at_1(std::size_t point) const { return points_ + Dimension * (3 + point); }

  double extent(std::size_t i, std::size_t j) const {
    double largest = 0;
    for (std::size_t axis = 0; axis < Dimension; ++axis) {
      largest = max_magnitude(largest, magnitude(at_0(i)[axis] - at_0(j)[axis]));
      largest = max_magnitude(largest, magnitude(at_1(i)[axis] - at_1(j)[axis]));
    }
    return largest;
  }

  template <class AnyBound>
  Moments moments() const {
    Moments result;
    if constexpr (Dimension == 2) {
      const auto value = generated::vertex_edge_2d<AnyBound, double>::evaluate_in_range(
          at_0(0), at_1(0), at_0(near_), at_1(near_), at_0(far_), at_1(far_));
      std::copy_n(value.m, 3, result[0].begin());
    } else {
      const auto value = generated::vertex_edge<AnyBound, double>::evaluate_in_range(
          at_0(0), at_1(0), at_0(near_), at_1(near_), at_0(far_), at_1(far_));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < 3; ++i) result[axis][i] = value.m[i][axis];
      }
    }
    if (scaled_) widen(std::span<Bounded<double>>(&result[0][0], 3 * result.size()));
    return result;
  }

  static Sign hull(const Quadratic& m) { return common(std::array<Sign, 3>{sign(m[0]), sign(m[1]), sign(m[2])}); }
  static bool hulls_exclude(const Moments& m) {
    return std::any_of(m.begin(), m.end(), [](const Quadratic& q) { return hull(q) != Sign::uncertain; });
  }

  static Quadratic restricted(const Quadratic& m, double l, double r) {
    const auto value = generated::vertex_edge_part<Bound, double>::evaluate_in_range(m.data(), l, r);
    return {value.part[0], value.part[1], value.part[2]};
  }

  /// The signs that a - p and b - p have in a coordinate all over [l, r].
  struct Sides {
    Sign a, b;
  };
  Sides sides(std::size_t axis, double l, double r) const {
    const auto side = [&](std::size_t point) {
      auto d = generated::vertex_edge_offset<Bound, double>::evaluate_in_range(
          at_0(0)[axis], at_1(0)[axis], at_0(point)[axis], at_1(point)[axis], l, r);
      if (scaled_) {
        widen(std::span<Bounded<double>>(&d.at_l, 1));
        widen(std::span<Bounded<double>>(&d.at_r, 1));
      }
      return common(sign(d.at_l), sign(d.at_r));
    };
    return {side(1), side(2)};
  }

  bool axis_excludes(double l, double r) const {
    for (std::size_t axis = 0; axis < Dimension; ++axis) {
      const Sides s = sides(axis, l, r);
      if (s.a == s.b && s.a != Sign::uncertain) return true;
    }
    return false;
  }

  /// What is certain about a part of the step; none: divide it at the fraction `split`.
  std::optional<Finding> settled(const Part& part, double& split) const {
    Moments m;
    for (std::size_t i = 0; i < m.size(); ++i) {
      m[i] = restricted(moments_[i], part.l, part.r);
      if (hull(m[i]) != Sign::uncertain) return Finding{Answer::never};
    }
    if (axis_excludes(part.l, part.r)) return Finding{Answer::never};
    std::size_t steepest = 0;  // of those with one certain root, else of all
    for (std::size_t i = 1; i < m.size(); ++i) {
      if (steepness(m[i]) > steepness(m[steepest])) steepest = i;
    }
    if (crosses(m[steepest])) {
      if (const auto root = bracket(steepest, part, m[steepest])) return settled_at_root(steepest, *root);
    }
    split = extremum(m[steepest]);
    return std::nullopt;
  }

  static bool crosses(const Quadratic& m) { return opposite(sign(m[0]), sign(m[2])); }

  /// How much m changes; more if it certainly crosses 0.
  static double steepness(const Quadratic& m) {
    return magnitude(m[2].value - m[0].value) + (crosses(m) ? 4.0 : 0.0);  // no coefficient exceeds 1
  }

  /// A part is divided where the moment is extremal: it has at most one root on either side then.
  static double extremum(const Quadratic& m) {
    const double fall = m[0].value - m[1].value, s = fall / (fall - (m[1].value - m[2].value));
    return s > 0x1p-4 && s < 1 - 0x1p-4 ? s : 0.5;
  }

  /// A short bracket of the only root of coordinate `i` in the part, over which it has the coefficients `m`.
  std::optional<Part> bracket(std::size_t i, const Part& part, const Quadratic& m) const {
    // m = m0 + 2 b s + a s^2, solved without cancellation
    const double b = m[1].value - m[0].value, a = (m[2].value - m[1].value) - b;
    const double root = std::sqrt(std::max(b * b - a * m[0].value, 0.0));
    const double q = -(b + std::copysign(root, b));
    const double one = q / a, other = m[0].value / q;
    const double s = one >= 0 && one <= 1 ? one : other;
    const double error = std::max({m[0].bound, m[1].bound, m[2].bound}) / root + 0x1p-50;
    for (double h = 4 * error; h < 0x1p-8; h *= 64) {
      const double l = part.l + (part.r - part.l) * std::max(s - h, 0.0);
      const double r = part.l + (part.r - part.l) * std::min(s + h, 1.0);
      if (!(l < r) || !(r <= part.r)) break;
      const Quadratic near_root = restricted(moments_[i], l, r);
      if (sign(near_root[0]) == sign(m[0]) && sign(near_root[2]) == sign(m[2])) return Part{l, r, 0};
    }
    return std::nullopt;
  }

  /// On the bracket of the only root that coordinate `i` has in a part.
  Finding settled_at_root(std::size_t i, const Part& root) const {
    for (std::size_t other = 0; other < moments_.size(); ++other) {
      if (other != i && hull(restricted(moments_[other], root.l, root.r)) != Sign::uncertain) return {Answer::never};
    }
    bool inside = false;
    for (std::size_t axis = 0; axis < Dimension; ++axis) {
      const Sides side = sides(axis, root.l, root.r);
      if (side.a == side.b && side.a != Sign::uncertain) return {Answer::never};
      inside |= opposite(side.a, side.b);
    }
    return Dimension == 2 && inside ? Finding{Answer::touches, root.l, root.r} : Finding{Answer::open};
  }

  const double* points_;
  bool scaled_;
  std::size_t near_ = 1, far_ = 2;  ///< the edge's ends, the one nearer to the vertex first
  Moments moments_;
};

}  // namespace tightrope::ccd::vertex_edge_query
