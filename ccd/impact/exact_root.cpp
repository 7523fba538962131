#include "ccd/impact/exact_root.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>

#include "ccd/impact/root_estimate.h"
#include "classification.exact.double.h"
#include "exact_roots.exact.double.h"
#include "exact_roots.tight.double.h"

namespace tightrope::ccd::exact {
namespace {

DefiniteSign sign_of(const Dyadic& x) { return static_cast<DefiniteSign>(x.sign()); }
DefiniteSign sign_of(const std::optional<Dyadic>& x) { return sign_of(*x); }
Dyadic magnitude_of(const Dyadic& x) { return abs(x); }

std::uint64_t pattern(double x) { return std::bit_cast<std::uint64_t>(x); }
double number(std::uint64_t pattern) { return std::bit_cast<double>(pattern); }

/// 16 times as far; at last as far as no two doubles in [0, 1] are.
std::uint64_t farther(std::uint64_t distance) { return distance < std::uint64_t{1} << 58 ? 16 * distance : pattern(1); }

/// 1 - t and its rounding error.
Bounded<double> complement(double t) { return {1 - t, (1 - t) * 0x1p-53}; }

/// Where a linear function whose ends have opposite signs, or one of whose ends is zero, is zero.
Ratio zero_of(const Line& f) { return {magnitude_of(f[1]), magnitude_of(f[0])}; }

template <std::size_t N>
std::array<DefiniteSign, N> signs_of(const std::array<Dyadic, N>& numbers) {
  std::array<DefiniteSign, N> signs;
  for (std::size_t i = 0; i < N; ++i) signs[i] = sign_of(numbers[i]);
  return signs;
}

template <std::size_t N>
bool all_equal(const std::array<DefiniteSign, N>& signs) {
  return std::all_of(signs.begin(), signs.end(), [&](DefiniteSign s) { return s == signs[0]; });
}

/// The common definite sign; zero if there is none.
template <std::size_t N>
DefiniteSign common_sign(const Bounded<double> (&numbers)[N]) {
  const Sign first = tightrope::sign(numbers[0]);
  for (const Bounded<double>& x : numbers) {
    if (tightrope::sign(x) != first) return DefiniteSign::zero;
  }
  return static_cast<DefiniteSign>(first);
}

PartSigns exact_part_signs(const Cubic& k, const Ratio& r) {
  const auto until = generated::cubic_until<bound::exact, double>::evaluate_values(k.exact.data(), r.s, r.t);
  return {sign_of(until.part[0]), sign_of(until.part[1]), sign_of(until.part[2])};
}

/// The same in floating point; empty if one of the last `needed` signs is uncertain.
std::optional<PartSigns> near_part_signs(const Cubic& k, const Bounded<double>& s, const Bounded<double>& t,
                                         std::size_t needed) {
  const auto until = generated::cubic_until<bound::tight, double>::evaluate(k.near.data(), s, t);
  PartSigns signs{};
  for (std::size_t i = 3 - needed; i < 3; ++i) {
    const Sign s_i = tightrope::sign(until.part[i]);
    if (s_i == Sign::uncertain) return std::nullopt;
    signs[i] = static_cast<DefiniteSign>(s_i);
  }
  return signs;
}

/// Quotient and remainder of a cubic by a quadratic: square * Y = j * m + n (MATH 2.5).
struct Division {
  Line m, n;
};

Division division(const Cubic& k, const Quadratic& j) {
  using predicate = generated::quadratic_at_roots<bound::exact, double>;
  const auto cofactor = predicate::cofactor_values(k.exact.data(), j.exact.data());
  const auto remainder = predicate::remainder_values(k.exact.data(), j.exact.data());
  return {{*cofactor.m[0], *cofactor.m[1]}, {*remainder.n[0], *remainder.n[1]}};
}

bool is_linear(const Quadratic& j) {
  const auto shape = generated::bend_of_quadratic<bound::exact, double>::evaluate_values(j.exact.data());
  return sign_of(shape.bend) == DefiniteSign::zero;
}

bool is_linear(const Cubic& k) {
  const auto shape = generated::bends_of_cubic<bound::exact, double>::evaluate_values(k.exact.data());
  return sign_of(shape.bend[0]) == DefiniteSign::zero && sign_of(shape.bend[1]) == DefiniteSign::zero;
}

DefiniteSign sign_at(const Quadratic& j, const Ratio& r) {
  return sign_of(generated::quadratic_at<bound::exact, double>::evaluate_values(j.exact.data(), r.s, r.t).height);
}
DefiniteSign sign_at(const Line& l, const Ratio& r) {
  return sign_of(generated::line_at<bound::exact, double>::evaluate_values(l.data(), r.s, r.t).height);
}

}  // namespace

/// How many of the roots are less than the x whose part signs are given. If all roots of the cubic are real, which they
/// are if several are in (0, 1) (inner_roots), it has as many in (0, x) as its coefficients over [0, x] change their
/// sign (MATH 3.6).
int Root::earlier_roots(const PartSigns& part) const {
  return sign_changes<4>({sign_of(cubic_->exact[0]), part[0], part[1], part[2]});
}

/// The sign of (this - x), x in (0, 1); if this is the only root in the enclosure, x strictly inside of that.
DefiniteSign Root::order(const PartSigns& part) const {
  if (count_ == 1) return part[2] * before_;
  const int earlier = earlier_roots(part);
  if (earlier > index_) return DefiniteSign::negative;
  return earlier == index_ ? part[2] * part[2] : DefiniteSign::positive;
}

DefiniteSign Root::order(const Ratio& other) const {
  if (is_ratio()) return sign_at(Line{-other.t, other.s}, ratio_);
  return order(exact_part_signs(*cubic_, other));
}

/// The sign of (this - x); if that is 0, this becomes the ratio.
DefiniteSign Root::order(double x) {
  if (!is_ratio()) {
    const auto near = near_part_signs(*cubic_, complement(x), {x, 0}, count_ == 1 ? 1 : 3);
    if (near) return order(*near);
  }
  const Dyadic t(x);
  const Ratio other{Dyadic(1) - t, t};
  const DefiniteSign result = order(other);
  if (result == DefiniteSign::zero) {
    ratio_ = other;
    cubic_ = nullptr;
    lower_ = upper_ = x;
  }
  return result;
}

bool Root::after(double x) {
  if (is_double()) return lower_ > x;
  if (lower_ >= x || x >= upper_) return lower_ >= x;
  return order(x) == DefiniteSign::positive;
}

Root Root::crossing(const Cubic& cubic, double lower, double upper) {
  Root root(cubic, 0, 1, DefiniteSign::positive);
  root.lower_ = lower;
  root.upper_ = upper;
  for (const double end : {upper, lower}) {
    const DefiniteSign sign = root.order(end);
    if (sign == DefiniteSign::zero) return root;
    if (end == lower) root.before_ = sign;
  }
  return root;
}

double Root::estimate() const {
  if (is_ratio()) {
    const std::int64_t unit = -std::max(ratio_.s.high_exponent(), ratio_.t.high_exponent());
    const double s = mul_pow2(ratio_.s, unit).to_double(), t = mul_pow2(ratio_.t, unit).to_double();
    return t / (s + t);
  }
  std::array<double, 4> k;
  for (std::size_t i = 0; i < 4; ++i) k[i] = cubic_->near[i].value;
  if (count_ == 1) return crossing_estimate(k, lower_, upper_, before_ == DefiniteSign::negative);
  return root_estimate(k, index_);
}

std::uint64_t Root::first_step(double estimate) const {
  constexpr std::uint64_t least = 4;
  if (is_ratio()) return least;
  const auto until =
      generated::cubic_until<bound::tight, double>::evaluate(cubic_->near.data(), complement(estimate), {estimate, 0});
  const double rise = magnitude(until.part[1].value - until.part[2].value);  // slope * estimate / 3
  const double ulps = until.part[2].bound / rise * 0x1p53;
  return ulps < 0x1p40 ? least + static_cast<std::uint64_t>(ulps) : least;
}

/// Doubles in [0, 1] are ordered as their bit patterns are, so steps of patterns reach tiny times, too; they grow until
/// they enclose the root.
void Root::narrow() {
  std::uint64_t low = pattern(lower_), high = pattern(upper_);
  if (is_double() || high - low < 2) return;
  const double near = estimate();
  const std::uint64_t start = std::clamp(near > 0 ? pattern(near) : 0, low + 1, high - 1), step = first_step(near);
  for (std::uint64_t distance = step; start - low > distance; distance = farther(distance)) {
    const DefiniteSign side = order(number(start - distance));
    if (side == DefiniteSign::zero) return;
    (side == DefiniteSign::positive ? low : high) = start - distance;
    if (side == DefiniteSign::positive) break;
  }
  for (std::uint64_t distance = step; high > start && high - start > distance; distance = farther(distance)) {
    const DefiniteSign side = order(number(start + distance));
    if (side == DefiniteSign::zero) return;
    (side == DefiniteSign::negative ? high : low) = start + distance;
    if (side == DefiniteSign::negative) break;
  }
  lower_ = number(low);
  upper_ = number(high);
  isolate();
}

/// If there is no other root in the enclosure, the sign of the cubic tells everything from now on.
void Root::isolate() {
  if (is_ratio() || count_ == 1) return;
  const auto earlier = [&](double x) {
    const auto near = near_part_signs(*cubic_, complement(x), {x, 0}, 3);
    const Dyadic t(x);
    return earlier_roots(near ? *near : exact_part_signs(*cubic_, {Dyadic(1) - t, t}));
  };
  if (earlier(lower_) != index_ || earlier(upper_) != index_ + 1) return;
  if (index_ % 2 != 0) before_ = -before_;
  index_ = 0;
  count_ = 1;
}

void Root::narrow_to_neighbours() {
  std::uint64_t low = pattern(lower_), high = pattern(upper_);
  while (high - low > 1) {
    const std::uint64_t between = low + (high - low) / 2;
    const DefiniteSign side = order(number(between));
    if (side == DefiniteSign::zero) return;
    (side == DefiniteSign::positive ? low : high) = between;
  }
  lower_ = number(low);
  upper_ = number(high);
}

/// Where the zero of the line is not in (0, 1), or not in the enclosure, the ends of that tell.
DefiniteSign Root::sign(const Line& l) const {
  if (is_end()) return sign_of(lower_ == 0 ? l[0] : l[1]);
  if (is_ratio()) return sign_at(l, ratio_);
  const DefiniteSign a = sign_of(l[0]), b = sign_of(l[1]);
  if (!opposite(a, b)) return a == DefiniteSign::zero ? b : a;
  const auto ends = generated::line_between<bound::exact, double>::evaluate_values(l.data(), lower_, upper_);
  const DefiniteSign at_lower = sign_of(ends.part[0]);
  const DefiniteSign at_upper = sign_of(ends.part[1]);
  // This time is strictly inside: an end at which the line is zero, which may be another root, says nothing against it.
  if (!opposite(at_lower, at_upper)) return at_lower == DefiniteSign::zero ? at_upper : at_lower;
  return order(zero_of(l)) * b;
}

/// Does the line have opposite signs at the ends of the enclosure?
bool Root::crosses(const Line& l) const {
  if (!opposite(sign_of(l[0]), sign_of(l[1]))) return false;
  const auto ends = generated::line_between<bound::exact, double>::evaluate_values(l.data(), lower_, upper_);
  return opposite(sign_of(ends.part[0]), sign_of(ends.part[1]));
}

DefiniteSign Root::sign(const Quadratic& j) const {
  if (is_end()) return sign_of(lower_ == 0 ? j.exact[0] : j.exact[2]);
  const auto signs = signs_of(j.exact);
  if (all_equal(signs)) return signs[0];
  const auto hull = generated::quadratic_between<bound::tight, double>::evaluate(j.near.data(), lower_, upper_);
  if (const DefiniteSign s = common_sign(hull.part); s != DefiniteSign::zero) return s;
  return is_ratio() ? sign_at(j, ratio_) : sign_by_division(j);
}

/// square * Y = j m + n with linear m and n, square > 0 for a j that is not linear (MATH 2.5): at the root j m = -n. If
/// m vanishes there, this time is the zero of m or, if m is zero everywhere (Y is linear then: Y = n / square), that of
/// n; j is evaluated there.
///
/// Where j vanishes n does, so that this time is the zero of n if n is not zero everywhere. Conversely, if j vanishes
/// at the zero of n so does Y, and if that is in (0, 1), where Y has but one root, it is this time. j has a lower
/// degree than Y: asked first.
DefiniteSign Root::sign_by_division(const Quadratic& j) const {
  if (is_linear(j)) return sign(Line{j.exact[0], j.exact[2]});
  const auto [m, n] = division(*cubic_, j);
  if (count_ == 1 && crosses(n) && sign_at(j, zero_of(n)) == DefiniteSign::zero) return DefiniteSign::zero;
  if (const DefiniteSign on_m = sign(m); on_m != DefiniteSign::zero) return -(on_m * sign(n));
  return sign_at(j, zero_of(is_zero(m) ? n : m));
}

/// With binomial coefficients multiplied in, the Bernstein coefficients are those of a binary form in (1 - t, t); its
/// real roots in (0, 1) are those of positive ratio. Descartes: sign changes of k are their number, with multiplicity,
/// or more by 2 d; more only if there are roots that are not real (MATH 3.6).
std::vector<Root> inner_roots(const Cubic& k) {
  std::vector<Root> roots;
  const auto signs = signs_of(k.exact);
  int count = sign_changes(signs);
  if (count == 0) return roots;
  if (count == 1 && is_linear(k)) return {Root(zero_of(Line{k.exact[0], k.exact[3]}), 0, 1)};
  const DefiniteSign before = *std::find_if(signs.begin(), signs.end(), [](auto s) { return s != DefiniteSign::zero; });
  DefiniteSign determinant = DefiniteSign::positive;
  std::array<Dyadic, 3> h;
  if (count > 1) {
    const auto form = generated::hessian<bound::exact, double>::evaluate_values(k.exact.data());
    determinant = sign_of(form.determinant);
    for (std::size_t i = 0; i < 3; ++i) h[i] = *form.h[i];
  }
  switch (determinant) {
    case DefiniteSign::negative:
      if (count == 3) roots.push_back(Root(k, 0, 1, before));
      break;
    case DefiniteSign::positive:
      for (int i = 0; i < count; ++i) roots.push_back(Root(k, i, count, before));
      break;
    case DefiniteSign::zero: {
      // The form is a^2 b, its Hessian a multiple of a^2; if a = b the Hessian is zero, and the form a^3.
      const bool triple = h[0].sign() == 0 && h[1].sign() == 0 && h[2].sign() == 0;
      const Ratio multiple = triple ? zero_of(Line{k.exact[0], k.exact[1]}) : zero_of(Line{h[0], h[1]});
      roots.push_back(Root(multiple, 0, 1));
      if (triple || count == 2) break;
      const auto part = exact_part_signs(k, multiple);
      const bool first = sign_changes<4>({signs[0], part[0], part[1], part[2]}) == 1;
      roots.insert(first ? roots.begin() : roots.end(), Root(k, first ? 0 : 2, count, before));
      break;
    }
  }
  return roots;
}

}  // namespace tightrope::ccd::exact
