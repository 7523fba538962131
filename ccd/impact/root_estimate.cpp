#include "ccd/impact/root_estimate.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace tightrope::ccd {
namespace {

struct ValueAndSlope {
  double value, slope;
};

ValueAndSlope evaluate(const std::array<double, 4>& k, double t) {
  const double s = 1 - t;
  const double p0 = k[0] * s + k[1] * t, p1 = k[1] * s + k[2] * t, p2 = k[2] * s + k[3] * t;
  const double r0 = p0 * s + p1 * t, r1 = p1 * s + p2 * t;
  return {r0 * s + r1 * t, 3 * (r1 - r0)};
}

/// Ends of the parts of [0, 1] where the cubic is monotone.
struct Parts {
  std::array<double, 4> end{0, 0, 0, 0};
  std::size_t count = 0;
};

Parts monotone_parts(const std::array<double, 4>& k) {
  const double q0 = k[1] - k[0], q1 = k[2] - k[1], q2 = k[3] - k[2];
  const double a = (q0 - q1) - (q1 - q2), b = q1 - q0;  // a t^2 + 2 b t + q0 = 0
  const double root = std::sqrt(std::max(b * b - a * q0, 0.0));
  const double w = -(b + (b < 0 ? -root : root));
  double x = w / a, y = q0 / w;
  if (!(x <= y)) std::swap(x, y);
  Parts parts;
  for (const double t : {x, y}) {
    if (t > 0 && t < 1) parts.end[++parts.count] = t;
  }
  parts.end[++parts.count] = 1;
  return parts;
}

/// Between two numbers >= 0: of very different magnitudes the middle of their exponents.
double middle(double a, double b) {
  if (b <= 4 * a) return a + (b - a) / 2;
  const auto x = std::bit_cast<std::uint64_t>(a), y = std::bit_cast<std::uint64_t>(b);
  return std::bit_cast<double>(x + (y - x) / 2);
}

}  // namespace

/// Newton's method, kept in (a, b) by bisection.
double crossing_estimate(const std::array<double, 4>& k, double a, double b, bool rising) {
  const double at_a = evaluate(k, a).value, at_b = evaluate(k, b).value;
  double t = a + (b - a) * (at_a / (at_a - at_b));
  for (int i = 0; i < 80; ++i) {
    if (!(t > a && t < b)) t = middle(a, b);
    const auto [value, slope] = evaluate(k, t);
    if (value == 0 || t <= a || t >= b) break;
    ((value < 0) == rising ? a : b) = t;
    const double next = t - value / slope;
    if (std::fabs(next - t) <= 0x1p-53 * t) break;
    t = next;
  }
  return t;
}

double root_estimate(const std::array<double, 4>& k, int index) {
  const auto first = std::find_if(k.begin(), k.end(), [](double x) { return x != 0; });
  if (first == k.end()) return 0.5;
  const Parts parts = monotone_parts(k);
  bool negative = *first < 0;
  double nearest = 0.5, height = 0;
  for (std::size_t i = 0; i < parts.count; ++i) {
    const double value = evaluate(k, parts.end[i + 1]).value;
    if (value != 0 && (value < 0) != negative) {
      if (index == 0) return crossing_estimate(k, parts.end[i], parts.end[i + 1], negative);
      --index;
      negative = !negative;
    }
    if (i == 0 || std::fabs(value) < height) {
      nearest = parts.end[i + 1];
      height = std::fabs(value);
    }
  }
  return nearest;  // an extremum that floating point does not tell from a double root
}

}  // namespace tightrope::ccd
