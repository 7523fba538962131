#pragma once
/// Conservative subdivision on the exact contact criterion (MATH 1.4, 3.4): proves that there is no contact, or that
/// there is one and when, or leaves the query open for exact arithmetic.
///
/// Y is the cubic that vanishes where the four points are coplanar, z the projected quadratics of theorem 1.4. A part
/// of the step is free of contact if Y has one sign on it, or if in some coordinate two of the quadratics have opposite
/// signs on it: hulls of Bernstein coefficients tell. Conversely, if Y changes its sign on a part and in some
/// coordinate all quadratics have one and the same sign there, there is a contact on it (1.4 b). Where Y has at most
/// one root on a part, that is isolated first, in a bracket so narrow that the quadratics nearly always tell.
///
/// Who includes this includes the generated headers of subdivision.pred first.

#include <array>
#include <cstddef>
#include <optional>

#include "ccd/classification.h"
#include "ccd/impact/exact_time.h"
#include "ccd/impact/isolation.h"
#include "ccd/impact/stage.h"

namespace tightrope::generated {
template <class Bound, class Real>
struct halved_cubic;
template <class Bound, class Real>
struct halved_quadratic;
template <class Bound, class Real>
struct restricted_quadratic;
}  // namespace tightrope::generated

namespace tightrope::ccd {

enum class Verdict : unsigned char {
  no_contact,
  contact,  ///< there is one; with `time`, which holds the first
  open,     ///< bounds do not tell
};

struct Finding {
  Verdict verdict;
  TimeBracket time{0, 1};
};

/// lo + w x of a part [lo, lo + w] of the step, x in [0, 1], rounded down and up. lo is 0 or at least w, a power of
/// two, so that the error of the sum is exact (Dekker's fast two-sum) and one step to the neighbour is enough.
TIGHTROPE_HOST_DEVICE inline double time_below(double lo, double w, double x) {
  const double t = lo + w * x;
  return w * x - (t - lo) < 0 ? std::nextafter(t, 0.0) : t;
}
TIGHTROPE_HOST_DEVICE inline double time_above(double lo, double w, double x) {
  const double t = lo + w * x;
  return w * x - (t - lo) > 0 ? std::nextafter(t, 2.0) : t;
}

template <std::size_t Functions, class Signs>
class Subdivision {
 public:
  using Z = Quadratics<double, Functions>;

  /// t_max: later contacts do not count.
  TIGHTROPE_HOST_DEVICE Subdivision(Question question, double t_max, Signs& signs)
      : question_(question), t_max_(t_max), signs_(signs) {}

  /// Asked when: the first contact. Asked whether: any.
  TIGHTROPE_HOST_DEVICE Finding operator()(const Cubic& k, const Z& z) {
    nodes_[0] = {k, z, 0, 1};
    std::size_t waiting = 1;
    bool open = false;
    for (int visited = 0; waiting > 0; ++visited) {
      Node& node = nodes_[--waiting];
      if (node.lo > t_max_) continue;
      const Finding found = look(node);
      if (found.verdict == Verdict::no_contact) continue;
      if (found.verdict == Verdict::contact) return found;
      const bool divide = divide_ && visited < most_visits;
      if (divide) {
        halve(node, nodes_[waiting + 1]);  // into the later and, on top, the earlier half
        waiting += 2;
      } else if (question_ == Question::when) {
        return {Verdict::open};
      } else {
        open = true;
      }
    }
    return {open ? Verdict::open : Verdict::no_contact};
  }

 private:
  struct Node {
    Cubic y;
    Z z;
    double lo, width;
  };
  static constexpr int most_visits = 12;  ///< more decide little that exact arithmetic would not decide at once

  /// Decides a part of the step if it can; else sets whether halving it may help.
  TIGHTROPE_HOST_DEVICE Finding look(const Node& node) {
    std::array<Sign, 4> k;
    for (std::size_t i = 0; i < 4; ++i) k[i] = signs_(node.y[i]);
    divide_ = true;
    if (common(k) != Sign::uncertain) return {Verdict::no_contact};
    const auto hulls = hull_signs(node.z, signs_);
    bool inside = false;
    for (const auto& axis : hulls) {
      if (any_opposite(axis)) return {Verdict::no_contact};
      inside = inside || common(axis) != Sign::uncertain;
    }
    if (inside && question_ == Question::whether && opposite(k[0], k[3])) return {Verdict::contact};
    if (const Sign direction = crossing_direction(node.y, k, signs_); direction != Sign::uncertain) {
      if (const auto bracket = isolated_crossing(node.y, k, direction, signs_)) return at_crossing(node, *bracket);
    }
    divide_ = !lost_in_noise(node);
    return {Verdict::open};
  }

  /// The part's only root of Y is in the bracket: its quadratics decide.
  TIGHTROPE_HOST_DEVICE Finding at_crossing(const Node& node, const Bracket& bracket) {
    divide_ = false;
    bool inside = false;
    for (const auto& axis : node.z) {
      std::array<Sign, Functions> on_bracket;
      for (std::size_t f = 0; f < Functions; ++f) {
        const auto restricted = generated::restricted_quadratic<bound::tight, double>::evaluate_in_range(
            axis[f].data(), bracket.l, bracket.r);
        on_bracket[f] = common(read_all(signs_, restricted.part));
      }
      if (any_opposite(on_bracket)) return {Verdict::no_contact};
      inside = inside || common(on_bracket) != Sign::uncertain;
      if (inside && bracket.crossed) break;  // all axes agree then
    }
    const TimeBracket time{time_below(node.lo, node.width, bracket.l), time_above(node.lo, node.width, bracket.r)};
    if (time.lower > t_max_) return {Verdict::no_contact};
    if (inside && bracket.crossed && time.upper <= t_max_) return {Verdict::contact, time};
    return {Verdict::open};
  }

  /// Everything that is not settled is smaller than its bound: halves cannot tell more.
  TIGHTROPE_HOST_DEVICE bool lost_in_noise(const Node& node) {
    for (const Bounded<double>& x : node.y) {
      if (signs_(x) != Sign::uncertain) return false;
    }
    for (const auto& axis : node.z) {
      for (const auto& j : axis) {
        const std::array<Sign, 3> s{signs_(j[0]), signs_(j[1]), signs_(j[2])};
        const bool all_uncertain = s[0] == Sign::uncertain && s[1] == Sign::uncertain && s[2] == Sign::uncertain;
        if (common(s) == Sign::uncertain && !all_uncertain) return false;
      }
    }
    return true;
  }

  /// The node becomes its later half.
  TIGHTROPE_HOST_DEVICE static void halve(Node& node, Node& earlier) {
    const double width = node.width / 2;
    const auto y = generated::halved_cubic<bound::tight, double>::evaluate_in_range(node.y.data());
    copy_numbers(y.before, 4, earlier.y.data());
    copy_numbers(y.after, 4, node.y.data());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t f = 0; f < Functions; ++f) {
        const auto z = generated::halved_quadratic<bound::tight, double>::evaluate_in_range(node.z[axis][f].data());
        copy_numbers(z.before, 3, earlier.z[axis][f].data());
        copy_numbers(z.after, 3, node.z[axis][f].data());
      }
    }
    earlier.lo = node.lo;
    earlier.width = node.width = width;
    node.lo += width;
  }

  Question question_;
  double t_max_;
  Signs& signs_;
  bool divide_ = true;
  std::array<Node, most_visits + 1> nodes_;  ///< each visit takes one and leaves two at most
};

}  // namespace tightrope::ccd
