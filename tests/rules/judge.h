#pragma once
/// Decides whether a value with its bound covers the exact results of all exact operands that its inputs stand for.

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "dsl/program.h"
#include "tests/rules/surd.h"

namespace tightrope::rules {

/// An operand as a bound rule sees it: an exact number in [centre - radius, centre + radius].
struct Interval {
  double centre = 0;
  double radius = 0;
};

/// |v - exact| <= e, running error analysis in a wide type: decides all but the closest cases without exact numbers.
/// The constant covers the roundings of e as well; `tiny` covers underflow.
template <class Wide>
struct Approximation {
  Wide v = 0;
  Wide e = 0;

  static constexpr Wide unit = 4 * std::numeric_limits<Wide>::epsilon();
  static constexpr Wide tiny = 4 * std::numeric_limits<Wide>::min();
  static Approximation rounded(Wide v, Wide e) { return {v, e * (1 + unit) + std::abs(v) * unit + tiny}; }

  friend Approximation operator-(Approximation a) { return {-a.v, a.e}; }
  friend Approximation operator+(Approximation a, Approximation b) { return rounded(a.v + b.v, a.e + b.e); }
  friend Approximation operator-(Approximation a, Approximation b) { return rounded(a.v - b.v, a.e + b.e); }
  friend Approximation operator*(Approximation a, Approximation b) {
    return rounded(a.v * b.v, std::abs(a.v) * b.e + a.e * (std::abs(b.v) + b.e));
  }
  /// The caller sees to it that b is not around 0.
  friend Approximation operator/(Approximation a, Approximation b) {
    const Wide q = a.v / b.v;
    return rounded(q, (a.e + std::abs(q) * (1 + unit) * b.e) / ((std::abs(b.v) - b.e) * (1 - unit)));
  }
  friend Approximation sqrt(Approximation a) {
    const Wide v = std::max(a.v, Wide(0));
    const Wide root = std::sqrt(v);
    const Wide direct = std::sqrt(a.e) * (1 + unit);
    return rounded(root, v > a.e ? std::min(direct, a.e / (root * (1 - unit))) : direct * 2);
  }
  friend Approximation mul_pow2(Approximation a, int k) { return rounded(std::ldexp(a.v, k), std::ldexp(a.e, k)); }
  friend Approximation abs(Approximation a) { return {std::abs(a.v), a.e}; }
  friend Approximation min(Approximation a, Approximation b) { return {std::min(a.v, b.v), std::max(a.e, b.e)}; }
  friend Approximation max(Approximation a, Approximation b) { return {std::max(a.v, b.v), std::max(a.e, b.e)}; }
  friend Approximation fma(Approximation a, Approximation b, Approximation c) { return a * b + c; }
};

enum class Verdict { holds, violated, undecided };

/// Judges one predicate of one output with `Wide` arithmetic first, then exactly. Where an operation is not defined for
/// some of the exact operands (a divisor may be 0, a radicand negative), every finite bound is a violation.
template <class Wide>
class Judge {
 public:
  /// `few_bits`: all operands and bounds have so few bits that sums and products of them are exact in `Wide`.
  Judge(const dsl::Predicate& predicate, bool turns_at_zero, bool few_bits)
      : graph_(predicate.graph),
        output_(predicate.stages[0].outputs[0].nodes[0]),
        operands_(predicate.slots.size()),
        turns_at_zero_(turns_at_zero),
        wide_is_exact_(few_bits) {
    for (dsl::NodeId id = 0; id < graph_.size(); ++id) {
      if (graph_[id].op == dsl::Op::div || graph_[id].op == dsl::Op::sqrt) wide_is_exact_ = false;
    }
    assert(graph_.size() <= most_nodes && operands_ <= most_operands);
  }

  /// Value and bound are finite.
  bool violated(std::span<const Interval> operands, double value, double bound) const {
    if (wide_is_exact_) return over_corners<Wide>(operands, value, bound) == Verdict::violated;
    const Verdict quick = over_corners<Approximation<Wide>>(operands, value, bound);
    if (quick != Verdict::undecided) return quick == Verdict::violated;
    return over_corners<Surd>(operands, value, bound) == Verdict::violated;
  }

 private:
  static constexpr int most_nodes = 12;
  static constexpr std::size_t most_operands = 6;
  template <class Number>
  using Values = std::array<Number, most_nodes>;

  static Approximation<Wide> end_point(const Interval& x, int side, const Approximation<Wide>*) {
    if (side == 2 || (side == 0 && x.radius == 0)) return {side == 2 ? Wide(0) : Wide(x.centre), 0};
    const Wide v = side == 0 ? Wide(x.centre) - Wide(x.radius) : Wide(x.centre) + Wide(x.radius);
    return Approximation<Wide>::rounded(v, 0);
  }
  static Surd end_point(const Interval& x, int side, const Surd*) {
    if (side == 2) return Surd(DyadicRatio());
    const DyadicRatio radius(x.radius);
    return Surd(DyadicRatio(x.centre) + (side == 0 ? -radius : radius));
  }

  static Wide end_point(const Interval& x, int side, const Wide*) {
    return side == 2 ? Wide(0) : Wide(x.centre) + Wide(side == 0 ? -x.radius : x.radius);
  }

  static Wide constant(double c, const Wide*) { return Wide(c); }
  static Approximation<Wide> constant(double c, const Approximation<Wide>*) { return {Wide(c), 0}; }
  static Surd constant(double c, const Surd*) { return Surd(DyadicRatio(c)); }

