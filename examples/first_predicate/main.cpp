// Does a moving point keep to its side of a fixed wall? The geometry is in side_of_line.pred.
#include <cstdio>

#include "side_of_line.tight.double.h"

using tightrope::Sign;

// -1 or +1: the point is on this side during the whole step, which is proven. 0: it crosses, or touches, or is too close to tell.
int proven_side(const double* p_t0, const double* p_t1, const double* a, const double* b) {
  using side_of_wall = tightrope::generated::side_of_wall<tightrope::bound::tight, double>;
  const auto [area] = side_of_wall::evaluate(p_t0, p_t1, a, b);
  const Sign first = sign(area[0]);
  for (const auto& coefficient : area) {
    if (sign(coefficient) != first) return 0;
  }
  return static_cast<int>(first);
}

int main() {
  const double a[] = {0.0, 0.0}, b[] = {0.3, 0.1};                          // the wall
  const double above[] = {0.1, 0.4}, near[] = {0.6, 0.2 + 0x1p-50}, on[] = {0.6, 0.2}, below[] = {0.5, -0.2};
  std::printf("stays above:            %+d\n", proven_side(above, near, a, b));
  std::printf("ends up on the wall:    %+d\n", proven_side(above, on, a, b));
  std::printf("passes through:         %+d\n", proven_side(above, below, a, b));
}
