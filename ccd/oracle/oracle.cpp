/// Exact decision of vertex-face and edge-edge queries; the formulation is that of MATH 1.5 and 5 (barycentric products
/// and point-on-segment tests), not the projected quadratics of MATH 1.4.
///
/// With A = a-d, B = b-d, C = c-d: Y = A.(B x C), m1 = B x C, m2 = C x A, m3 = A x B, n = m1 + m2 + m3 = (b-a) x (c-a).
/// Contact needs Y(t) = 0. There, if n(t) != 0, d = (n.m1 a + n.m2 b + n.m3 c) / |n|^2.

#include "ccd/oracle/oracle.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "ccd/oracle/decision.h"
#include "ccd/oracle/root.h"
#include "ccd/oracle/scene.h"

namespace tightrope::ccd::oracle {
namespace {

using enum Corner;

/// Point x on the closed segment pq: (x-p) x (x-q) = 0 and (x-p).(x-q) <= 0.
struct OnSegment {
  Vector cross;
  Form dot;
};

OnSegment on_segment(const IntegerPoints& points, Corner x, Corner p, Corner q) {
  const Vector from_p = difference(points, x, p), from_q = difference(points, x, q);
  return {cross(from_p, from_q), dot(from_p, from_q)};
}

/// Whether all components vanish at `time`. Looks for a component that visibly does not before it proves anything.
bool vanishes(Root& time, const Vector& u) {
  const auto visible = [&](const Form& form) { return time.sign_at_first_sight(form) != 0; };
  if (std::any_of(u.begin(), u.end(), visible)) return false;
  return std::all_of(u.begin(), u.end(), [&](const Form& form) { return time.sign(form) == 0; });
}

/// The predicate "touching at time t" for times with Y(t) = 0, and the times worth asking it.
class Touching {
 public:
  Touching(Kind kind, const IntegerPoints& points, Defect defect) : kind_(kind), points_(points), defect_(defect) {
    const Vector da = difference(points, a, d), db = difference(points, b, d), dc = difference(points, c, d);
    m_[0] = cross(db, dc);
    coplanarity_ = dot(da, m_[0]);
    if (hull_sign(coplanarity_) != 0) return;  // Y has no root: nothing else will be asked
    m_[1] = cross(dc, da);
    m_[2] = cross(da, db);
    n_ = m_[0] + m_[1] + m_[2];
    for (std::size_t i = 0; i < 3; ++i) weights_[i] = dot(n_, m_[i]);
  }

  const Form& coplanarity() const { return coplanarity_; }

  /// Times in [0, 1], all with Y = 0, among which is the first contact if there is one.
  std::vector<Root> candidates() const;

  /// Whether the features touch at `time`, a root of Y.
  bool at(Root& time);

 private:
  std::vector<OnSegment> end_tests() const;
  std::vector<Root> candidates_of_coplanar_motion() const;

