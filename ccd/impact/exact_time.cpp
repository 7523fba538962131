#include "ccd/impact/exact_time.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "ccd/impact/exact_polynomials.h"
#include "ccd/impact/exact_root.h"

namespace tightrope::ccd {
namespace {

using exact::Cubic;
using exact::DefiniteSign;
using exact::elevated;
using exact::Functions;
using exact::inner_roots;
using exact::is_zero;
using exact::Line;
using exact::Quadratic;
using exact::Root;
using exact::Verdict;

/// The contact criterion of a pair at one time.
class Touching {
 public:
  Touching(Pair pair, const double* points) : features_(pair, points) {}

  const Functions<Quadratic>& moments(std::size_t axis) {
    if (!moments_[axis]) moments_[axis] = features_.moments(axis);
    return *moments_[axis];
  }
  const Functions<Line>& offsets(std::size_t axis) {
    if (!offsets_[axis]) offsets_[axis] = features_.offsets(axis);
    return *offsets_[axis];
  }

  /// A cubic that is zero whenever there is contact.
  Cubic necessary();

  /// Is there contact at this time, a root of necessary()?
  bool at(const Root& time);

 private:
  Verdict verdict_of_moments(std::size_t axis, const Root& time);
  bool separated(std::size_t axis, const Root& time);