  /// -1, 0, +1, or 2 if unknown.
  static int sign(const Approximation<Wide>& a) { return a.v > a.e ? 1 : a.v < -a.e ? -1 : 2; }
  static int sign(const Surd& a) { return a.sign(); }
  static int sign(Wide a) { return a > 0 ? 1 : a < 0 ? -1 : 0; }

  static Verdict covers(double value, double bound, const Approximation<Wide>& exact) {
    const Wide distance = std::abs(Wide(value) - exact.v);
    const Wide doubt = exact.e + distance * Approximation<Wide>::unit + Approximation<Wide>::tiny;
    if (distance + 2 * doubt <= Wide(bound)) return Verdict::holds;
    return distance - 2 * doubt > Wide(bound) ? Verdict::violated : Verdict::undecided;
  }
  static Verdict covers(double value, double bound, const Surd& exact) {
    const Surd error = exact - Surd(DyadicRatio(value));
    const Surd limit{DyadicRatio(bound)};
    return (limit - error).sign() >= 0 && (limit + error).sign() >= 0 ? Verdict::holds : Verdict::violated;
  }

  static Verdict covers(double value, double bound, Wide exact) {
    return std::abs(Wide(value) - exact) <= Wide(bound) ? Verdict::holds : Verdict::violated;
  }

  template <class Number>
  Verdict over_corners(std::span<const Interval> operands, double value, double bound) const {
    std::array<int, most_operands> sides{};
    std::array<int, most_operands> last{};
    for (std::size_t i = 0; i < operands_; ++i) {
      const bool around_zero = std::abs(operands[i].centre) < operands[i].radius;
      last[i] = operands[i].radius == 0 ? 0 : turns_at_zero_ && around_zero ? 2 : 1;
    }
    std::array<int, most_nodes> divisor_signs{};
    Verdict all = Verdict::holds;
    for (;;) {
      std::array<Number, most_operands> inputs;
      for (std::size_t i = 0; i < operands_; ++i) {
        inputs[i] = end_point(operands[i], sides[i], static_cast<const Number*>(nullptr));
      }
      const Verdict one = at_corner<Number>(inputs, divisor_signs, value, bound);
      if (one == Verdict::violated) return one;
      if (one == Verdict::undecided) all = one;
      std::size_t i = 0;
      while (i < operands_ && sides[i] == last[i]) sides[i++] = 0;
      if (i == operands_) return all;
      ++sides[i];
    }
  }

  /// `divisor_signs`: of every divisor at the corners before, 0 for none yet; it must stay the same.
  template <class Number>
  Verdict at_corner(const std::array<Number, most_operands>& inputs, std::array<int, most_nodes>& divisor_signs,
                    double value, double bound) const {
    Values<Number> v{};
    const auto at = [&v](dsl::NodeId id) -> const Number& { return v[static_cast<std::size_t>(id)]; };
    for (dsl::NodeId id = 0; id <= output_; ++id) {
      const dsl::Node& n = graph_[id];
      if (n.op == dsl::Op::div || n.op == dsl::Op::sqrt) {
        const int s = sign(at(n.op == dsl::Op::div ? n.b : n.a));
        if (s == 2) return Verdict::undecided;
        int& before = divisor_signs[static_cast<std::size_t>(id)];
        if (n.op == dsl::Op::div && (s == 0 || s == -before)) return Verdict::violated;
        if (n.op == dsl::Op::sqrt && s < 0) return Verdict::violated;
        before = s;
      }
      v[static_cast<std::size_t>(id)] = evaluate<Number>(n, inputs, at);
    }
    return covers(value, bound, at(output_));
  }

  template <class Number, class Operands>
  static Number evaluate(const dsl::Node& n, const std::array<Number, most_operands>& inputs, const Operands& at) {
    using dsl::Op;
    using std::abs, std::sqrt, std::min, std::max, std::fma;
    switch (n.op) {
      case Op::input:
        return inputs[static_cast<std::size_t>(n.index)];
      case Op::constant:
        return constant(n.value, static_cast<const Number*>(nullptr));
      case Op::add:
        return at(n.a) + at(n.b);
      case Op::sub:
        return at(n.a) - at(n.b);
      case Op::neg:
        return -at(n.a);
      case Op::mul:
        return at(n.a) * at(n.b);
      case Op::mul_pow2:
        if constexpr (std::is_floating_point_v<Number>) {
          return std::ldexp(at(n.a), n.index);
        } else {
          return mul_pow2(at(n.a), n.index);
        }
      case Op::div:
        return at(n.a) / at(n.b);
      case Op::sqrt:
        return sqrt(at(n.a));
      case Op::abs:
        return abs(at(n.a));
      case Op::min:
        return min(at(n.a), at(n.b));
      case Op::max:
        return max(at(n.a), at(n.b));
      case Op::fma:
        return fma(at(n.a), at(n.b), at(n.c));
      case Op::select:  // conditions are exact operands: an unknown sign is that of 0
        return sign(at(n.a)) != -1 ? at(n.b) : at(n.c);
      case Op::certain_nonzero:
      case Op::certain_nonnegative:
      case Op::normalizer:
      case Op::max_magnitude:
        break;
    }
    assert(false && "operations of bounds are not in rule cases");
    return {};
  }

  const dsl::Graph& graph_;
  dsl::NodeId output_;
  std::size_t operands_;
  bool turns_at_zero_;
  bool wide_is_exact_;
};

}  // namespace tightrope::rules
