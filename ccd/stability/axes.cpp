#include "stability/axes.h"

namespace tightrope::ccd::stability {

std::string_view name(Real real) { return real == Real::in_double ? "double" : "float"; }

Axes full_axes() {
  return {.distances = {0, 1e-18, 1e-16, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2, 1},
          .scales = {-200, -150, -100, -50, 0, 50, 100, 150, 200},
          .offsets = {0, 1, 0x1p10, 0x1p20, 0x1p40}};
}

Axes small_axes() {
  return {.distances = {0, 1e-16, 1e-12, 1e-6, 1}, .scales = {-200, 0, 200}, .offsets = {0, 0x1p20}};
}

int scale_exponent(int of_double, Real real) { return real == Real::in_double ? of_double : of_double / 2; }

}  // namespace tightrope::ccd::stability