  Kind kind_;
  const IntegerPoints& points_;
  Defect defect_;
  Form coplanarity_;  // Y, degree 3
  std::array<Vector, 3> m_;
  Vector n_;
  std::array<Form, 3> weights_;  // G_i = n.m_i, degree 4
};

/// What decides where n = 0, that is where a, b and c are collinear (MATH 1.5). Vertex-face: the face is the union of
/// its sides. Edge-edge: ab and cd touch if and only if an end of one lies on the other; if d is off the line abc that
/// end is c, if not all four points are collinear.
std::vector<OnSegment> Touching::end_tests() const {
  if (kind_ == Kind::vertex_face) {
    return {on_segment(points_, d, a, b), on_segment(points_, d, b, c), on_segment(points_, d, c, a)};
  }
  return {on_segment(points_, c, a, b), on_segment(points_, d, a, b), on_segment(points_, a, c, d),
          on_segment(points_, b, c, d)};
}

bool Touching::at(Root& time) {
  if (!vanishes(time, n_)) {
    // Vertex-face: all weights of d non-negative. Edge-edge: (1-s) a + s b = (1-q) c + q d with d's weights G / |n|^2
    // gives q = 1 / (1 - w3), 1-s = q w1, s = q w2, so the segments meet if and only if w1, w2 >= 0 >= w3.
    const int least = defect_ == Defect::open_features ? 1 : 0;
    const auto weight_fits = [&](std::size_t i) {
      const bool opposite = kind_ == Kind::edge_edge && i == 2;
      return (opposite ? -1 : 1) * time.sign(weights_[i]) >= least;
    };
    return weight_fits(0) && weight_fits(1) && weight_fits(2);
  }
  if (defect_ == Defect::collapsed_never_touches) return false;
  if (defect_ == Defect::collapsed_always_touches) return true;
  const auto holds = [&](const OnSegment& test) { return vanishes(time, test.cross) && time.sign(test.dot) <= 0; };
  const std::vector<OnSegment> tests = end_tests();
  return std::any_of(tests.begin(), tests.end(), holds);
}

std::vector<Root> Touching::candidates() const {
  if (coplanarity_.is_zero()) return candidates_of_coplanar_motion();
  if (defect_ == Defect::sign_change_expected && sgn(coplanarity_[0]) * sgn(coplanarity_[3]) > 0) return {};
  return roots(coplanarity_);
}

/// Y vanishes identically: the points are coplanar at all times. The times of contact are a closed set; where its
/// description by signs is constant between consecutive candidates, its least element is a candidate.
std::vector<Root> Touching::candidates_of_coplanar_motion() const {
  std::vector<Root> times = {Root::exactly({0, 0}), Root::exactly({1, 0})};
  if (defect_ == Defect::coplanar_motion_only_at_ends) return times;
  const auto add_roots = [&](const Form& form) {
    for (Root& root : roots(form)) times.push_back(std::move(root));
  };
  const auto add_common_roots = [&](const Vector& u) {  // the roots of one component, among which they are
    const auto component = std::find_if(u.begin(), u.end(), [](const Form& form) { return !form.is_zero(); });
    if (component != u.end()) add_roots(*component);
  };
  if (!is_zero(n_)) {
    // All m_i(t) and n(t) are normal to one plane, parallel, so G_i(t) = 0 if and only if m_i(t) = 0 or n(t) = 0.
    add_common_roots(n_);
    for (const Vector& m : m_) add_common_roots(m);
    return times;
  }
  for (const OnSegment& test : end_tests()) {  // n(t) = 0 at all times: only the end tests decide
    add_common_roots(test.cross);
    if (!test.dot.is_zero()) add_roots(test.dot);
  }
  return times;
}

/// Times of contact: `first`: those among which is the first one; otherwise one of them, if there is any.
std::vector<Root> contact_times(Kind kind, std::span<const double, 24> points, Defect defect, bool first) {
  if (!std::all_of(points.begin(), points.end(), [](double x) { return std::isfinite(x); })) {
    std::fputs("oracle: a coordinate is not finite; callers reject such queries\n", stderr);
    std::abort();
  }
  if (swept_boxes_apart(kind, points)) return {};
  const IntegerPoints integers = integer_points(kind, points);
  Touching touching(kind, integers, defect);
  if (hull_sign(touching.coplanarity()) != 0) return {};
  const bool unordered = touching.coplanarity().is_zero();
  std::vector<Root> found;
  for (Root& time : touching.candidates()) {
    if (!touching.at(time)) continue;
    found.push_back(std::move(time));
    if (!first || !unordered) break;
  }
  return found;
}

}  // namespace

std::optional<Contact> first_contact(Kind kind, std::span<const double, 24> points, Defect defect) {
  // The order of times is that of their enclosures, lower end first, unless the enclosures are equal: a double comes
  // before every time strictly between it and the next.
  std::optional<Contact> first;
  for (const Root& time : contact_times(kind, points, defect, true)) {
    const Contact contact = time.enclosure();
    if (!first || contact.lower < first->lower || (contact.lower == first->lower && contact.upper < first->upper)) {
      first = contact;
    }
  }
  return first;
}

bool contact(Kind kind, std::span<const double, 24> points, Defect defect) {
  return !contact_times(kind, points, defect, false).empty();
}

std::optional<TimeInterval> first_contact(Kind kind, std::span<const double, 24> points, const mpq_class& width,
                                          Defect defect) {
  std::vector<Root> times = contact_times(kind, points, defect, true);
  if (times.empty()) return std::nullopt;
  std::size_t first = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i].compare(times[first]) < 0) first = i;
  }
  return times[first].interval(width);
}

std::optional<TimeInterval> first_contact(Kind kind, std::span<const double, 24> points, const mpq_class& width) {
  return first_contact(kind, points, width, Defect::none);
}

std::optional<Contact> first_contact(Kind kind, std::span<const double, 24> points) {
  return first_contact(kind, points, Defect::none);
}

bool contact(Kind kind, std::span<const double, 24> points) { return contact(kind, points, Defect::none); }

}  // namespace tightrope::ccd::oracle
