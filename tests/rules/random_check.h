#pragma once
/// The random check: one rule case in double or single precision, on operands that are hard on bounds.

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "dsl/evaluate.h"
#include "tests/rules/judge.h"
#include "tests/rules/rule_cases.h"

namespace tightrope::rules {

/// Values and bounds of a kind where rounding, underflow, overflow and cancellation happen.
template <class Real>
class OperandSource {
 public:
  explicit OperandSource(std::uint64_t seed) : random_(seed) {}

  void fill(const RuleCase& rule, std::vector<Interval>& operands) {
    const unsigned regime = pick(8);
    for (std::size_t i = 0; i < operands.size(); ++i) {
      const auto range = rule.operands[i].range;
      Interval& x = operands[i];
      x.centre = within(value(regime, operands, i), range);
      x.radius = rule.operands[i].bounded ? within(radius(x.centre), range) : 0;
    }
  }

 private:
  using Limits = std::numeric_limits<Real>;
  static constexpr int digits = Limits::digits;
  static constexpr int least = Limits::min_exponent - 1;     ///< exponent of the least normal number
  static constexpr int greatest = Limits::max_exponent - 1;  ///< of the largest

  unsigned pick(unsigned n) { return static_cast<unsigned>((random_() >> 32) % n); }
  int between(int low, int high) { return low + static_cast<int>(pick(static_cast<unsigned>(high - low + 1))); }

  /// In [1, 2): all bits, few bits (whose sums and products are ties), next to 1, or next to 2.
  double significand() {
    const int kind = between(0, 3);
    if (kind == 0) return 1 + std::ldexp(static_cast<double>(random_() >> (65 - digits)), 1 - digits);
    if (kind == 1) return 1 + std::ldexp(static_cast<double>(pick(1 << 10)), -between(1, digits - 1) / 2 - 10);
    const double ulps = std::ldexp(static_cast<double>(pick(4)), 1 - digits);
    return kind == 2 ? 1 + ulps : 2 - ulps - std::ldexp(1.0, 1 - digits);
  }

  /// Rounded to the format, never infinite.
  static double held(double x) {
    const Real y = static_cast<Real>(x);
    return std::isfinite(y) ? static_cast<double>(y) : std::copysign(static_cast<double>(Limits::max()), x);
  }

  double of_exponent(int exponent) {
    const double x = std::ldexp(significand(), std::clamp(exponent, least - digits, greatest));
    return held(pick(2) ? x : -x);
  }

  static int exponent_of(double x) { return x == 0 ? least : std::ilogb(x); }

  double value(unsigned regime, const std::vector<Interval>& operands, std::size_t i) {
    if (pick(64) == 0) return 0;
    const double before = i == 0 ? 0 : operands[i - 1].centre;
    const int e = exponent_of(before);
    switch (i == 0 ? (regime == 7 ? 7 : regime % 2) : regime) {
      case 0:  // anywhere
        return of_exponent(between(least - digits, greatest));
      case 1:  // of a size
        return of_exponent((i == 0 ? 0 : e) + between(-3, 3));
      case 2: {  // a sum that cancels but for some ulps
        const Real near = static_cast<Real>(-before);
        const Real other = static_cast<Real>(before * (1 + std::ldexp(static_cast<double>(pick(8)), 1 - digits)));
        return pick(2) ? held(pick(2) ? near : -near) : held(pick(2) ? other : -other);
      }
      case 3:  // a product that underflows or all but does
        return of_exponent(least - e + between(-digits - 4, 4));
      case 4:  // a product that overflows or all but does
        return of_exponent(greatest - e + between(-4, 2));
      case 5:  // a quotient that underflows or overflows
        return of_exponent(pick(2) ? e - least + between(-4, digits + 4) : e - greatest + between(-4, 4));
      case 6:  // an ulp of the operand before, more or less
        return of_exponent(e - digits + between(-3, 3));
      default:  // subnormal
        return of_exponent(least - between(0, digits));
    }
  }

  /// From nothing to much more than the value; often the value itself, or what its rounding error is.
  double radius(double centre) {
    const double size = std::abs(centre);
    switch (pick(8)) {
      case 0:
        return 0;
      case 1:
        return size;
      case 2:
        return held(std::ldexp(size, -digits));
      case 3:
        return held(std::ldexp(size * significand(), between(-digits - 3, -1)));
      case 4:
        return held(std::ldexp(size * significand(), between(-2, 40)));
      case 5:
        return std::abs(of_exponent(least - between(0, digits)));
      case 6:
        return std::abs(of_exponent(between(least - digits, greatest)));
      default:
        return held(size * (1 - std::ldexp(significand(), -between(1, digits))));
    }
  }

  /// Where a declared range asks for it, the range itself or scaled down by a power of two.
  double within(double x, std::optional<double> range) {
    if (!range || std::abs(x) <= *range) return x;
    if (pick(4) == 0) return std::copysign(*range, x);
    return held(std::ldexp(x, std::ilogb(*range) - std::ilogb(x) - 1));
  }

  std::mt19937_64 random_;
};

struct RandomTally {
  bool refused = false;
  std::int64_t samples = 0;
  std::int64_t certain = 0;  ///< with a finite bound
  std::int64_t violations = 0;
  std::string counterexample;
};

template <class Real>
class RandomCheck {
 public:
  using Wide = std::conditional_t<std::is_same_v<Real, double>, long double, double>;

