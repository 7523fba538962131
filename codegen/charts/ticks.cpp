#include "codegen/charts/ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tightrope::charts {
namespace {

double power_of_ten(int exponent) { return std::pow(10.0, exponent); }

/// Whether the numbers of an axis are written out: 0.002, 500, 20000.
bool written_out(double low, double high) { return low >= 0.9e-3 && high < 2e5; }

Tick labelled(int mantissa, int exponent, bool plain) {
  const double value = mantissa * power_of_ten(exponent);
  if (plain) return {.value = value, .label = fmt::format("{:.{}f}", value, std::max(0, -exponent))};
  const std::string factor = mantissa == 1 ? "" : fmt::format("{}·", mantissa);
  return {.value = value, .label = factor + "10", .exponent = fmt::format("{}", exponent)};
}

constexpr int mantissas_with_labels[] = {1, 2, 5};

/// How many powers of ten lie between two ticks with labels; 0: so few that 2 and 5 times a power get labels, too.
int step_between(double low, double high, int first, int last, int most) {
  int count = 0;
  for (int exponent = first; exponent <= last; ++exponent) {
    for (const int mantissa : mantissas_with_labels) {
      const double value = mantissa * power_of_ten(exponent);
      if (value >= low && value <= high) ++count;
    }
  }
  if (count <= most) return 0;
  for (const int step : {1, 2, 3, 5, 10, 20, 50, 100, 200}) {
    if (last / step - first / step + 1 <= most) return step;
  }
  return 500;
}

}  // namespace

std::vector<Tick> log_ticks(double low, double high, int most) {
  const int first = static_cast<int>(std::floor(std::log10(low)));
  const int last = static_cast<int>(std::floor(std::log10(high)));
  const int step = step_between(low, high, first, last, most);
  const bool plain = written_out(low, high);
  std::vector<Tick> ticks;
  for (int exponent = first; exponent <= last; ++exponent) {
    for (int mantissa = 1; mantissa <= 9; ++mantissa) {
      const double value = mantissa * power_of_ten(exponent);
      if (value < low * (1 - 1e-12) || value > high * (1 + 1e-12)) continue;
      const bool main = step == 0 ? mantissa == 1 || mantissa == 2 || mantissa == 5
                                  : mantissa == 1 && exponent % std::max(step, 1) == 0;
      if (main) {
        ticks.push_back(labelled(mantissa, exponent, plain));
      } else if (step <= 1 || mantissa == 1) {
        ticks.push_back({.value = value});
      }
    }
  }
  return ticks;
}

}  // namespace tightrope::charts
