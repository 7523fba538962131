/// random_rules [--pairs N] [--rule TEXT] [--mode MODE] [--real double|float] [--seed S] [--weakened]
///
/// Checks every rule whose name contains TEXT on N random operands with their bounds, in double and single precision.
/// A line a rule; exit status 1 if a bound was below an error. With --weakened, one term after the other is left out,
/// each rule stops at its first violation, and the exit status is 1 if some term is missed by no rule of a mode.

#include <fmt/core.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include "tests/rules/random_check.h"

namespace tightrope::rules {
namespace {

using codegen::BoundMode;
using codegen::Weakening;

struct Options {
  double pairs = 1e5;
  std::string rule, mode, real;
  std::uint64_t seed = 20261122;
  bool weakened = false;
};

/// False if the arguments are not understood.
bool parse(int count, char** arguments, Options& options) {
  for (int i = 1; i < count; ++i) {
    const std::string name = arguments[i];
    if (name == "--weakened") {
      options.weakened = true;
      continue;
    }
    if (i + 1 == count) return false;
    const std::string value = arguments[++i];
    if (name == "--pairs") {
      options.pairs = std::atof(value.c_str());
    } else if (name == "--rule") {
      options.rule = value;
    } else if (name == "--mode") {
      options.mode = value;
    } else if (name == "--real") {
      options.real = value;
    } else if (name == "--seed") {
      options.seed = std::strtoull(value.c_str(), nullptr, 10);
    } else {
      return false;
    }
  }
  return true;
}

class Campaign {
 public:
  explicit Campaign(const Options& options) : options_(options) {}

  int run() {
    for (const BoundMode mode : {BoundMode::tight, BoundMode::safe, BoundMode::fixed, BoundMode::interval}) {
      if (!options_.mode.empty() && options_.mode != name(mode)) continue;
      for (const RuleCase& rule : rule_cases()) {
        if (rule.name.find(options_.rule) == std::string::npos) continue;
        if (options_.real != "float") check<double>(rule, mode, "double");
        if (options_.real != "double") check<float>(rule, mode, "float");
      }
    }
    if (options_.weakened) return report_terms();
    fmt::print("{} rules, {:.4g} pairs, {:.4g} with a bound, {} violations\n", rules_, pairs_, certain_, violations_);
    return violations_ > 0 || rules_ == 0 ? 1 : 0;
  }

 private:
  template <class Real>
  void check(const RuleCase& rule, BoundMode mode, const char* real) {
    RandomCheck<Real> sound(rule, mode, Weakening::none);
    if (sound.refused()) return;
    if (options_.weakened) return weaken<Real>(rule, mode, sound.text());
    const auto start = std::chrono::steady_clock::now();
    const RandomTally tally = sound.run(static_cast<std::int64_t>(options_.pairs), options_.seed, 1'000'000);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    const double pairs = static_cast<double>(tally.samples);
    fmt::print("{:8} {:6} {:34} {:11} pairs, {:2.0f} % with a bound, {:.1e} a second, {} violations {}\n", name(mode),
               real, rule.name, tally.samples, 100 * static_cast<double>(tally.certain) / pairs,
               pairs / seconds.count(), tally.violations, tally.counterexample);
    std::fflush(stdout);
    ++rules_;
    pairs_ += pairs;
    certain_ += static_cast<double>(tally.certain);
    violations_ += tally.violations;
  }

  template <class Real>
  void weaken(const RuleCase& rule, BoundMode mode, const std::string& sound) {
    for (int i = 1; *name(static_cast<Weakening>(i)) != 0; ++i) {
      RandomCheck<Real> weakened(rule, mode, static_cast<Weakening>(i));
      if (weakened.refused() || weakened.text() == sound) continue;
      int& noticed = noticed_[fmt::format("{:8} {}", name(mode), name(static_cast<Weakening>(i)))];
      if (weakened.run(static_cast<std::int64_t>(options_.pairs), options_.seed, 1).violations > 0) ++noticed;
    }
  }

  int report_terms() const {
    int missed = 0;
    for (const auto& [term, rules] : noticed_) {
      fmt::print("{:40} noticed by {} rules\n", term, rules);
      if (rules == 0) ++missed;
    }
    return missed > 0 || noticed_.empty() ? 1 : 0;
  }

  Options options_;
  int rules_ = 0;
  double pairs_ = 0;
  double certain_ = 0;
  std::int64_t violations_ = 0;
  std::map<std::string, int> noticed_;
};

}  // namespace
}  // namespace tightrope::rules

int main(int count, char** arguments) {
  tightrope::rules::Options options;
  if (!tightrope::rules::parse(count, arguments, options)) {
    fmt::print(stderr,
               "usage: random_rules [--pairs N] [--rule TEXT] [--mode MODE] [--real double|float] [--seed S] "
               "[--weakened]\n");
    return 2;
  }
  return tightrope::rules::Campaign(options).run();
}