  RandomCheck(const RuleCase& rule, codegen::BoundMode mode, codegen::Weakening weakening)
      : rule_(rule), predicate_(predicate_of(rule)), judge_(predicate_, rule.turns_at_zero, false) {
    const auto precision = std::is_same_v<Real, double> ? codegen::Precision::binary64 : codegen::Precision::binary32;
    dsl::Diagnostics diagnostics;
    bounded_ = codegen::add_bounds(predicate_, mode, precision, diagnostics, weakening);
    refused_ = diagnostics.has_errors() || bounded_.stages.empty();
  }

  bool refused() const { return refused_; }
  /// Two checks whose texts differ have different bounds.
  std::string text() const {
    return dsl::print(bounded_.graph) + std::to_string(bounded_.stages[0].outputs[0].elements[0].bound);
  }

  /// `samples` operands, in batches: each node is evaluated for a whole batch at once.
  RandomTally run(std::int64_t samples, std::uint64_t seed, std::int64_t most_violations) {
    RandomTally tally;
    tally.refused = refused_;
    if (refused_) return tally;
    OperandSource<Real> source(seed);
    const std::size_t n = predicate_.slots.size();
    std::vector<std::vector<Interval>> operands(batch, std::vector<Interval>(n));
    slots_.assign(2 * n, std::vector<Real>(batch));
    values_.assign(static_cast<std::size_t>(bounded_.graph.size()), std::vector<Real>(batch));
    while (tally.samples < samples && tally.violations < most_violations) {
      for (std::size_t k = 0; k < batch; ++k) {
        source.fill(rule_, operands[k]);
        for (std::size_t i = 0; i < n; ++i) {
          slots_[i][k] = static_cast<Real>(operands[k][i].centre);
          slots_[n + i][k] = static_cast<Real>(operands[k][i].radius);
        }
      }
      for (dsl::NodeId id = 0; id < bounded_.graph.size(); ++id) evaluate(id);
      for (std::size_t k = 0; k < batch; ++k) judge(operands[k], k, tally);
    }
    return tally;
  }

 private:
  static constexpr std::size_t batch = 256;

  void evaluate(dsl::NodeId id) {
    const dsl::Node& n = bounded_.graph[id];
    std::vector<Real>& out = values_[static_cast<std::size_t>(id)];
    const auto all = [&out](const auto& of) {
      for (std::size_t k = 0; k < batch; ++k) out[k] = of(k);
    };
    const std::vector<Real>& a = values_[static_cast<std::size_t>(std::max(n.a, 0))];
    const std::vector<Real>& b = values_[static_cast<std::size_t>(std::max(n.b, 0))];
    switch (n.op) {
      case dsl::Op::input:
        out = slots_[static_cast<std::size_t>(n.index)];
        return;
      case dsl::Op::add:
        return all([&](std::size_t k) { return a[k] + b[k]; });
      case dsl::Op::sub:
        return all([&](std::size_t k) { return a[k] - b[k]; });
      case dsl::Op::mul:
        return all([&](std::size_t k) { return a[k] * b[k]; });
      case dsl::Op::div:
        return all([&](std::size_t k) { return a[k] / b[k]; });
      case dsl::Op::abs:
        return all([&](std::size_t k) { return std::abs(a[k]); });
      case dsl::Op::constant:
      case dsl::Op::neg:
      case dsl::Op::mul_pow2:
      case dsl::Op::sqrt:
      case dsl::Op::min:
      case dsl::Op::max:
      case dsl::Op::fma:
      case dsl::Op::certain_nonzero:
      case dsl::Op::certain_nonnegative:
      case dsl::Op::normalizer:
      case dsl::Op::max_magnitude:
      case dsl::Op::select:
        break;
    }
    all([&](std::size_t k) {
      const auto at = [&](dsl::NodeId operand) { return values_[static_cast<std::size_t>(operand)][k]; };
      return dsl::evaluate_node<Real>(n, std::span<const Real>(), at);
    });
  }

  void judge(const std::vector<Interval>& operands, std::size_t k, RandomTally& tally) const {
    ++tally.samples;
    const codegen::BoundedNode result = bounded_.stages[0].outputs[0].elements[0];
    const double value = static_cast<double>(values_[static_cast<std::size_t>(result.value)][k]);
    const double bound = static_cast<double>(values_[static_cast<std::size_t>(result.bound)][k]);
    if (!std::isfinite(bound) || std::isnan(value)) return;
    ++tally.certain;
    if (std::isfinite(value) && !judge_.violated(operands, value, bound)) return;
    if (tally.violations++ > 0) return;
    tally.counterexample = fmt::format("{:a} +- {:a} for", value, bound);
    for (const Interval& x : operands) tally.counterexample += fmt::format(" [{:a} +- {:a}]", x.centre, x.radius);
  }

  const RuleCase& rule_;
  dsl::Predicate predicate_;
  Judge<Wide> judge_;
  codegen::BoundedPredicate bounded_;
  bool refused_ = false;
  std::vector<std::vector<Real>> slots_, values_;
};

}  // namespace tightrope::rules