  exact::Features features_;
  std::array<std::optional<Functions<Quadratic>>, 3> moments_;
  std::array<std::optional<Functions<Line>>, 3> offsets_;
};

constexpr std::array<std::size_t, 3> axes{0, 1, 2};

/// Those functions of the first axis in which not all are zero all the time that are not, as cubics.
/// `of_axis`: gives the functions of an axis.
template <class OfAxis>
std::vector<Cubic> cubics_of_one_axis(const OfAxis& of_axis) {
  std::vector<Cubic> cubics;
  for (const std::size_t axis : axes) {
    const auto& functions = of_axis(axis);
    for (std::size_t i = 0; i < functions.count; ++i) {
      if (!is_zero(functions.of[i])) cubics.push_back(elevated(functions.of[i]));
    }
    if (!cubics.empty()) break;
  }
  return cubics;
}

Cubic Touching::necessary() {
  const auto first = [](const auto& of_axis) {
    const auto cubics = cubics_of_one_axis(of_axis);
    return cubics.empty() ? Cubic{} : cubics.front();
  };
  switch (features_.pair()) {
    case Pair::vertex_vertex:
      return first([&](std::size_t axis) -> const auto& { return offsets(axis); });
    case Pair::vertex_edge:
      return first([&](std::size_t axis) -> const auto& { return moments(axis); });
    case Pair::vertex_face:
    case Pair::edge_edge:
      return features_.coplanarity();
  }
  return {};
}

/// Where the points are coplanar the functions of one axis are multiples of those of another, so the first axis in
/// which not all of them are zero decides; if all are, the points are on one line, and contact is where no axis
/// separates them (MATH 1.4).
///
/// A vertex p and an edge ab: A = a - p, B = b - p. There is contact if and only if 0 is in the segment AB. That
/// implies A x B = 0 and that no axis separates. Conversely, if A x B = 0, A = x w and B = y w with w != 0 in some
/// coordinate; if this does not separate them strictly, x y <= 0, and 0 is between A and B. Edges of length zero
/// included. Two vertices: contact if and only if their offset is zero in all coordinates, that is if no axis
/// separates.
bool Touching::at(const Root& time) {
  for (const std::size_t axis : axes) {
    const Verdict verdict = verdict_of_moments(axis, time);
    if (verdict == Verdict::no_contact) return false;
    if (verdict == Verdict::contact) return true;
  }
  return std::none_of(axes.begin(), axes.end(), [&](std::size_t axis) { return separated(axis, time); });
}

Verdict Touching::verdict_of_moments(std::size_t axis, const Root& time) {
  std::array<DefiniteSign, 4> signs{};
  const Functions<Quadratic>& z = moments(axis);
  for (std::size_t i = 0; i < z.count; ++i) {
    signs[i] = time.sign(z.of[i]);
    if (verdict(signs) == Verdict::no_contact) return Verdict::no_contact;
  }
  const Verdict result = verdict(signs);
  return features_.pair() == Pair::vertex_edge && result == Verdict::contact ? Verdict::no_contact : result;
}

bool Touching::separated(std::size_t axis, const Root& time) {
  const Functions<Line>& paths = offsets(axis);
  const DefiniteSign first = time.sign(paths.of[0]);
  if (first == DefiniteSign::zero) return false;
  for (std::size_t i = 1; i < paths.count; ++i) {
    if (time.sign(paths.of[i]) != first) return false;
  }
  return true;
}

/// The enclosure as fine as it is wanted; a time after t_max never.
TimeBracket located(Root& time, double tolerance, double t_max) {
  if (!time.is_double() && (!(time.upper() - time.lower() <= tolerance) || time.lower() == 0)) {
    time.narrow_to_neighbours();
  }
  return {time.lower(), std::min(time.upper(), t_max)};
}

/// y: not zero all the time, but at every contact.
std::optional<TimeBracket> first_at_roots(Touching& touching, const Cubic& y, double tolerance, double t_max) {
  if (y.exact[0].sign() == 0 && touching.at(Root::at_0())) return TimeBracket{0, 0};
  for (Root& time : inner_roots(y)) {
    time.narrow();
    if (time.after(t_max)) return std::nullopt;
    if (touching.at(time)) return located(time, tolerance, t_max);
  }
  if (t_max >= 1 && y.exact[3].sign() == 0 && touching.at(Root::at_1())) return TimeBracket{1, 1};
  return std::nullopt;
}

/// Every time may be one of contact: Y = 0 all the time, or the vertex is on the line of the edge. The first contact is
/// at 0 or at a root of one of the moments of any axis in which they are not all zero all the time; or, if there is no
/// such axis, of one of the offsets of any axis in which these are not. Proof: the times of contact are closed; let t >
/// 0 be the first, and none of the functions of the axis zero at t but not all the time. Not all are zero at t then,
/// nor are they close to t, where their signs are the same; and where not all are zero, this axis alone decides (the
/// moments: at(); the offsets: on one line every axis in which the points differ tells whether they are separated). So
/// there is contact before t.
///
/// Of all candidates with contact the smallest lower and the smallest upper ends enclose the first: it is one of them.
std::optional<TimeBracket> first_of_any(Touching& touching, double tolerance, double t_max) {
  if (touching.at(Root::at_0())) return TimeBracket{0, 0};
  std::vector<Cubic> cubics =
      cubics_of_one_axis([&](std::size_t axis) -> const auto& { return touching.moments(axis); });
  if (cubics.empty()) {
    cubics = cubics_of_one_axis([&](std::size_t axis) -> const auto& { return touching.offsets(axis); });
  }
  std::vector<Root> candidates;
  bool end = false;
  for (const Cubic& cubic : cubics) {
    for (Root& time : inner_roots(cubic)) {
      time.narrow();
      if (!time.after(t_max)) candidates.push_back(std::move(time));
    }
    end = end || cubic.exact[3].sign() == 0;
  }
  if (end && t_max >= 1) candidates.push_back(Root::at_1());
  std::sort(candidates.begin(), candidates.end(), [](const Root& a, const Root& b) { return a.lower() < b.lower(); });
  std::optional<TimeBracket> first;
  for (Root& time : candidates) {
    if (first && time.lower() > first->upper) break;
    if (!touching.at(time)) continue;
    const TimeBracket found = located(time, tolerance, t_max);
    first = first ? TimeBracket{std::min(first->lower, found.lower), std::min(first->upper, found.upper)} : found;
  }
  return first;
}

}  // namespace

std::optional<TimeBracket> exact_first_contact(Pair pair, const double* points, double tolerance, double t_max) {
  if (t_max < 0) return std::nullopt;
  if (!(t_max < 1)) t_max = 1;
  Touching touching(pair, points);
  const Cubic y = touching.necessary();
  return is_zero(y) ? first_of_any(touching, tolerance, t_max) : first_at_roots(touching, y, tolerance, t_max);
}

TimeBracket sharpened(Kind kind, const double* points, TimeBracket bracket, double tolerance) {
  if (bracket.upper - bracket.lower <= tolerance && bracket.lower > 0) return bracket;
  const Cubic y = exact::Features(pair_of(kind), points).coplanarity();
  Root time = Root::crossing(y, bracket.lower, bracket.upper);
  time.narrow();
  return located(time, tolerance, bracket.upper);
}

bool exact_contact(Pair pair, const double* points) { return exact_first_contact(pair, points, 1, 1).has_value(); }

}  // namespace tightrope::ccd
